#include "core/scene/geometry/nearest_surface.hpp"

#include "core/base/math/octahedral.hpp"
#include "core/base/query.hpp"
#include "core/scene/geometry/form.hpp"
#include "core/scene/surfaces/triangle.hpp"

#include <embree/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

namespace lightnet {
namespace {

/// In double: points of a large scene lie close to each other.
using Wide = std::array<double, 3>;

Wide wide_between(Vec3 from, Vec3 to) { return {double{to.x} - from.x, double{to.y} - from.y, double{to.z} - from.z}; }
double wide_dot(const Wide& a, const Wide& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Weights of the second and the third corner where the triangle is nearest. Ericson 2005, "Real-Time Collision
// Detection", section 5.1.5.
Vec2 nearest_on_triangle(const Corners& at, Vec3 p) {
    const Wide ab = wide_between(at.a, at.b), ac = wide_between(at.a, at.c);
    const Wide ap = wide_between(at.a, p), bp = wide_between(at.b, p), cp = wide_between(at.c, p);
    const double d1 = wide_dot(ab, ap), d2 = wide_dot(ac, ap), d3 = wide_dot(ab, bp), d4 = wide_dot(ac, bp);
    const double d5 = wide_dot(ab, cp), d6 = wide_dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return {0, 0};
    if (d3 >= 0 && d4 <= d3) return {1, 0};
    if (d6 >= 0 && d5 <= d6) return {0, 1};
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {float(d1 / (d1 - d3)), 0};
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, float(d2 / (d2 - d6))};
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const auto along = float((d4 - d3) / ((d4 - d3) + (d5 - d6)));
        return {1 - along, along};
    }
    const double sum = va + vb + vc;
    return {float(vb / sum), float(vc / sum)};
}

// A segment lies among its control points, and is as thick as they are at most.
bool may_reach(const Curves& curves, std::uint32_t segment, const Matrix& to_world, const SurfaceWish& wish) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) square += to_world.m[i][j] * to_world.m[i][j];
    const auto stretch = float(std::sqrt(square));
    Box box;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto [x, y, z, radius] = curves.points[curves.segments[segment] + i];
        const Vec3 at = transform_point(to_world, {x, y, z});
        const float far = radius * stretch + wish.reach;
        box.add(at - Vec3{far, far, far});
        box.add(at + Vec3{far, far, far});
    }
    const Vec3 p = wish.position;
    return p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x && p.y <= box.high.y &&
           p.z <= box.high.z;
}

/// Looks at one candidate after the other, in any order.
class NearestSurface {
public:
    NearestSurface(std::span<const Form> forms, const PlacedSurfaces& surfaces, const SurfaceWish& wish)
        : forms_(forms), surfaces_(surfaces), wish_(wish) {}

    void look_at(std::uint32_t instance, std::uint32_t geometry, std::uint32_t primitive) {
        const bool placed = instance != Query::no_instance;
        if (placed) {  // Embree numbers the shapes of an object for itself
            instance -= std::uint32_t(surfaces_.data.shapes.size());
            geometry = surfaces_.data.objects[surfaces_.data.instances[instance].object].shapes[geometry];
        }
        const Quads& quads = forms_[geometry].quads;
        if (quads.empty()) return look_at({instance, geometry, primitive, 0, 0, 0});
        quads.each_triangle(primitive, [&](std::uint32_t triangle) {
            look_at({instance, geometry, triangle, 0, 0, 0});
        });
    }

    /// Embree leaves curves out of what it offers.
    void look_at_curves() {
        const SceneData& data = surfaces_.data;
        std::vector<bool> in_object(data.shapes.size());
        for (const auto& object : data.objects)
            for (const auto shape : object.shapes) in_object[shape] = true;
        for (std::uint32_t s = 0; s < data.shapes.size(); ++s)
            if (!in_object[s]) look_at_segments(Query::no_instance, s);
        for (std::uint32_t i = 0; i < data.instances.size(); ++i)
            for (const auto shape : data.objects[data.instances[i].object].shapes) look_at_segments(i, shape);
    }

    const std::optional<Hit>& best() const { return best_; }

private:
    void look_at_segments(std::uint32_t instance, std::uint32_t geometry) {
        const Curves* curves = forms_[geometry].curves;
        if (!curves) return;
        const bool placed = instance != Query::no_instance;
        const Matrix to_world = placed ? surfaces_.data.instances[instance].to_world : Matrix{};
        for (std::uint32_t s = 0; s < curves->segments.size(); ++s) {
            if (may_reach(*curves, s, to_world, wish_)) look_at({instance, geometry, s, 0, 0, 0});
        }
    }
    void look_at(Hit hit) {
        const bool placed = hit.instance != Query::no_instance;
        const Placement* placement = placed ? &surfaces_.shading.placements()[hit.instance] : nullptr;
        std::visit([&](const auto& shape) { put_on(hit, shape, placement); }, surfaces_.shading.placed(hit.geometry));
        if (forms_[hit.geometry].is_there({hit.primitive, {hit.u, hit.v}})) compare(hit, point(hit, placement));
    }
    SurfacePoint point(const Hit& hit, const Placement* placement) const {
        const SurfacePoint own = surfaces_.shading.point(hit.geometry, hit.primitive, hit.u, hit.v);
        return placement ? placement->place(own) : own;
    }

    void put_on(Hit& hit, const Mesh* mesh, const Placement* placement) const {
        Corners at = corners(*mesh, hit.primitive);
        if (placement)
            for (Vec3* corner : {&at.a, &at.b, &at.c}) *corner = placement->point_to_world(*corner);
        const Vec2 weights = nearest_on_triangle(at, wish_.position);
        hit.u = weights.x, hit.v = weights.y;
    }

    // Of a stretched one, the direction from its centre is not that in which it is nearest: towards its tangent plane,
    // and again.
    void put_on(Hit& hit, const Sphere* sphere, const Placement* placement) const {
        Vec3 towards = wish_.position;
        for (int step = 0; step < (placement ? 3 : 1); ++step) {
            const Vec3 outwards = (placement ? placement->point_to_object(towards) : towards) - sphere->center;
            const float far = length(outwards);
            const Vec2 name = to_octahedral(far > 0 ? outwards / far : Vec3{0, 0, 1});
            hit.u = name.x, hit.v = name.y;
            const SurfacePoint at = point(hit, placement);
            towards = wish_.position - at.normal * dot(wish_.position - at.position, at.normal);
        }
    }

    // As for a stretched sphere: towards the tangent plane where it is near in its own space, and again.
    void put_on(Hit& hit, const PlacedQuadric& quadric, const Placement* placement) const {
        Vec3 towards = wish_.position;
        for (int step = 0; step < 4; ++step) {
            const Vec2 name = quadric.name_near(placement ? placement->point_to_object(towards) : towards);
            hit.u = name.x, hit.v = name.y;
            const SurfacePoint at = point(hit, placement);
            towards = wish_.position - at.normal * dot(wish_.position - at.position, at.normal);
        }
    }

    // Towards the nearest of some points of the middle line, and then of ever closer ones around it.
    void put_on(Hit& hit, const Curves* curves, const Placement* placement) const {
        const Vec3 from = placement ? placement->point_to_object(wish_.position) : wish_.position;
        float nearest = 0.5f, best2 = std::numeric_limits<float>::infinity();
        for (float step = 0.125f; step > 1e-6f; step /= 2) {
            const float middle = nearest;
            for (int i = -4; i <= 4; ++i) {
                const float at = std::clamp(middle + float(i) * step, 0.0f, 1.0f);
                const float way2 = length_squared(curves->at(hit.primitive, at).position - from);
                if (way2 < best2) best2 = way2, nearest = at;
            }
        }
        const OnCurve on = curves->at(hit.primitive, nearest);
        hit.u = nearest, hit.v = across(on, from - on.position);
    }

    void compare(const Hit& hit, const SurfacePoint& at) {
        const Wide way = wide_between(at.position, wish_.position);
        const double reach2 = double{wish_.reach} * wish_.reach, distance2 = wide_dot(way, way);
        if (!(distance2 <= reach2)) return;
        const double slope = dot(at.normal, wish_.normal);
        const double farther = wish_.normal == Vec3{} ? 0 : reach2 * std::max(0.0, 1 - slope * slope);
        const std::tuple rank{distance2 + farther, hit.instance, hit.geometry, hit.primitive};
        if (best_ && !(rank < rank_)) return;
        best_ = hit;
        rank_ = rank;
    }

    std::span<const Form> forms_;
    const PlacedSurfaces& surfaces_;
    const SurfaceWish& wish_;
    std::optional<Hit> best_;
    std::tuple<double, std::uint32_t, std::uint32_t, std::uint32_t> rank_;
};

bool look_at_candidate(RTCPointQueryFunctionArguments* args) {
    const auto& context = *args->context;
    const bool placed = context.instStackSize > 0;
    static_cast<NearestSurface*>(args->userPtr)
        ->look_at(placed ? context.instID[0] : Query::no_instance, args->geomID, args->primID);
    return false;  // the query stays as wide as it is, so that the order in which candidates come is nothing
}

}  // namespace

std::optional<Hit> nearest_surface(RTCSceneTy* tree, std::span<const Form> forms, const PlacedSurfaces& surfaces,
                                   const SurfaceWish& wish) {
    constexpr float beyond = 1.001f;  // who is within reach we decide; the tree only has to leave nobody out
    if (!finite(wish.position) || !(wish.reach >= 0)) return {};
    NearestSurface nearest(forms, surfaces, wish);
    RTCPointQuery query;
    query.x = wish.position.x, query.y = wish.position.y, query.z = wish.position.z;
    query.time = 0;
    query.radius = beyond * (wish.reach + 0x1p-20f * largest_coordinate(wish.position));
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(tree, &query, &context, look_at_candidate, &nearest);
    if (std::any_of(forms.begin(), forms.end(), [](const Form& form) { return form.curves != nullptr; }))
        nearest.look_at_curves();
    return nearest.best();
}

}  // namespace lightnet
