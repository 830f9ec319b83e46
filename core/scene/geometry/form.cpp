#include "core/scene/geometry/form.hpp"

#include "core/base/math/columns.hpp"
#include "core/scene/data/contents.hpp"
#include "core/scene/geometry/sphere_hit.hpp"

#include <embree/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace lightnet {
namespace {

const Form& form_of(void* pointer) { return *static_cast<const Form*>(pointer); }

Vec3 normal_of(RTCHitN* hit, unsigned n, unsigned i) {
    return {RTCHitN_Ng_x(hit, n, i), RTCHitN_Ng_y(hit, n, i), RTCHitN_Ng_z(hit, n, i)};
}

TrianglePoint point_of(const Form& form, RTCHitN* hit, unsigned n, unsigned i) {
    return form.point(RTCHitN_primID(hit, n, i), {RTCHitN_u(hit, n, i), RTCHitN_v(hit, n, i)}, normal_of(hit, n, i));
}

// Lets rays through the holes of meshes.
void pass_holes(const RTCFilterFunctionNArguments* args) {
    const Form& form = form_of(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        if (!form.is_there(point_of(form, args->hit, args->N, i))) args->valid[i] = 0;
    }
}

// Lets rays through the inside of curves, and through holes.
void pass_inside(const RTCFilterFunctionNArguments* args) {
    const Form& form = form_of(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        const Vec3 direction{RTCRayN_dir_x(args->ray, args->N, i), RTCRayN_dir_y(args->ray, args->N, i),
                             RTCRayN_dir_z(args->ray, args->N, i)};
        const bool outside = dot(direction, normal_of(args->hit, args->N, i)) < 0;
        if (!outside || !form.is_there(point_of(form, args->hit, args->N, i))) args->valid[i] = 0;
    }
}

void sphere_bounds(const RTCBoundsFunctionArguments* args) {
    const Form& form = form_of(args->geometryUserPtr);
    const Sphere& sphere = form.moving ? std::get<Sphere>(form.moving->at_step(args->timeStep)) : *form.sphere;
    const float r = sphere.radius * (1 + 1e-6f);
    const auto low = [r](float c) { return c - r - std::fabs(c) * 1e-6f; };
    const auto high = [r](float c) { return c + r + std::fabs(c) * 1e-6f; };
    const Vec3 c = sphere.center;
    *args->bounds_o = {low(c.x), low(c.y), low(c.z), 0, high(c.x), high(c.y), high(c.z), 0};
}

void quadric_bounds(const RTCBoundsFunctionArguments* args) {
    const Form& form = form_of(args->geometryUserPtr);
    const Box box = form.moving ? PlacedQuadric(std::get<Quadric>(form.moving->at_step(args->timeStep))).bounds()
                                : form.quadric->bounds();
    *args->bounds_o = {box.low.x, box.low.y, box.low.z, 0, box.high.x, box.high.y, box.high.z, 0};
}

template <class Accept>
void meet(const PlacedQuadric& quadric, Vec3 origin, Vec3 direction, float near, float far, Accept accept) {
    quadric.meet(origin, direction, near, far, accept);
}

template <class Round>
const Round& round_of(const Form& form) {
    if constexpr (std::is_same_v<Round, Sphere>)
        return *form.sphere;
    else
        return *form.quadric;
}

// As it stands at a time.
template <class Round, class With>
void with_round(const MovingShape& moving, float open, const With& with) {
    if constexpr (std::is_same_v<Round, Sphere>)
        with(moving.sphere(open));
    else {
        const Quadric quadric = moving.quadric(open);
        with(PlacedQuadric(quadric));
    }
}

constexpr unsigned most_rays = 16;  // in a packet of Embree's

/// Which rays of a packet meet a sphere at all, up to `stretch` times as far as they go: all at once, as most don't.
struct MeetingSphere {
    Vec3 center;
    float radius, stretch;
    unsigned n;
    std::array<float, most_rays> x, y, z, dx, dy, dz, near, far;
    std::array<std::uint64_t, most_rays> met;  // as wide as the numbers of the formula

    MeetingSphere(const Sphere& sphere, RTCRayN* rays, unsigned count, float stretched)
        : center(sphere.center), radius(sphere.radius), stretch(stretched), n(count) {
        const auto copy = [&](const float& first, auto& to) { std::copy_n(&first, n, to.begin()); };
        copy(RTCRayN_org_x(rays, n, 0), x), copy(RTCRayN_org_y(rays, n, 0), y), copy(RTCRayN_org_z(rays, n, 0), z);
        copy(RTCRayN_dir_x(rays, n, 0), dx), copy(RTCRayN_dir_y(rays, n, 0), dy), copy(RTCRayN_dir_z(rays, n, 0), dz);
        copy(RTCRayN_tnear(rays, n, 0), near), copy(RTCRayN_tfar(rays, n, 0), far);
    }
    [[gnu::always_inline]] void work() {
        for (unsigned i = 0; i < n; ++i) {
            const auto [first, second] = crossings(center, radius, {x[i], y[i], z[i]}, {dx[i], dy[i], dz[i]});
            const double from = near[i], to = far[i] * stretch;
            met[i] = ((first > from) & (first < to)) | ((second > from) & (second < to));
        }
    }
};

/// Which rays of a packet may meet a form: spheres are tried, quadrics may all be met.
template <class Round>
std::array<std::uint64_t, most_rays> which_may_meet(const Form& form, RTCRayN* rays, unsigned n, float stretch) {
    if (std::is_same_v<Round, Sphere> && !form.moving) {
        MeetingSphere meeting(*form.sphere, rays, n, stretch);
        work_in_lanes(meeting);
        return meeting.met;
    } else {
        std::array<std::uint64_t, most_rays> all;
        all.fill(1);
        return all;
    }
}

// Calls `found(distance, name)` with points of a sphere or quadric that are there and nearer than `far`, until it
// returns true.
template <class Round, class Found>
void nearest_on_round(const Form& form, RTCRayN* rays, unsigned n, unsigned i, float far, Found found) {
    const Vec3 origin{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)};
    const Vec3 direction{RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
    const auto accept = [&](float t, Vec2 name) { return form.is_there({0, name}) && found(t, name); };
    const auto meet_it = [&](const Round& round) {
        meet(round, origin, direction, RTCRayN_tnear(rays, n, i), far, accept);
    };
    if (form.moving)
        with_round<Round>(*form.moving, RTCRayN_time(rays, n, i), meet_it);
    else
        meet_it(round_of<Round>(form));
}

// Where two are met at one distance, the first by instance and shape counts: packets come to them in another order than
// single rays.
template <class Round>
void meet_round(const RTCIntersectFunctionNArguments* args) {
    const unsigned n = args->N, instance = args->context->instID[0];
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
    constexpr float just_beyond = 1 + 0x1p-23f;  // an equal distance is looked at, too
    const auto may_meet = which_may_meet<Round>(form_of(args->geometryUserPtr), rays, n, just_beyond);
    for (unsigned i = 0; i < n; ++i) {
        if (!args->valid[i] || !may_meet[i]) continue;
        const float far = RTCRayN_tfar(rays, n, i);
        const auto found = [&](float t, Vec2 name) {
            const unsigned other = RTCHitN_geomID(hits, n, i), its_instance = RTCHitN_instID(hits, n, i, 0);
            const bool first = other != RTC_INVALID_GEOMETRY_ID &&
                               (instance != its_instance ? instance < its_instance : args->geomID < other);
            if (!(t < far) && !(t == far && first)) return false;
            RTCRayN_tfar(rays, n, i) = t;
            RTCHitN_u(hits, n, i) = name.x;
            RTCHitN_v(hits, n, i) = name.y;
            RTCHitN_geomID(hits, n, i) = args->geomID;
            RTCHitN_primID(hits, n, i) = args->primID;
            RTCHitN_instID(hits, n, i, 0) = instance;
            return true;
        };
        nearest_on_round<Round>(form_of(args->geometryUserPtr), rays, n, i, far * just_beyond, found);
    }
}

template <class Round>
void hide_behind_round(const RTCOccludedFunctionNArguments* args) {
    const unsigned n = args->N;
    const Form& form = form_of(args->geometryUserPtr);
    const auto may_meet = which_may_meet<Round>(form, args->ray, n, 1);
    for (unsigned i = 0; i < n; ++i) {
        if (!args->valid[i] || !may_meet[i]) continue;
        const auto hide = [&](auto...) {
            RTCRayN_tfar(args->ray, n, i) = -INFINITY;
            return true;
        };
        if (std::is_same_v<Round, Sphere> && !form.holes && !form.moving)
            hide();
        else
            nearest_on_round<Round>(form, args->ray, n, i, RTCRayN_tfar(args->ray, n, i), hide);
    }
}

template <std::size_t corners>
void share_faces(RTCGeometry geometry, const std::vector<std::array<std::uint32_t, corners>>& faces) {
    constexpr auto format = corners == 4 ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3;
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, format, faces.data(), 0, sizeof(faces[0]),
                               faces.size());
}

void share_vertices(RTCGeometry geometry, unsigned step, Mesh& mesh) {
    const std::size_t vertices = mesh.positions.size();
    mesh.positions.reserve(vertices + 1);
    mesh.positions.emplace_back();  // Embree reads 16 bytes of the last vertex
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(Vec3), vertices);
}

RTCGeometry make(RTCDevice device, Mesh& mesh, Form& form) {
    const bool paired = !form.quads.empty();
    RTCGeometry geometry = rtcNewGeometry(device, paired ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
    share_vertices(geometry, 0, mesh);
    paired ? share_faces(geometry, form.quads.corners()) : share_faces(geometry, mesh.triangles);
    if (form.holes) {
        rtcSetGeometryIntersectFilterFunction(geometry, pass_holes);
        rtcSetGeometryOccludedFilterFunction(geometry, pass_holes);
    }
    return geometry;
}

template <class Round>
RTCGeometry round_geometry(RTCDevice device, RTCBoundsFunction bounds) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, meet_round<Round>);
    rtcSetGeometryOccludedFunction(geometry, hide_behind_round<Round>);
    return geometry;
}

RTCGeometry make(RTCDevice device, Sphere& sphere, Form& form) {
    form.sphere = &sphere;
    return round_geometry<Sphere>(device, sphere_bounds);
}

RTCGeometry make(RTCDevice device, Quadric&, Form& form) {
    form.quadric = &std::get<PlacedQuadric>(form.shading->placed(form.shape));
    return round_geometry<PlacedQuadric>(device, quadric_bounds);
}

// A control point has 16 bytes, so that nothing needs to be padded.
RTCGeometry make(RTCDevice device, Curves& curves, Form& form) {
    form.curves = &curves;
    const auto type = curves.basis == Curves::Basis::bezier ? RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE
                                                            : RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE;
    RTCGeometry geometry = rtcNewGeometry(device, type);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, curves.points.data(), 0,
                               sizeof(curves.points[0]), curves.points.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, curves.segments.data(), 0,
                               sizeof(curves.segments[0]), curves.segments.size());
    rtcSetGeometryIntersectFilterFunction(geometry, pass_inside);
    rtcSetGeometryOccludedFilterFunction(geometry, pass_inside);
    return geometry;
}

}  // namespace

// DECISIONS: quads-of-triangles
void pair_triangles(const SceneData& data, std::span<Form> forms) {
    std::size_t triangles = 0, quads = 0;
    for (Form& form : forms)
        if (const auto* mesh = std::get_if<Mesh>(&data.shapes[form.shape].geometry)) {
            form.quads = Quads(*mesh);
            triangles += mesh->triangles.size();
            quads += form.quads.size();
        }
    const bool pays = 4 * quads <= 3 * triangles;
    if (pays) return;
    for (Form& form : forms) form.quads = {};
}

RTCGeometryTy* new_geometry(RTCDeviceTy* device, Shape& shape, Form& form, std::span<ShapeGeometry> later) {
    RTCGeometry geometry = std::visit([&](auto& each) { return make(device, each, form); }, shape.geometry);
    rtcSetGeometryUserData(geometry, &form);
    if (!later.empty()) rtcSetGeometryTimeStepCount(geometry, unsigned(later.size() + 1));
    for (unsigned i = 0; i < later.size(); ++i)
        if (auto* mesh = std::get_if<Mesh>(&later[i])) share_vertices(geometry, i + 1, *mesh);
    return geometry;
}

}  // namespace lightnet
