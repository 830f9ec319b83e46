#include "core/readers/statistics.hpp"

#include <algorithm>
#include <set>

#include "core/base/math/moved_box.hpp"
#include "core/scene/data/contents.hpp"

namespace lightnet {
namespace {

template <class... Shapes>
std::vector<std::pair<const char*, std::size_t>> none_of_each(const std::variant<Shapes...>*) {
    return {{Shapes::names, 0}...};
}

const char* name_of(const Material& material) {
    return std::visit([]<class M>(const M&) { return M::name; }, material.model);
}

void count_shapes(const SceneData& scene, SceneStatistics& found) {
    std::set<MaterialId> used;
    found.shapes = none_of_each(static_cast<const ShapeGeometry*>(nullptr));
    for (const Shape& shape : scene.shapes) {
        used.insert(shape.material);
        if (shape.emission) ++found.lights["shapes that emit"];
        ++found.shapes[shape.geometry.index()].second;
        found.triangles += triangles_of(shape);
        found.geometry_bytes += memory_of(shape.geometry);
    }
    for (const MaterialId id : used) ++found.materials[name_of(scene.materials[id])];
}

void measure(const SceneData& scene, SceneStatistics& found) {
    std::vector<bool> inside(scene.shapes.size());
    std::vector<Box> boxes(scene.objects.size());
    std::vector<std::uint64_t> triangles(scene.objects.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        for (const auto shape : scene.objects[i].shapes) {
            inside[shape] = true;
            add_to(boxes[i], scene.shapes[shape].geometry, {});
            triangles[i] += triangles_of(scene.shapes[shape]);
        }
    Box world;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        if (inside[i]) continue;
        add_to(world, scene.shapes[i].geometry, {});
        found.instanced_triangles += triangles_of(scene.shapes[i]);
    }
    for (const auto& instance : scene.instances) {
        add_moved(world, boxes[instance.object], instance.to_world);
        found.instanced_triangles += triangles[instance.object];
    }
    found.bounds = world.empty() ? Box{{}, {}} : world;
}

void count_lights(const SceneData& scene, SceneStatistics& found) {
    for (const auto& light : scene.lights)
        ++found.lights[std::visit([](const auto& one) { return one.names(); }, light)];
    for (const auto& environment : scene.environments)
        ++found.lights[environment.image ? "environments with an image" : "constant environments"];
}

}  // namespace

SceneStatistics statistics_of(const SceneData& scene) {
    SceneStatistics found;
    found.objects = scene.objects.size();
    found.instances = scene.instances.size();
    found.textures = scene.textures.size();
    count_shapes(scene, found);
    measure(scene, found);
    count_lights(scene, found);
    const auto images = images_of(scene);
    found.images = images.size();
    for (const Image* image : images) found.image_bytes += image->memory();
    return found;
}

}  // namespace lightnet
