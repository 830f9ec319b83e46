#include "core/readers/mitsuba/clipping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

namespace lightnet::mitsuba {
namespace {

/// A box in the space of a shape's geometry.
struct Corners {
    Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};

    void add(Vec3 p) {
        for (std::size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
    }
    Vec3 at(int corner) const {
        return {corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z};
    }
};

Corners around(const Corners& box, const Matrix& to_world) {
    Corners placed;
    for (int corner = 0; corner < 8; ++corner) placed.add(transform_point(to_world, box.at(corner)));
    return placed;
}

/// The box of each triangle, or of the whole of a round thing.
void each_part(const ShapeGeometry& geometry, const std::function<void(const Corners&)>& use) {
    if (const auto* mesh = std::get_if<Mesh>(&geometry)) {
        for (const auto& triangle : mesh->triangles) {
            Corners box;
            for (const auto index : triangle) box.add(mesh->positions[index]);
            use(box);
        }
    } else if (const auto* sphere = std::get_if<Sphere>(&geometry)) {
        const Vec3 reach{sphere->radius, sphere->radius, sphere->radius};
        use({sphere->center - reach, sphere->center + reach});
    } else {
        const auto& quadric = std::get<Quadric>(geometry);
        const bool flat = quadric.round == Quadric::Round::disk, tube = quadric.round == Quadric::Round::cylinder;
        use(around({{-1, -1, flat || tube ? 0.0f : -1.0f}, {1, 1, flat ? 0.0f : 1.0f}}, quadric.to_world));
    }
}

void each_part(const SceneData& scene, const std::function<void(const Corners&)>& use) {
    std::vector<bool> in_object(scene.shapes.size());
    for (const auto& object : scene.objects)
        for (const auto shape : object.shapes) in_object[shape] = true;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (!in_object[i]) each_part(scene.shapes[i].geometry, use);
    for (const auto& instance : scene.instances)
        for (const auto shape : scene.objects[instance.object].shapes)
            each_part(scene.shapes[shape].geometry, [&](const Corners& box) { use(around(box, instance.to_world)); });
}

}  // namespace

void clip(CameraData& camera, float nearest, float farthest, const Context& context) {
    const Vec3 eye = transform_point(camera.to_world, {0, 0, 0}),
               axis = transform_direction(camera.to_world, {0, 0, 1});
    // What can be cut lies beside the axis by no more than the picture's corner does at the plane.
    const auto& screen = camera.screen;
    const float slope = camera.orthographic ? 0 : std::tan(camera.fov * std::numbers::pi_v<float> / 360);
    const float widest = std::hypot(std::max(std::fabs(screen[0]), std::fabs(screen[1])),
                                    std::max(std::fabs(screen[2]), std::fabs(screen[3])));
    const float aside = (camera.orthographic ? widest : slope * nearest * 16) + camera.lens_radius;
    bool cut = false, far = false;
    each_part(context.assets.scene(), [&](const Corners& box) {
        float low = std::numeric_limits<float>::infinity(), high = -low;
        for (int corner = 0; corner < 8; ++corner) {
            const float depth = dot(box.at(corner) - eye, axis);
            low = std::min(low, depth), high = std::max(high, depth);
        }
        far |= high > farthest;
        const Vec3 middle = (box.low + box.high) * 0.5f, half = (box.high - box.low) * 0.5f;
        const Vec3 across = middle - eye - axis * dot(middle - eye, axis);
        cut |= low < nearest && high > 0 && length(across) < aside + length(half);
    });
    camera.nearest = cut ? nearest : 0;
    if (far)
        context.report().warn(camera.where,
                              fmt::format("'far_clip' cuts nothing away: what is farther than {} is seen, "
                                          "which Mitsuba leaves out",
                                          farthest));
}

}  // namespace lightnet::mitsuba
