#include "core/scene/scene.hpp"

#include "core/error.hpp"
#include "core/scene/geometry.hpp"
#include "core/scene/shading.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lightnet {
namespace {

SceneData checked(SceneData data) {
    for (const auto& shape : data.shapes) {
        if (shape.material >= data.materials.size())
            throw Error("scene", "shape at " + to_string({shape.where, "names a material that isn't there"}));
        const auto* mesh = std::get_if<Mesh>(&shape.geometry);
        if (!mesh) continue;
        for (const auto& triangle : mesh->triangles)
            for (const auto vertex : triangle)
                if (vertex >= mesh->positions.size())
                    throw Error("scene", to_string({shape.where, "a triangle names a vertex that isn't there"}));
        const auto fits = [&](std::size_t count) { return count == 0 || count == mesh->positions.size(); };
        if (!fits(mesh->normals.size()) || !fits(mesh->uvs.size()))
            throw Error("scene", to_string({shape.where, "normals or texture coordinates don't match the vertices"}));
    }
    return data;
}

FilmData sized(FilmData film, const SceneOptions& options) {
    if (options.width) film.width = options.width;
    if (options.height) film.height = options.height;
    return film;
}

float radius_of(const Geometry::Box& box) {
    const float r = length(box.upper - box.lower) / 2;
    return std::isfinite(r) && r > 0 ? r : 1;
}

}  // namespace

struct Scene::Built {
    Built(SceneData given, const SceneOptions& options)
        : data(checked(std::move(given))),
          lights(data.shapes),
          shading(data),
          geometry(data.shapes, options.isa),
          film(sized(data.film, options)),
          camera(data.camera, film.width, film.height),
          radius(radius_of(geometry.bounds())) {
        for (const auto& environment : data.environments) sky += environment.radiance;
    }

    SceneData data;
    Lights lights;
    Shading shading;
    Geometry geometry;
    FilmData film;
    Camera camera;
    float radius;
    Rgb sky;
};

Scene::Scene(SceneData data, const SceneOptions& options)
    : built_(std::make_unique<const Built>(std::move(data), options)) {}

Scene::~Scene() = default;

std::optional<Hit> Scene::intersect(const Ray& ray) const { return built_->geometry.intersect(ray); }

void Scene::intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
    built_->geometry.intersect(rays, hits);
}

bool Scene::occluded(const Ray& ray) const { return built_->geometry.occluded(ray); }

void Scene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const {
    built_->geometry.occluded(rays, hidden);
}

SurfacePoint Scene::surface(const Hit& hit) const {
    return built_->shading.point(hit.geometry, hit.primitive, hit.u, hit.v);
}

SurfacePoint Scene::surface(const Query& query) const {
    const auto& shapes = built_->data.shapes;
    const auto primitives = [](const Shape& shape) {
        const auto* mesh = std::get_if<Mesh>(&shape.geometry);
        return mesh ? mesh->triangles.size() : 1;
    };
    if (query.geometry >= shapes.size() || query.primitive >= primitives(shapes[query.geometry]))
        throw Error("scene", "a question names a surface that isn't there");  // it may come from another host
    return built_->shading.point(query.geometry, query.primitive, query.u, query.v);
}

const std::string& Scene::material_of(const SurfacePoint& point) const {
    return built_->data.materials[built_->data.shapes[point.geometry].material].name;
}

bool Scene::has_material(const std::string& name) const {
    const auto& [shapes, materials] = std::tie(built_->data.shapes, built_->data.materials);
    return std::any_of(shapes.begin(), shapes.end(),
                       [&](const Shape& shape) { return materials[shape.material].name == name; });
}

Bsdf Scene::bsdf(const SurfacePoint& point) const { return built_->shading.bsdf(point); }

Rgb Scene::emission(const SurfacePoint& point, Vec3 direction) const {
    const auto& emission = built_->data.shapes[point.geometry].emission;
    if (!emission || !(emission->two_sided || dot(point.normal, direction) > 0)) return {};
    return emission->radiance;
}

Rgb Scene::environment(Vec3) const { return built_->sky; }

std::optional<LightSample> Scene::sample_light(Vec3 from, float choice, Vec2 u) const {
    return built_->lights.sample(from, choice, u);
}

float Scene::light_pdf(Vec3 from, Vec3 direction, const SurfacePoint& on) const {
    return built_->lights.pdf(from, direction, on);
}

float Scene::environment_pdf(Vec3) const { return 0; }
bool Scene::has_environment() const { return !is_black(built_->sky); }
bool Scene::has_lamps() const { return !built_->lights.empty(); }
bool Scene::has_many_lamps() const { return built_->lights.many(); }

bool Scene::may_shine(const Ray& ray) const { return has_environment() || may_meet_lamp(ray); }
bool Scene::may_meet_lamp(const Ray& ray) const { return built_->lights.may_meet(ray); }

Ray Scene::ray_to(const SurfacePoint& from, const LightSample& lamp) const {
    constexpr float nearly = 1 - 1e-4f;  // the lamp itself is not in the way
    const Vec3 origin = from.origin_towards(lamp.direction);
    const Vec3 way = lamp.position - origin;
    const float distance = length(way);
    if (!(distance > 0)) return {origin, lamp.direction, 0};
    return {origin, way / distance, distance * nearly};
}

bool Scene::visible(const SurfacePoint& from, const LightSample& lamp) const { return !occluded(ray_to(from, lamp)); }

const Camera& Scene::camera() const { return built_->camera; }
const FilmData& Scene::film() const { return built_->film; }
float Scene::radius() const { return built_->radius; }

std::uint64_t Scene::rays_of_this_thread() { return Geometry::rays_of_this_thread(); }

}  // namespace lightnet
