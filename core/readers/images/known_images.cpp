#include "core/readers/images/known_images.hpp"

#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

#include "core/base/hash.hpp"

namespace lightnet {
namespace {

struct Remembered {
    std::size_t size;
    Hash file;
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

// A hash is made only of a file that is as long as one that is known.
std::optional<KnownImage> known_image(const Bytes& file, const Encoding& encoding) {
    std::vector<Remembered> alike;
    {
        const std::lock_guard lock(images_mutex());
        for (const auto& one : remembered_images())
            if (one.encoding == encoding && one.size == file->size() && !one.image.expired()) alike.push_back(one);
    }
    if (alike.empty()) return std::nullopt;
    const Hash name = content_hash(*file);
    for (const auto& one : alike)
        if (one.file == name)
            if (auto image = one.image.lock()) return KnownImage{std::move(image), one.remark};
    return std::nullopt;
}

void remember_image(const Bytes& file, const Encoding& encoding, const KnownImage& made) {
    const Hash name = content_hash(*file);
    const std::lock_guard lock(images_mutex());
    auto& images = remembered_images();
    std::erase_if(images, [](const Remembered& one) { return one.image.expired(); });
    images.push_back({file->size(), name, encoding, made.image, made.remark});
}

}  // namespace lightnet
