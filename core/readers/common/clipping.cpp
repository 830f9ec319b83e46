#include "core/readers/common/clipping.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/math/moved_box.hpp"

namespace lightnet {
namespace {

/// The box of each triangle, or of the whole of a round thing.
void each_part(const ShapeGeometry& geometry, const std::function<void(const Box&)>& use) {
    if (const auto* mesh = std::get_if<Mesh>(&geometry)) {
        for (const auto& triangle : mesh->triangles) {
            Box box;
            for (const auto index : triangle) box.add(mesh->positions[index]);
            use(box);
        }
    } else {
        Box box;
        add_to(box, geometry, {});
        use(box);
    }
}

void each_part(const SceneData& scene, const std::function<void(const Box&)>& use) {
    std::vector<bool> in_object(scene.shapes.size());
    for (const auto& object : scene.objects)
        for (const auto shape : object.shapes) in_object[shape] = true;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (!in_object[i]) each_part(scene.shapes[i].geometry, use);
    for (const auto& instance : scene.instances)
        for (const auto shape : scene.objects[instance.object].shapes)
            each_part(scene.shapes[shape].geometry, [&](const Box& box) {
                Box placed;
                add_moved(placed, box, instance.to_world);
                use(placed);
            });
}

}  // namespace

void clip(CameraData& camera, float before, float beyond, const SceneData& scene) {
    const Vec3 eye = transform_point(camera.to_world, {0, 0, 0}),
               axis = transform_direction(camera.to_world, {0, 0, 1});
    // What can be cut lies beside the axis by no more than the picture's corner does at the plane.
    const auto& screen = camera.screen;
    const float slope = camera.is_orthographic() ? 0 : std::tan(camera.fov * std::numbers::pi_v<float> / 360);
    const float widest = std::hypot(std::max(std::fabs(screen[0]), std::fabs(screen[1])),
                                    std::max(std::fabs(screen[2]), std::fabs(screen[3])));
    const float aside = (camera.is_orthographic() ? widest : slope * before * 16) + camera.lens_radius;
    bool cut = false, far = false;
    each_part(scene, [&](const Box& box) {
        float low = std::numeric_limits<float>::infinity(), high = -low;
        for (int corner = 0; corner < 8; ++corner) {
            const float depth = dot(corner_of(box, corner) - eye, axis);
            low = std::min(low, depth), high = std::max(high, depth);
        }
        far |= high > beyond;
        const Vec3 middle = box.center(), half = box.size() * 0.5f;
        const Vec3 across = middle - eye - axis * dot(middle - eye, axis);
        cut |= low < before && high > 0 && length(across) < aside + length(half);
    });
    camera.nearest = cut ? before : 0;
    if (far && beyond > before) camera.farthest = beyond;
}

}  // namespace lightnet
