// Images that were decoded for a scene that is still there.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/bytes.hpp"
#include "core/readers/images/image_file.hpp"

namespace lightnet {

/// A decoded image, made sound, and what is strange about it; "": nothing.
struct KnownImage {
    std::shared_ptr<const Image> image;
    std::string remark{};
};

/// The image of a file with these bytes, where a scene of this process has it: who edits a scene and reads it anew
/// need not decode it once more. None: nobody has. Any thread.
std::optional<KnownImage> known_image(const Bytes& file, const Encoding& encoding);
/// It is known as long as somebody has it. Of its file no more than a hash is kept. Any thread.
void remember_image(const Bytes& file, const Encoding& encoding, const KnownImage& made);

}  // namespace lightnet
