#include "core/scene/geometry/geometry.hpp"

#include "core/base/allowance.hpp"
#include "core/base/error.hpp"
#include "core/base/spare_threads.hpp"
#include "core/base/unwanted.hpp"
#include "core/scene/data/contents.hpp"
#include "core/scene/geometry/form.hpp"
#include "core/scene/geometry/lost_rays.hpp"
#include "core/scene/geometry/quads.hpp"
#include "core/scene/surfaces/placement.hpp"

#include <embree/rtcore.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace lightnet {
namespace {

thread_local std::uint64_t rays_traced = 0;
thread_local LostRays* told_of_lost = nullptr;

// Before they are traced: whoever traces many looks whether they are still wanted.
void count(std::size_t rays) {
    constexpr std::uint64_t between_looks = 1024;
    const std::uint64_t before = rays_traced;
    rays_traced += rays;
    if (before / between_looks != rays_traced / between_looks) end_if_unwanted();
}

void set(RTCRay& to, const Ray& ray) {
    to = {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          0,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          part_of_shutter(ray.time),
          ray.far,
          ~0u,
          0,
          0};
}

/// Embree's packets, in the width that an instruction set has: others are cut up and copied inside.
struct PacketOf8 {
    static constexpr std::size_t lanes = 8;
    using Rays = RTCRay8;
    using RayHits = RTCRayHit8;
    static void intersect(const int* valid, RTCScene scene, RayHits& rays) { rtcIntersect8(valid, scene, &rays); }
    static void occluded(const int* valid, RTCScene scene, Rays& rays) { rtcOccluded8(valid, scene, &rays); }
};
struct PacketOf4 {
    static constexpr std::size_t lanes = 4;
    using Rays = RTCRay4;
    using RayHits = RTCRayHit4;
    static void intersect(const int* valid, RTCScene scene, RayHits& rays) { rtcIntersect4(valid, scene, &rays); }
    static void occluded(const int* valid, RTCScene scene, Rays& rays) { rtcOccluded4(valid, scene, &rays); }
};

// Fills lanes that have nothing to do. `valid` alone does not keep Embree from them: where its packets are narrower
// than ours it goes by the rays, and traces each that does not end before it begins.
constexpr Ray no_ray{{0, 0, 0}, {0, 0, 1}, -std::numeric_limits<float>::infinity()};

template <std::size_t lanes>
using Valid = std::array<int, lanes>;

// DECISIONS: far-is-nowhere
// Can Embree trace it? It would end the process over a ray that is not finite, or longer than it takes. `farthest`: no
// coordinate may be larger.
bool is_traceable(const Ray& ray, float farthest) {
    const float x = std::fabs(ray.direction.x), y = std::fabs(ray.direction.y), z = std::fabs(ray.direction.z);
    return (std::fabs(ray.origin.x) <= farthest) & (std::fabs(ray.origin.y) <= farthest) &
           (std::fabs(ray.origin.z) <= farthest) & (x <= farthest) & (y <= farthest) & (z <= farthest) &
           ((x > 0) | (y > 0) | (z > 0)) & (ray.far == ray.far);
}

// Rays that can't be traced meet nothing. One that ends where it begins was not meant to.
void lose(const Ray& ray) {
    if (told_of_lost && !(ray.far <= 0)) told_of_lost->lost();
}

// The same for a packet, of which few have such a ray.
template <std::size_t lanes, class Packet>
[[gnu::noinline]] void take_out_lost(Packet& packet, Valid<lanes>& valid, std::span<const Ray> rays, float farthest) {
    for (std::size_t i = 0; i < rays.size() && i < lanes; ++i) {
        if (is_traceable(rays[i], farthest)) continue;
        lose(rays[i]);
        valid[i] = 0;
        packet.org_x[i] = packet.org_y[i] = packet.org_z[i] = 0;
        packet.dir_x[i] = packet.dir_y[i] = 0, packet.dir_z[i] = 1;
        packet.tfar[i] = no_ray.far;
    }
}

// Fills a packet's rays, and says which lanes there are.
template <std::size_t lanes, class Packet>
void fill(Packet& packet, Valid<lanes>& valid, std::span<const Ray> rays, float farthest) {
    for (std::size_t i = 0; i < lanes; ++i) {
        const Ray& ray = i < rays.size() ? rays[i] : no_ray;
        packet.org_x[i] = ray.origin.x;
        packet.org_y[i] = ray.origin.y;
        packet.org_z[i] = ray.origin.z;
        packet.dir_x[i] = ray.direction.x;
        packet.dir_y[i] = ray.direction.y;
        packet.dir_z[i] = ray.direction.z;
        packet.tfar[i] = ray.far;
        packet.time[i] = part_of_shutter(ray.time);
    }
    for (std::size_t i = 0; i < lanes; ++i) {
        valid[i] = i < rays.size() ? -1 : 0;
        packet.tnear[i] = 0;
        packet.mask[i] = ~0u;
        packet.id[i] = packet.flags[i] = 0;
    }
    int lost = 0;
    for (std::size_t i = 0; i < lanes; ++i) {
        const float x = std::fabs(packet.dir_x[i]), y = std::fabs(packet.dir_y[i]), z = std::fabs(packet.dir_z[i]);
        lost |= !(std::fabs(packet.org_x[i]) <= farthest) | !(std::fabs(packet.org_y[i]) <= farthest) |
                !(std::fabs(packet.org_z[i]) <= farthest) | !(x <= farthest) | !(y <= farthest) | !(z <= farthest) |
                !(x + y + z > 0) | (packet.tfar[i] != packet.tfar[i]);
    }
    if (lost) take_out_lost<lanes>(packet, valid, rays, farthest);
}

template <class Wide>
void look_through(RTCScene scene, float farthest, std::span<const Ray> rays, std::span<std::uint8_t> hidden) {
    for (std::size_t first = 0; first < rays.size(); first += Wide::lanes) {
        alignas(64) Valid<Wide::lanes> valid;
        alignas(64) typename Wide::Rays packet;
        const std::size_t count = std::min(Wide::lanes, rays.size() - first);
        fill<Wide::lanes>(packet, valid, rays.subspan(first, count), farthest);
        Wide::occluded(valid.data(), scene, packet);
        for (std::size_t i = 0; i < count; ++i) hidden[first + i] = valid[i] && packet.tfar[i] < 0;
    }
}

// Embree takes names that it doesn't know, or whose processor isn't here, for something else, and says nothing.
bool has_isa(const std::string& isa) {
    __builtin_cpu_init();
    return (isa == "sse2" && __builtin_cpu_supports("sse2")) || (isa == "sse4.2" && __builtin_cpu_supports("sse4.2")) ||
           (isa == "avx" && __builtin_cpu_supports("avx")) || (isa == "avx2" && __builtin_cpu_supports("avx2"));
}

// Embree ends the process when it gets no thread. One of them is the caller's.
unsigned building_threads([[maybe_unused]] unsigned asked) {
#if defined(__SANITIZE_THREAD__)  // it can't see how Embree's threads wait for each other
    return 1;
#else
    const unsigned wanted = asked ? asked : usable_cores();
    if (try_threads(wanted + 1) > wanted) return wanted;
    want_threads(1, "what finds surfaces");  // which it starts in any case, at the latest when it goes
    return 1;
#endif
}

// A tree does not depend on how many threads build it: Embree puts what they hand over into a fixed order. A test of
// exactly this stands in the project.
RTCDevice device_for(const Geometry::Options& options) {
    const std::string& isa = options.isa;
    if (!has_isa(isa)) throw Error("scene", "this processor, or Embree, has no instruction set '" + isa + "'");
    const unsigned threads = building_threads(options.threads);
    // DECISIONS: trees-by-all-cores
    // Its cache of subdivided surfaces, of which we have none, takes 128 MiB of addresses. Where these can't be had it
    // leaves a lock of its own locked, and the end of the next device would wait for that for ever.
    const std::string config =
        "start_threads=0,threads=" + std::to_string(threads) + ",isa=" + isa + ",tessellation_cache_size=0";
    if (RTCDevice device = rtcNewDevice(config.c_str())) return device;
    if (rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY)
        throw Error("scene", "there is not enough memory for what finds surfaces");
    throw Error("scene", "Embree gives no device for instruction set '" + isa + "'");
}

}  // namespace

struct Geometry::Tracer {
    Tracer(SceneData& shapes_of, const Options& options)
        : data(shapes_of),
          device(device_for(options)),
          scene(rtcNewScene(device)),
          eight(rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0) {
        rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
    }
    ~Tracer() {
        for (const auto geometry : geometries)
            if (geometry) rtcReleaseGeometry(geometry);
        for (const auto object : objects)
            if (object) rtcReleaseScene(object);
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Tracer(const Tracer&) = delete;
    Tracer& operator=(const Tracer&) = delete;

    // Threads that build a tree ask whether it is still wanted.
    static bool goes_on(void* stop, double) {
        return !stop || !static_cast<const std::atomic<bool>*>(stop)->load(std::memory_order_relaxed);
    }
    // They count at once.
    static bool count_bytes(void* pointer, ssize_t bytes, bool) {
        static_cast<std::atomic<std::ptrdiff_t>*>(pointer)->fetch_add(bytes, std::memory_order_relaxed);
        return true;
    }

    // A shape may be part of several objects.
    void attach(RTCScene to, Shape& shape, unsigned id) {
        const auto index = std::size_t(&shape - data.shapes.data());
        RTCGeometry& geometry = geometries[index];
        if (!geometry) {
            geometry = new_geometry(device, shape, forms[index], SceneMotion::steps_after(data.motion.shapes, index));
            rtcCommitGeometry(geometry);
        }
        rtcAttachGeometryByID(to, geometry, id);
    }
    void attach(const Instance& instance, unsigned id) {
        std::vector<Placement> steps{Placement(instance.to_world)};  // may throw: before there is what would leak
        for (const Matrix& later : SceneMotion::steps_after(data.motion.instances, id - data.shapes.size()))
            steps.emplace_back(later);
        for (const Placement& placement : steps)
            farthest = std::clamp(float(placement.farthest_outside(1e18)), 0.0f, farthest);
        alone |= steps.size() > 1;
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, objects[instance.object]);
        rtcSetGeometryTimeStepCount(geometry, unsigned(steps.size()));
        for (unsigned i = 0; i < steps.size(); ++i)
            rtcSetGeometryTransform(geometry, i, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, steps[i].columns().data());
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }
    void commit(RTCScene what) const {
        // DECISIONS: robust-trees
        rtcSetSceneFlags(what, hair ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneProgressMonitorFunction(what, goes_on, const_cast<std::atomic<bool>*>(LookingAt::now()));
        rtcCommitScene(what);
        const auto code = rtcGetDeviceError(device);
        end_if_unwanted();
        if (code != RTC_ERROR_NONE)
            throw Error("scene", "Embree can't build the scene (its error " + std::to_string(int(code)) + ")");
    }

    // Embree numbers the shapes of an object for itself.
    Hit hit(unsigned instance, unsigned geometry, unsigned primitive, Vec2 at, Vec3 normal, float distance,
            ShutterTime time) const {
        if (instance != RTC_INVALID_GEOMETRY_ID) {
            instance -= unsigned(data.shapes.size());
            geometry = data.objects[data.instances[instance].object].shapes[geometry];
        }
        const TrianglePoint point = forms[geometry].point(primitive, at, normal);
        return {instance, geometry, point.triangle, point.at.x, point.at.y, distance, time};
    }
    template <class Wide>
    void meet(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;

    SceneData& data;
    std::atomic<std::ptrdiff_t> bytes = 0;  // before the device, which counts on it to its end
    std::vector<Form> forms;                // by shape
    RTCDevice device;
    RTCScene scene;
    std::vector<RTCGeometry> geometries;  // by shape; null: never to be met
    std::vector<RTCScene> objects;        // the same
    bool eight;                           // rays are traced at once; else four
    bool hair = false;                    // it needs compact trees
    bool alone = false;                   // all are: packets have other roundings where instances move
    float farthest = 1e17f;               // coordinate of rays, which instances may stretch; Embree's own is 1.8e18
};

template <class Wide>
void Geometry::Tracer::meet(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
    for (std::size_t first = 0; first < rays.size(); first += Wide::lanes) {
        alignas(64) Valid<Wide::lanes> valid;
        alignas(64) typename Wide::RayHits together;
        const std::size_t count = std::min(Wide::lanes, rays.size() - first);
        fill<Wide::lanes>(together.ray, valid, rays.subspan(first, count), farthest);
        for (std::size_t i = 0; i < Wide::lanes; ++i)
            together.hit.geomID[i] = together.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        Wide::intersect(valid.data(), scene, together);
        const auto& found = together.hit;
        for (std::size_t i = 0; i < count; ++i) {
            if (found.geomID[i] == RTC_INVALID_GEOMETRY_ID)
                hits[first + i].reset();
            else
                hits[first + i] =
                    hit(found.instID[0][i], found.geomID[i], found.primID[i], {found.u[i], found.v[i]},
                        {found.Ng_x[i], found.Ng_y[i], found.Ng_z[i]}, together.ray.tfar[i], rays[first + i].time);
        }
    }
}

Geometry::Geometry(SceneData& data, const Shading& shading, const Options& options)
    : tracer_(std::make_unique<Tracer>(data, options)) {
    Tracer& tracer = *tracer_;
    const auto shapes = std::uint32_t(data.shapes.size());
    std::vector<bool> in_object(shapes), used(data.objects.size());
    for (const auto& object : data.objects)
        for (const auto shape : object.shapes) in_object[shape] = true;
    for (const auto& instance : data.instances) used[instance.object] = true;
    for (std::uint32_t s = 0; s < shapes; ++s)
        tracer.forms.push_back({&shading, s, shading.has_holes(s), nullptr, nullptr, shading.moving(s)});
    if (triangles_of(data) >= options.quads_from) pair_triangles(data, tracer.forms);
    const auto is_there = [&](std::uint32_t shape) {
        return !std::holds_alternative<NoMaterial>(data.materials[data.shapes[shape].material].model);
    };

    // In the order of the files: a shape's index is its name.
    tracer.geometries.resize(shapes);
    tracer.hair = tracer.alone = has_curves(data);  // packets have other roundings there, too
    tracer.objects.resize(data.objects.size());
    for (std::size_t o = 0; o < data.objects.size(); ++o) {
        const auto& parts = data.objects[o].shapes;
        if (!used[o] || std::none_of(parts.begin(), parts.end(), is_there)) continue;
        tracer.objects[o] = rtcNewScene(tracer.device);
        for (std::uint32_t i = 0; i < parts.size(); ++i)
            if (is_there(parts[i])) tracer.attach(tracer.objects[o], data.shapes[parts[i]], i);
        tracer.commit(tracer.objects[o]);
    }
    for (std::uint32_t s = 0; s < shapes; ++s)
        if (!in_object[s] && is_there(s)) tracer.attach(tracer.scene, data.shapes[s], s);
    for (std::uint32_t i = 0; i < data.instances.size(); ++i)
        if (tracer.objects[data.instances[i].object]) tracer.attach(data.instances[i], shapes + i);
    tracer.commit(tracer.scene);
}

Geometry::~Geometry() = default;

std::optional<Hit> Geometry::intersect(const Ray& ray) const {
    count(1);
    if (!is_traceable(ray, tracer_->farthest)) return lose(ray), std::nullopt;
    RTCRayHit query;
    set(query.ray, ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tracer_->scene, &query);
    const auto& hit = query.hit;
    if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return tracer_->hit(hit.instID[0], hit.geomID, hit.primID, {hit.u, hit.v}, {hit.Ng_x, hit.Ng_y, hit.Ng_z},
                        query.ray.tfar, ray.time);
}

void Geometry::intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
    assert(rays.size() == hits.size() && "each ray has its hit");
    if (tracer_->alone) {
        for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = intersect(rays[i]);
        return;
    }
    count(rays.size());
    tracer_->eight ? tracer_->meet<PacketOf8>(rays, hits) : tracer_->meet<PacketOf4>(rays, hits);
}

bool Geometry::occluded(const Ray& ray) const {
    count(1);
    if (!is_traceable(ray, tracer_->farthest)) return lose(ray), false;
    RTCRay query;
    set(query, ray);
    rtcOccluded1(tracer_->scene, &query);
    return query.tfar < 0;
}

void Geometry::occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const {
    assert(rays.size() == hidden.size() && "each ray has its answer");
    if (tracer_->alone) {
        for (std::size_t i = 0; i < rays.size(); ++i) hidden[i] = occluded(rays[i]);
        return;
    }
    count(rays.size());
    tracer_->eight ? look_through<PacketOf8>(tracer_->scene, tracer_->farthest, rays, hidden)
                   : look_through<PacketOf4>(tracer_->scene, tracer_->farthest, rays, hidden);
}

std::optional<Hit> Geometry::nearest(const PlacedSurfaces& surfaces, const SurfaceWish& wish) const {
    const auto sound = [&](float coordinate) { return std::fabs(coordinate) <= tracer_->farthest; };
    if (!sound(wish.position.x) || !sound(wish.position.y) || !sound(wish.position.z) || !sound(wish.reach)) return {};
    return nearest_surface(tracer_->scene, tracer_->forms, surfaces, wish);
}

Box Geometry::bounds() const {
    RTCBounds box;
    rtcGetSceneBounds(tracer_->scene, &box);
    return {{box.lower_x, box.lower_y, box.lower_z}, {box.upper_x, box.upper_y, box.upper_z}};
}

std::size_t Geometry::memory() const {
    std::size_t bytes = std::size_t(std::max<std::ptrdiff_t>(0, tracer_->bytes));
    for (const Form& form : tracer_->forms) bytes += form.quads.memory();
    return bytes;
}

std::uint64_t Geometry::rays_of_this_thread() { return rays_traced; }

LostRays* tell_of_lost_rays(LostRays* told) { return std::exchange(told_of_lost, told); }

}  // namespace lightnet
