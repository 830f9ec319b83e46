#include "core/scene/scene.hpp"

#include "core/base/error.hpp"
#include "core/scene/camera_in.hpp"
#include "core/scene/data/same_shapes.hpp"
#include "core/scene/geometry/geometry.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/ray_witness.hpp"
#include "core/scene/scene_media.hpp"
#include "core/scene/scene_size.hpp"
#include "core/scene/surfaces/shading.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

namespace lightnet {
namespace {

Error wrong(const Shape& shape, const std::string& what) { return Error("scene", to_string({shape.where, what})); }

void check_objects(const SceneData& data) {
    for (const auto& object : data.objects)
        for (const auto shape : object.shapes) {
            if (shape >= data.shapes.size()) throw Error("scene", "an object names a shape that isn't there");
            if (data.shapes[shape].emission) throw wrong(data.shapes[shape], "a shape of an object can't emit light");
        }
    for (const auto& instance : data.instances)
        if (instance.object >= data.objects.size())
            throw Error("scene", "an instance names an object that isn't there");
}

// Each step must be like the first.
bool alike(const ShapeGeometry& first, const ShapeGeometry& later) {
    if (first.index() != later.index()) return false;
    const auto *mesh = std::get_if<Mesh>(&first), *moved = std::get_if<Mesh>(&later);
    return !mesh ||
           (mesh->positions.size() == moved->positions.size() && mesh->normals.size() == moved->normals.size());
}

void check_motion(const SceneData& data) {
    for (const auto& [which, later] : data.motion.shapes)
        if (which >= data.shapes.size() || later.empty() ||
            !std::ranges::all_of(later,
                                 [&, i = which](const auto& one) { return alike(data.shapes[i].geometry, one); }))
            throw Error("scene", "a shape that moves is another one later");
    for (const auto& [which, later] : data.motion.instances)
        if (which >= data.instances.size() || later.empty()) throw Error("scene", "an instance that moves isn't there");
    for (const auto& [which, later] : data.motion.lights)
        if (which >= data.lights.size() || later.empty() || !can_move(data.lights[which]) ||
            !std::ranges::all_of(later,
                                 [&, i = which](const auto& one) { return one.index() == data.lights[i].index(); }))
            throw Error("scene", "a light that moves is another one later");
}

SceneData checked(SceneData data) {
    for (const auto& shape : data.shapes) {
        if (shape.material >= data.materials.size()) throw wrong(shape, "names a material that isn't there");
        if (shape.emission && shape.emission->texture && *shape.emission->texture >= data.textures.size())
            throw wrong(shape, "emits by a texture that isn't there");
        const auto fault = std::visit([](const auto& one) { return one.fault(); }, shape.geometry);
        if (!fault.empty()) throw wrong(shape, fault);
    }
    check_objects(data);
    check_motion(data);
    return data;
}

FilmData sized(FilmData film, const SceneOptions& options) {
    if (options.width) film.width = options.width;
    if (options.height) film.height = options.height;
    return film;
}

// Of an empty scene, too.
Box finite_box(const Box& box) {
    const bool usable = finite(box.low) && finite(box.high) && length(box.size()) > 0;
    return usable ? box : Box{{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}};
}

thread_local RayWitness* witness = nullptr;

}  // namespace

RayWitness* watch_rays(RayWitness* next) { return std::exchange(witness, next); }

struct Scene::Built {
    static std::shared_ptr<const Built> make(SceneData data, const SceneOptions& options);
    /// `last`: another scene, or null. Where its shapes are these, its trees serve this one as well.
    Built(SceneData given, const SceneOptions& options, std::shared_ptr<const Built> last)
        : data(checked(std::move(given))),
          isa(options.isa),
          like(with_same_trees(std::move(last))),
          shading(data, like ? &like->shading : nullptr),
          media(data, options.isa, options.build_threads) {
        if (like)
            pad_positions(data);
        else
            own.emplace(data, shading, Geometry::Options{options.isa, options.build_threads});
        box = finite_box(geometry().bounds());
        // Those who ask the data find the camera that is used.
        data.film = sized(data.film, options);
        data.camera = camera_in(data, data.film.width, data.film.height);
        data.camera_given = true;
    }

    std::unique_ptr<const Lights> lights(const Lights::Wanted& wanted) const {
        return std::make_unique<const Lights>(data, shading, BallAround{box.center(), length(box.size()) / 2}, wanted);
    }

    std::shared_ptr<const Built> with_same_trees(std::shared_ptr<const Built> last) const {
        if (last && last->like) last = last->like;
        return last && last->isa == isa && have_same_shapes(last->data, data) ? last : nullptr;
    }
    const Geometry& geometry() const { return like ? *like->own : *own; }

    SceneData data;
    std::string isa;
    std::shared_ptr<const Built> like;  // whose trees these are; null: it has its own
    Shading shading;
    std::optional<Geometry> own;
    Media media;
    Box box;
};

// Who edits a scene has the one before still there.
// DECISIONS: trees-of-the-scene-before
std::shared_ptr<const Scene::Built> Scene::Built::make(SceneData data, const SceneOptions& options) {
    static std::mutex mutex;
    static std::weak_ptr<const Built> newest;
    std::shared_ptr<const Built> last;
    {
        const std::lock_guard lock(mutex);
        last = newest.lock();
    }
    auto built = std::make_shared<const Built>(std::move(data), options, std::move(last));
    const std::lock_guard lock(mutex);
    newest = built;
    return built;
}

Scene::Scene(SceneData data, const SceneOptions& options)
    : built_(Built::make(std::move(data), options)),
      lights_(built_->lights({})),
      onlooker_{built_->data.camera, true, built_->data.film},
      camera_(onlooker_.camera, onlooker_.film.width, onlooker_.film.height),
      has_media_(built_->media.any()) {}

Scene::Scene(const Scene& whole, const SceneView& view)
    : built_(whole.built_),
      lights_(view.groups == whole.view_.groups && view.apart == whole.view_.apart
                  ? whole.lights_
                  : built_->lights({view.groups, view.apart})),
      view_(view),
      onlooker_(whole.onlooker_),
      camera_(whole.camera_),
      has_media_(whole.has_media_) {}

Scene::Scene(const Scene& whole, const Onlooker& by, const SceneOptions& options)
    : built_(whole.built_),
      lights_(whole.lights_),
      view_(whole.view_),
      onlooker_{by.camera, true, sized(by.film, options)},
      camera_(onlooker_.camera, onlooker_.film.width, onlooker_.film.height),
      has_media_(whole.has_media_) {}

Scene::~Scene() = default;

std::optional<Hit> Scene::intersect(const Ray& ray) const {
    view_.parts.expect(ScenePart::geometry);
    const auto hit = built_->geometry().intersect(ray);
    if (witness) witness->met(ray, hit);
    return hit;
}

void Scene::intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
    view_.parts.expect(ScenePart::geometry);
    built_->geometry().intersect(rays, hits);
    if (witness)
        for (std::size_t i = 0; i < rays.size(); ++i) witness->met(rays[i], hits[i]);
}

bool Scene::occluded(const Ray& ray) const {
    view_.parts.expect(ScenePart::geometry);
    const bool hidden = built_->geometry().occluded(ray);
    if (witness) witness->looked(ray, hidden);
    return hidden;
}

void Scene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const {
    view_.parts.expect(ScenePart::geometry);
    built_->geometry().occluded(rays, hidden);
    if (witness)
        for (std::size_t i = 0; i < rays.size(); ++i) witness->looked(rays[i], hidden[i] != 0);
}

std::optional<Hit> Scene::nearest(Vec3 position, Vec3 normal, float reach) const {
    view_.parts.expect(ScenePart::geometry);
    return built_->geometry().nearest({built_->data, built_->shading}, {position, normal, reach});
}

SurfacePoint Scene::surface(const Hit& hit) const {
    view_.parts.expect(ScenePart::geometry);
    SurfacePoint point;
    built_->shading.find(hit, point);
    return point;
}

void Scene::add_surface(const Hit& hit, std::vector<SurfacePoint>& to) const {
    view_.parts.expect(ScenePart::geometry);
    built_->shading.find(hit, to.emplace_back());
}

Vec2 Scene::texture_coordinates(const SurfacePoint& point) const {
    view_.parts.expect(ScenePart::geometry);
    return built_->shading.coordinates(point.geometry, point.primitive, point.u, point.v).uv;
}

void Scene::expect(std::span<const std::optional<Hit>> hits) const {
    view_.parts.expect(ScenePart::geometry);
    built_->shading.expect(hits);
}

std::span<const ColumnShape> Scene::column_shapes() const {
    view_.parts.expect(ScenePart::geometry | ScenePart::materials);
    return built_->shading.column_shapes();
}

Hit Scene::hit(const Query& query) const {
    view_.parts.expect(ScenePart::geometry);
    const auto& shapes = built_->data.shapes;
    if (query.geometry >= shapes.size() || query.primitive >= pieces_of(shapes[query.geometry].geometry) ||
        (query.instance != Query::no_instance && query.instance >= built_->shading.placements().size()))
        throw Error("scene", "a question names a surface that isn't there");
    return {query.instance, query.geometry, query.primitive, query.u, query.v, 0, query.time};
}

const SceneData& Scene::data() const { return view_.parts.expect(whole_scene), built_->data; }

template <>
const std::vector<Shape>& Scene::all() const {
    view_.parts.expect(ScenePart::geometry | ScenePart::lamps | ScenePart::names);
    return built_->data.shapes;
}
template <>
const std::vector<Material>& Scene::all() const {
    view_.parts.expect(ScenePart::materials | ScenePart::names);
    return built_->data.materials;
}
template <>
const std::vector<Object>& Scene::all() const {
    view_.parts.expect(ScenePart::geometry | ScenePart::names);
    return built_->data.objects;
}
template <>
const std::vector<Instance>& Scene::all() const {
    view_.parts.expect(ScenePart::geometry | ScenePart::names);
    return built_->data.instances;
}

bool Scene::moves() const {
    view_.parts.expect(ScenePart::geometry | ScenePart::lamps);  // which may be all that moves
    return !built_->data.motion.empty();
}

bool Scene::moves(const Hit& hit) const {
    view_.parts.expect(ScenePart::geometry);
    if (hit.instance != Query::no_instance && !built_->shading.later_placements(hit.instance).empty()) return true;
    return built_->shading.moving(hit.geometry) != nullptr;
}

std::uint8_t Scene::lobes(const Hit& hit) const {
    view_.parts.expect(ScenePart::materials);
    return built_->shading.lobes(hit.geometry);
}

Bsdf Scene::bsdf(const SurfacePoint& point) const {
    view_.parts.expect(ScenePart::materials);
    return point.is_in_space() ? built_->media.bsdf(point) : built_->shading.bsdf(point);
}

void Scene::add_bsdfs(std::span<const SurfacePoint> points, std::vector<Bsdf>& to) const {
    view_.parts.expect(ScenePart::materials);
    if (!has_media_) return built_->shading.add_bsdfs(points, to);
    for (const SurfacePoint& point : points) to.push_back(bsdf(point));
}

SurfacePoint Scene::point_in_space(Vec3 position, std::uint16_t medium, ShutterTime time) const {
    view_.parts.expect(ScenePart::media);
    SurfacePoint point = built_->media.point(position, medium);
    point.time = time;
    return point;
}

const Media& Scene::media() const { return view_.parts.expect(ScenePart::media), built_->media; }

bool Scene::may_shine(const Ray& ray) const {
    return lights().has_environment() || lights().may_meet_lamp(ray) || lights().sun(ray.direction);
}

Ray Scene::ray_to(const SurfacePoint& from, const LightSample& lamp) const {
    const Vec3 origin = from.origin_towards(lamp.direction);
    return lamp.from_infinity ? Ray{origin, lamp.direction, Ray().far, from.time}
                              : ray_between(origin, lamp.position, lamp.direction, from.time);
}

Box Scene::bounds() const { return view_.parts.expect(ScenePart::geometry), built_->box; }
float Scene::radius() const { return view_.parts.expect(ScenePart::geometry), length(built_->box.size()) / 2; }

SceneSize Scene::size() const {
    view_.parts.expect(whole_scene);
    return size_of(built_->data, built_->geometry(), *lights_);
}

std::uint64_t Scene::rays_of_this_thread() { return Geometry::rays_of_this_thread(); }

}  // namespace lightnet
