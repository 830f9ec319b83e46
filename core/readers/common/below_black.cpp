#include "core/readers/common/below_black.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "core/scene/textures/members.hpp"

namespace lightnet {
namespace {

/// The images of light, colours and shares: all but relief.
class Looks {
public:
    explicit Looks(const SceneData& scene) : scene_(scene) {
        for (const Material& material : scene.materials) follow(without_relief(material));
        for (const Shape& shape : scene.shapes) follow(shape.emission);
        for (const auto& environment : scene.environments) follow(environment);
        for (const auto& light : scene.lights) follow(light);
    }
    bool have(const Image* image) const { return images_.contains(image); }

private:
    using Shared = std::shared_ptr<const Image>;

    static Material without_relief(Material material) {
        material.normal_map.reset();
        material.bump_map.reset();
        if (auto* principled = std::get_if<PrincipledMaterial>(&material.model)) principled->coat_normal.map.reset();
        return material;
    }

    void follow(const auto& first) {
        std::vector<TextureId> left;
        const auto note = [&](const auto& value) {
            visit_each<Shared>(value, [&](const Shared& image) { images_.insert(image.get()); });
            visit_each<TextureId>(value, [&](TextureId id) {
                if (id < scene_.textures.size() && textures_.insert(id).second) left.push_back(id);
            });
        };
        note(first);
        while (!left.empty()) {
            const TextureId next = left.back();
            left.pop_back();
            note(scene_.textures[next]);
        }
    }

    const SceneData& scene_;
    std::set<const Image*> images_;
    std::set<std::size_t> textures_;
};

}  // namespace

std::string below_black(const Image& image) {
    if (image.coded()) return "";
    std::size_t count = 0;
    const auto look = [&](float r, float g, float b) { count += (r < 0) | (g < 0) | (b < 0); };
    if (const float* rgb = image.linear_rgb()) {  // of a sky millions, in each run
        for (const float* const end = rgb + 3 * std::size_t{image.width} * image.height; rgb < end; rgb += 3)
            look(rgb[0], rgb[1], rgb[2]);
    } else {
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width; ++x) {
                const Rgb colour = image.colour(x, y);
                look(colour.r, colour.g, colour.b);
            }
    }
    return count ? fmt::format("{} of its pixels are negative: 0 is taken", count) : "";
}

void warn_below_black(const SceneData& scene, std::span<const NamedImage> images, Report& report) {
    const Looks looks(scene);
    std::set<std::string> told;
    for (const auto& [image, name, where] : images) {
        if (!image || !looks.have(image)) continue;
        const std::string remark = below_black(*image);
        if (!remark.empty() && told.insert(name).second)
            report.warn(where, fmt::format("image '{}': {}", name, remark));
    }
}

}  // namespace lightnet
