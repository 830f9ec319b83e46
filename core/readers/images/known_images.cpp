#include "core/readers/images/known_images.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

namespace lightnet {
namespace {

struct Remembered {
    Bytes file;
    Encoding encoding;
    std::weak_ptr<const Image> image;
    std::string remark;
};

std::mutex& images_mutex() {
    static std::mutex mutex;
    return mutex;
}
std::vector<Remembered>& remembered_images() {
    static std::vector<Remembered> images;
    return images;
}

}  // namespace

// Compared byte by byte, which is far quicker than a hash that could be trusted.
std::optional<KnownImage> known_image(const Bytes& file, const Encoding& encoding) {
    std::vector<std::pair<Bytes, KnownImage>> alike;
    {
        const std::lock_guard lock(images_mutex());
        for (const auto& one : remembered_images())
            if (one.encoding == encoding && one.file->size() == file->size())
                if (auto image = one.image.lock()) alike.push_back({one.file, {std::move(image), one.remark}});
    }
    for (auto& [bytes, known] : alike)
        if (bytes == file || *bytes == *file) return std::move(known);
    return std::nullopt;
}

void remember_image(const Bytes& file, const Encoding& encoding, const KnownImage& made) {
    const std::lock_guard lock(images_mutex());
    auto& images = remembered_images();
    std::erase_if(images, [](const Remembered& one) { return one.image.expired(); });
    images.push_back({file, encoding, made.image, made.remark});
}

}  // namespace lightnet
