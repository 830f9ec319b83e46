// Pictures as arrays of NumPy.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/film/picture.hpp"

namespace lightnet {

/// How such files begin.
inline constexpr std::string_view npz_beginning{"PK\x03\x04", 4};

/// Writes `picture` as an .npz file, which numpy.load() reads, whole or not at all: `beauty`, `layers/NAME` and
/// `shown/NAME` are of (height, width, 3), `alpha` and `samples` (where the picture has them) of (height, width),
/// `mattes/NAME` of (height, width, ranks, 2): ids and parts. All are float32, row 0 on top, not compressed, and lie at
/// multiples of 64 bytes, so that they can be mapped. `picture.json` names layers in the order in which they add up,
/// and has their gains, the letters of what is shown, the manifests of mattes, the place in the whole picture, how much
/// is done, and the notes. Layers are without gains, as in the EXR. The same picture gives the same bytes. Throws
/// Error.
void write_npz(const std::filesystem::path& path, const Picture& picture);

}  // namespace lightnet
