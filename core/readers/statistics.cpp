#include "core/readers/statistics.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "core/scene/data/contents.hpp"
#include "core/scene/surfaces/placed_quadric.hpp"

namespace lightnet {
namespace {

/// Adds what is in a box, once it is moved.
void add_moved(Box& to, const Box& box, const Matrix& by) {
    if (box.empty()) return;
    for (int corner = 0; corner < 8; ++corner)
        to.add(transform_point(by, {corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                    corner & 4 ? box.high.z : box.low.z}));
}

template <class Element>
std::uint64_t size_in_memory(const std::vector<Element>& elements) {
    return elements.size() * sizeof(Element);
}

void add_shape(Box& box, const Shape& shape) {
    if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
        for (const Vec3& p : mesh->positions) box.add(p);
        return;
    }
    if (const auto* quadric = std::get_if<Quadric>(&shape.geometry)) {
        const Box own = PlacedQuadric(*quadric).bounds();
        box.add(own.low), box.add(own.high);
        return;
    }
    const auto& ball = std::get<Sphere>(shape.geometry);
    const Vec3 r{ball.radius, ball.radius, ball.radius};
    box.add(ball.center - r), box.add(ball.center + r);
}

const char* name_of(const Material& material) {
    return std::visit([]<class M>(const M&) { return M::name; }, material.model);
}

void count_shapes(const SceneData& scene, SceneStatistics& found) {
    std::set<MaterialId> used;
    for (const Shape& shape : scene.shapes) {
        used.insert(shape.material);
        if (shape.emission) ++found.lights["shapes that emit"];
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            ++found.meshes;
            found.triangles += mesh->triangles.size();
            found.geometry_bytes += size_in_memory(mesh->positions) + size_in_memory(mesh->normals) +
                                    size_in_memory(mesh->uvs) + size_in_memory(mesh->colours) +
                                    size_in_memory(mesh->triangles);
        } else if (std::holds_alternative<Quadric>(shape.geometry)) {
            ++found.quadrics;
            found.geometry_bytes += sizeof(Quadric);
        } else {
            ++found.spheres;
            found.geometry_bytes += sizeof(Sphere);
        }
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
            add_shape(boxes[i], scene.shapes[shape]);
            triangles[i] += triangles_of(scene.shapes[shape]);
        }
    Box world;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        if (inside[i]) continue;
        add_shape(world, scene.shapes[i]);
        found.instanced_triangles += triangles_of(scene.shapes[i]);
    }
    for (const auto& instance : scene.instances) {
        add_moved(world, boxes[instance.object], instance.to_world);
        found.instanced_triangles += triangles[instance.object];
    }
    found.bounds = world.empty() ? Box{{}, {}} : world;
}

void count_lights(const SceneData& scene, SceneStatistics& found) {
    for (const auto& light : scene.lights) {
        static constexpr std::array names{"points", "spots", "directions"};
        static_assert(names.size() == std::variant_size_v<BareLight>);
        const auto* far = std::get_if<DirectionalLight>(&light);
        ++found.lights[far && far->half_angle > 0 ? "suns" : names[light.index()]];
    }
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
