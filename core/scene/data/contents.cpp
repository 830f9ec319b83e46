#include "core/scene/data/contents.hpp"

#include <algorithm>

namespace lightnet {

std::uint64_t triangles_of(const Shape& shape) {
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    return mesh ? mesh->triangles.size() : 0;
}

std::uint64_t triangles_of(const SceneData& scene) {
    std::uint64_t count = 0;
    for (const Shape& shape : scene.shapes) count += triangles_of(shape);
    return count;
}

bool has_curves(const SceneData& scene) {
    return std::any_of(scene.shapes.begin(), scene.shapes.end(),
                       [](const Shape& shape) { return std::holds_alternative<Curves>(shape.geometry); });
}

std::set<const Image*> images_of(const SceneData& scene) {
    using Shared = std::shared_ptr<const Image>;
    std::set<const Image*> images;
    const auto add = [&](const Shared& image) {
        if (image) images.insert(image.get());
    };
    for (const auto& texture : scene.textures) visit_each<Shared>(texture, add);
    for (const auto& environment : scene.environments) visit_each<Shared>(environment, add);
    for (const auto& light : scene.lights) visit_each<Shared>(light, add);
    return images;
}

}  // namespace lightnet
