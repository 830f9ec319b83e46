#include "core/scene/geometry.hpp"

#include "core/error.hpp"
#include "core/math/octahedral.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace lightnet {
namespace {

thread_local std::uint64_t rays_traced = 0;

// A sphere's own test, in double: Embree's points lose too much near the surface that a ray leaves.
std::optional<float> nearest_root(const Sphere& sphere, Vec3 origin, Vec3 direction, float near, float far) {
    const double dx = direction.x, dy = direction.y, dz = direction.z;
    const double fx = double{origin.x} - sphere.center.x, fy = double{origin.y} - sphere.center.y,
                 fz = double{origin.z} - sphere.center.z;
    const double a = dx * dx + dy * dy + dz * dz, half_b = fx * dx + fy * dy + fz * dz, r = sphere.radius;
    const double s = half_b / a;
    const double lx = fx - s * dx, ly = fy - s * dy, lz = fz - s * dz;  // from the centre to the line
    const double rest = r * r - (lx * lx + ly * ly + lz * lz);
    if (rest < 0) return {};
    const double half_chord = std::sqrt(rest / a);
    for (const double t : {-s - half_chord, -s + half_chord})
        if (t > near && t < far) return float(t);
    return {};
}

void sphere_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& sphere = *static_cast<const Sphere*>(args->geometryUserPtr);
    const float r = sphere.radius * (1 + 1e-6f);
    const auto low = [r](float c) { return c - r - std::fabs(c) * 1e-6f; };
    const auto high = [r](float c) { return c + r + std::fabs(c) * 1e-6f; };
    const Vec3 c = sphere.center;
    *args->bounds_o = {low(c.x), low(c.y), low(c.z), 0, high(c.x), high(c.y), high(c.z), 0};
}

void meet_sphere(const RTCIntersectFunctionNArguments* args) {
    const auto& sphere = *static_cast<const Sphere*>(args->geometryUserPtr);
    const unsigned n = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
    for (unsigned i = 0; i < n; ++i) {
        if (!args->valid[i]) continue;
        const Vec3 o{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)};
        const Vec3 d{RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
        const auto t = nearest_root(sphere, o, d, RTCRayN_tnear(rays, n, i), RTCRayN_tfar(rays, n, i));
        if (!t) continue;
        const Vec2 name = to_octahedral(normalize(o + d * *t - sphere.center));
        RTCRayN_tfar(rays, n, i) = *t;
        RTCHitN_u(hits, n, i) = name.x;
        RTCHitN_v(hits, n, i) = name.y;
        RTCHitN_geomID(hits, n, i) = args->geomID;
        RTCHitN_primID(hits, n, i) = args->primID;
        RTCHitN_instID(hits, n, i, 0) = args->context->instID[0];
    }
}

void hide_behind_sphere(const RTCOccludedFunctionNArguments* args) {
    const auto& sphere = *static_cast<const Sphere*>(args->geometryUserPtr);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (!args->valid[i]) continue;
        const Vec3 o{RTCRayN_org_x(args->ray, n, i), RTCRayN_org_y(args->ray, n, i), RTCRayN_org_z(args->ray, n, i)};
        const Vec3 d{RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i), RTCRayN_dir_z(args->ray, n, i)};
        if (nearest_root(sphere, o, d, RTCRayN_tnear(args->ray, n, i), RTCRayN_tfar(args->ray, n, i)))
            RTCRayN_tfar(args->ray, n, i) = -INFINITY;
    }
}

RTCGeometry make(RTCDevice device, Mesh& mesh) {
    const std::size_t vertices = mesh.positions.size();
    mesh.positions.emplace_back();  // Embree reads 16 bytes of the last vertex
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(Vec3), vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(mesh.triangles[0]), mesh.triangles.size());
    return geometry;
}

RTCGeometry make(RTCDevice device, Sphere& sphere) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, &sphere);
    rtcSetGeometryBoundsFunction(geometry, sphere_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, meet_sphere);
    rtcSetGeometryOccludedFunction(geometry, hide_behind_sphere);
    return geometry;
}

// Not "coherent": with that flag a lane's hit depends on its neighbours.
RTCIntersectContext any_rays() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

void set(RTCRay& to, const Ray& ray) {
    to = {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          0,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          0,
          ray.far,
          ~0u,
          0,
          0};
}

constexpr std::size_t lanes = 16;

// Fills lanes that have nothing to do. `valid` alone does not keep Embree from them: where its packets are narrower
// than ours it goes by the rays, and traces each that does not end before it begins.
constexpr Ray no_ray{{0, 0, 0}, {0, 0, 1}, -std::numeric_limits<float>::infinity()};

void trace_packet(RTCScene scene, std::span<const Ray> rays, std::span<std::optional<Hit>> hits) {
    alignas(64) std::array<int, lanes> valid;
    alignas(64) RTCRayHit16 packet;
    for (std::size_t i = 0; i < lanes; ++i) {
        const Ray& ray = i < rays.size() ? rays[i] : no_ray;
        valid[i] = i < rays.size() ? -1 : 0;
        packet.ray.org_x[i] = ray.origin.x;
        packet.ray.org_y[i] = ray.origin.y;
        packet.ray.org_z[i] = ray.origin.z;
        packet.ray.tnear[i] = 0;
        packet.ray.dir_x[i] = ray.direction.x;
        packet.ray.dir_y[i] = ray.direction.y;
        packet.ray.dir_z[i] = ray.direction.z;
        packet.ray.time[i] = 0;
        packet.ray.tfar[i] = ray.far;
        packet.ray.mask[i] = ~0u;
        packet.ray.id[i] = 0;
        packet.ray.flags[i] = 0;
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    auto context = any_rays();
    rtcIntersect16(valid.data(), scene, &context, &packet);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID)
            hits[i].reset();
        else
            hits[i] = Hit{packet.hit.instID[0][i], packet.hit.geomID[i], packet.hit.primID[i],
                          packet.hit.u[i],         packet.hit.v[i],      packet.ray.tfar[i]};
    }
}

}  // namespace

namespace {

// Embree takes names that it doesn't know, or whose processor isn't here, for something else, and says nothing.
bool has_isa(const std::string& isa) {
    __builtin_cpu_init();
    return (isa == "sse2" && __builtin_cpu_supports("sse2")) || (isa == "sse4.2" && __builtin_cpu_supports("sse4.2")) ||
           (isa == "avx" && __builtin_cpu_supports("avx")) || (isa == "avx2" && __builtin_cpu_supports("avx2"));
}

RTCDevice device_for(const std::string& isa) {
    if (!has_isa(isa)) throw Error("scene", "this processor, or Embree, has no instruction set '" + isa + "'");
    if (RTCDevice device = rtcNewDevice(("threads=1,start_threads=0,isa=" + isa).c_str())) return device;
    throw Error("scene", "Embree gives no device for instruction set '" + isa + "'");
}

}  // namespace

struct Geometry::Tracer {
    explicit Tracer(const std::string& isa) : device(device_for(isa)), scene(rtcNewScene(device)) {}
    ~Tracer() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Tracer(const Tracer&) = delete;
    Tracer& operator=(const Tracer&) = delete;

    RTCDevice device;
    RTCScene scene;
};

Geometry::Geometry(std::vector<Shape>& shapes, const std::string& isa) : tracer_(std::make_unique<Tracer>(isa)) {
    for (auto& shape : shapes) {  // in file order: a shape's index is its name
        RTCGeometry geometry = std::visit([&](auto& form) { return make(tracer_->device, form); }, shape.geometry);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tracer_->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    // No ray may slip between two triangles that share an edge.
    rtcSetSceneFlags(tracer_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(tracer_->scene);
    if (const auto code = rtcGetDeviceError(tracer_->device); code != RTC_ERROR_NONE)
        throw Error("scene", "Embree can't build the scene (its error " + std::to_string(int(code)) + ")");
}

Geometry::~Geometry() = default;

std::optional<Hit> Geometry::intersect(const Ray& ray) const {
    ++rays_traced;
    RTCRayHit query;
    set(query.ray, ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    auto context = any_rays();
    rtcIntersect1(tracer_->scene, &context, &query);
    const auto& hit = query.hit;
    if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return Hit{hit.instID[0], hit.geomID, hit.primID, hit.u, hit.v, query.ray.tfar};
}

void Geometry::intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
    assert(rays.size() == hits.size() && "each ray has its hit");
    rays_traced += rays.size();
    for (std::size_t first = 0; first < rays.size(); first += lanes) {
        const std::size_t count = std::min(lanes, rays.size() - first);
        trace_packet(tracer_->scene, rays.subspan(first, count), hits.subspan(first, count));
    }
}

bool Geometry::occluded(const Ray& ray) const {
    ++rays_traced;
    RTCRay query;
    set(query, ray);
    auto context = any_rays();
    rtcOccluded1(tracer_->scene, &context, &query);
    return query.tfar < 0;
}

Geometry::Box Geometry::bounds() const {
    RTCBounds box;
    rtcGetSceneBounds(tracer_->scene, &box);
    return {{box.lower_x, box.lower_y, box.lower_z}, {box.upper_x, box.upper_y, box.upper_z}};
}

std::uint64_t Geometry::rays_of_this_thread() { return rays_traced; }

}  // namespace lightnet
