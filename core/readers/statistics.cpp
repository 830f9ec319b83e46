#include "core/readers/statistics.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "core/scene/data/contents.hpp"

namespace lightnet {
namespace {

/// A box that grows.
class Box {
public:
    void add(Vec3 p) {
        least_ = {std::min(least_.x, p.x), std::min(least_.y, p.y), std::min(least_.z, p.z)};
        most_ = {std::max(most_.x, p.x), std::max(most_.y, p.y), std::max(most_.z, p.z)};
    }
    bool empty() const { return !(least_.x <= most_.x); }
    Vec3 least() const { return empty() ? Vec3{} : least_; }
    Vec3 most() const { return empty() ? Vec3{} : most_; }

    /// Around this box moved.
    void add_to(Box& other, const Matrix& to) const {
        if (empty()) return;
        for (int corner = 0; corner < 8; ++corner)
            other.add(transform_point(to, {corner & 1 ? most_.x : least_.x, corner & 2 ? most_.y : least_.y,
                                           corner & 4 ? most_.z : least_.z}));
    }

private:
    static constexpr float far = std::numeric_limits<float>::infinity();
    Vec3 least_{far, far, far}, most_{-far, -far, -far};
};

template <class Element>
std::uint64_t bytes_of(const std::vector<Element>& elements) {
    return elements.size() * sizeof(Element);
}

void add_shape(Box& box, const Shape& shape) {
    if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
        for (const Vec3& p : mesh->positions) box.add(p);
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
            found.geometry_bytes += bytes_of(mesh->positions) + bytes_of(mesh->normals) + bytes_of(mesh->uvs) +
                                    bytes_of(mesh->colours) + bytes_of(mesh->triangles);
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
        found.seen_triangles += triangles_of(scene.shapes[i]);
    }
    for (const auto& instance : scene.instances) {
        boxes[instance.object].add_to(world, instance.to_world);
        found.seen_triangles += triangles[instance.object];
    }
    found.least = world.least(), found.most = world.most();
}

void count_lights(const SceneData& scene, SceneStatistics& found) {
    for (const auto& light : scene.lights) {
        static constexpr std::array names{"points", "spots", "directions"};
        static_assert(names.size() == std::variant_size_v<BareLight>);
        ++found.lights[names[light.index()]];
    }
    for (const auto& environment : scene.environments)
        ++found.lights[environment.image ? "environments with a picture" : "even environments"];
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
    found.pictures = images.size();
    for (const Image* image : images) found.picture_bytes += image->memory();
    return found;
}

}  // namespace lightnet
