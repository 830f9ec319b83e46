#include "core/scene/camera_in.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/base/math/transform.hpp"
#include "core/scene/camera/camera.hpp"
#include "core/scene/data/contents.hpp"

namespace lightnet {
namespace {

bool can_be_seen(const SceneData& scene, const Shape& shape) {
    return shape.material < scene.materials.size() &&
           !std::holds_alternative<NoMaterial>(scene.materials[shape.material].model);
}

/// with(shape, to_world) of all that can be seen, once for each instance.
template <class With>
void each_placed(const SceneData& scene, const With& with) {
    std::vector<bool> of_object(scene.shapes.size());
    for (const auto& object : scene.objects)
        for (const auto shape : object.shapes) of_object[shape] = true;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (!of_object[i] && can_be_seen(scene, scene.shapes[i])) with(scene.shapes[i], Matrix{});
    for (const auto& instance : scene.instances)
        for (const auto shape : scene.objects[instance.object].shapes)
            if (can_be_seen(scene, scene.shapes[shape])) with(scene.shapes[shape], instance.to_world);
}

// Around all that can be seen; a unit cube where there is nothing.
Box box_of(const SceneData& scene) {
    Box box;
    each_placed(scene, [&](const Shape& shape, const Matrix& to_world) { add_to(box, shape.geometry, to_world); });
    const bool usable = finite(box.low) && finite(box.high) && length(box.size()) > 0;
    return usable ? box : Box{{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}};
}

struct Wall {
    float distance = std::numeric_limits<float>::infinity();
    bool faces_us = false;
};

/// What is met first in some directions from a point, by one triangle after the other: whoever has read a scene can ask
/// before anything is built of it.
class RoomWalls {
public:
    RoomWalls(Vec3 from, std::vector<Vec3> directions)
        : from_(from), directions_(std::move(directions)), walls_(directions_.size()) {}

    /// Moller & Trumbore 1997.
    void add(Vec3 a, Vec3 b, Vec3 c, bool turned) {
        const Vec3 ab = b - a, ac = c - a, to = from_ - a, q = cross(to, ab);
        for (std::size_t i = 0; i < walls_.size(); ++i) {
            const Vec3 p = cross(directions_[i], ac);
            const float all = dot(ab, p);
            if (all == 0) continue;
            const float u = dot(to, p) / all, v = dot(directions_[i], q) / all, distance = dot(ac, q) / all;
            if (u < 0 || v < 0 || u + v > 1 || !(distance > 0) || distance >= walls_[i].distance) continue;
            walls_[i] = {distance, (all > 0) != turned};
        }
    }
    const std::vector<Wall>& walls() const { return walls_; }

private:
    Vec3 from_;
    std::vector<Vec3> directions_;
    std::vector<Wall> walls_;
};

constexpr std::size_t most_triangles = 4'000'000;  // that are looked at: some seconds

void look_at(RoomWalls& around, const Shape& shape, const Matrix& to_world) {
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    if (!mesh) return;
    const bool turned = mesh->flip_normals != swaps_handedness(to_world);
    std::vector<Vec3> places;
    for (const Vec3 vertex : mesh->positions) places.push_back(transform_point(to_world, vertex));
    for (const auto& [a, b, c] : mesh->triangles)
        if (std::max({a, b, c}) < places.size()) around.add(places[a], places[b], places[c], turned);
}

// DECISIONS: cameras-in-rooms
// In all of 26 directions but a few, as rooms have windows, walls are around its middle, and their fronts are inside.
std::optional<CameraData> camera_in_room(const SceneData& scene, const Box& box) {
    std::size_t triangles = 0;
    each_placed(scene, [&](const Shape& shape, const Matrix&) { triangles += triangles_of(shape); });
    if (triangles > most_triangles) return std::nullopt;
    std::vector<Vec3> directions;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x || y || z) directions.push_back(normalize({float(x), float(y), float(z)}));
    const Vec3 back = normalize({0.55f, 0.1f, 1});
    directions.push_back(back);
    RoomWalls around(box.center(), std::move(directions));
    each_placed(scene, [&](const Shape& shape, const Matrix& to_world) { look_at(around, shape, to_world); });
    const auto& walls = around.walls();
    const auto closed =
        std::count_if(walls.begin(), walls.end() - 1, [](const Wall& wall) { return std::isfinite(wall.distance); });
    const auto facing = std::count_if(walls.begin(), walls.end() - 1, [](const Wall& wall) { return wall.faces_us; });
    if (closed < 22 || 2 * facing <= closed || !std::isfinite(walls.back().distance)) return std::nullopt;
    const Vec3 eye = box.center() + back * (0.9f * walls.back().distance);
    const Vec3 z = -back, x = normalize(cross(z, {0, 1, 0})), y = cross(x, z);
    CameraData camera;
    camera.fov = 65;
    for (std::size_t i = 0; i < 3; ++i) {
        camera.to_world.m[i][0] = x[i];
        camera.to_world.m[i][1] = y[i];
        camera.to_world.m[i][2] = z[i];
        camera.to_world.m[i][3] = eye[i];
    }
    return camera;
}

}  // namespace

CameraData camera_in(const SceneData& scene, std::uint32_t width, std::uint32_t height) {
    if (scene.camera_given) return scene.camera;
    const Box box = box_of(scene);
    if (const auto inside = camera_in_room(scene, box)) return *inside;
    return camera_for(box.low, box.high, width, height);
}

}  // namespace lightnet
