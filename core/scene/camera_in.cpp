#include "core/scene/camera_in.hpp"

#include <variant>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/base/math/transform.hpp"
#include "core/scene/camera.hpp"

namespace lightnet {
namespace {

bool can_be_seen(const SceneData& scene, const Shape& shape) {
    return shape.material < scene.materials.size() &&
           !std::holds_alternative<NoMaterial>(scene.materials[shape.material].model);
}

void add_to(Box& box, const Shape& shape, const Matrix& to_world) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
        for (const float side : {-1.0f, 1.0f})
            box.add(transform_point(to_world, sphere->center + Vec3{1, 1, 1} * (side * sphere->radius)));
        return;
    }
    for (const Vec3 vertex : std::get<Mesh>(shape.geometry).positions) box.add(transform_point(to_world, vertex));
}

// Around all that can be seen; a unit cube where there is nothing.
Box box_of(const SceneData& scene) {
    std::vector<bool> of_object(scene.shapes.size());
    for (const auto& object : scene.objects)
        for (const auto shape : object.shapes) of_object[shape] = true;
    Box box;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (!of_object[i] && can_be_seen(scene, scene.shapes[i])) add_to(box, scene.shapes[i], {});
    for (const auto& instance : scene.instances)
        for (const auto shape : scene.objects[instance.object].shapes)
            if (can_be_seen(scene, scene.shapes[shape])) add_to(box, scene.shapes[shape], instance.to_world);
    const bool usable = finite(box.low) && finite(box.high) && length(box.size()) > 0;
    return usable ? box : Box{{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}};
}

}  // namespace

CameraData camera_in(const SceneData& scene, std::uint32_t width, std::uint32_t height) {
    if (scene.camera_given) return scene.camera;
    const Box box = box_of(scene);
    return camera_for(box.low, box.high, width, height);
}

}  // namespace lightnet
