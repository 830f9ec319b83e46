#include "core/scene/lamps/area_lamps.hpp"

#include "core/base/math/box.hpp"
#include "core/base/math/frame.hpp"
#include "core/base/math/prefix_cdf.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/ball_lamp.hpp"
#include "core/scene/lamps/quadric_lamp.hpp"
#include "core/scene/surfaces/fetch_ahead.hpp"
#include "core/scene/surfaces/triangle.hpp"
#include "core/scene/textures/look_up.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace lightnet {
namespace {

constexpr std::uint32_t few_facets = 4;   // that are chosen by area alone where they lie in one plane
constexpr std::size_t most_known = 4096;  // more wouldn't stay in the cache

bool shines_towards(bool two_sided, Vec3 normal, Vec3 direction) { return two_sided || dot(normal, direction) > 0; }

inline Facet facet(const Corners& at, Vec3 normal) { return {at.a, at.b - at.a, at.c - at.a, normal}; }
inline Facet facet(const Mesh& mesh, std::uint32_t triangle) {
    const Corners at = corners(mesh, triangle);
    return facet(at, geometric_normal(mesh, triangle, at));
}
Facet facet(const MovingShape& moving, const Mesh& mesh, std::uint32_t triangle, ShutterTime time) {
    const Corners at = moving.corners(triangle, time), normals = moving.normals(triangle, time);
    return facet(at,
                 geometric_normal(at, normals.a + normals.b + normals.c, mesh.normals.empty() && mesh.flip_normals));
}
float area_of(const Facet& facet) { return area_of(Corners{{}, facet.first_edge, facet.second_edge}); }

bool is_lamp(const SceneData& data, const Shape& shape, GroupSet groups) {
    return shape.emission && (groups >> shape.emission->label.group & 1) && !is_black(shape.emission->radiance) &&
           !std::holds_alternative<NoMaterial>(data.materials[shape.material].model);
}

/// A point of a lamp that a ray has found, to be told how likely sample() is to find it.
struct Found {
    Vec3 from, direction;
    const SurfacePoint& on;
    float area;  // m², of the lamp
    bool two_sided;

    float way2() const { return length_squared(on.position - from); }
};
float density(const Mesh*, const Found& found) {
    const float cosine = std::max(1e-6f, std::fabs(dot(found.on.normal, found.direction)));
    return found.area > 0 ? found.way2() / (found.area * cosine) : 0;
}
float density(const Sphere* ball, const Found& found) {
    const SeenBall seen(ball->center, ball->radius, found.from);
    return seen.pdf(found.on.normal, found.direction, found.way2(), found.area);
}
float density(const PlacedQuadric& quadric, const Found& found) {
    const SeenQuadric seen(quadric, found.from, found.two_sided);
    return seen.pdf(found.direction, quadric.own_point({found.on.u, found.on.v}));
}

float density(const Curves* curves, const Found& found) {
    const OnCurve middle = curves->at(found.on.primitive, found.on.u);
    const float area = float(curves->pieces()) * surface_of(middle, found.on.v).stretch;
    const float cosine = std::max(1e-6f, std::fabs(dot(found.on.normal, found.direction)));
    return area > 0 ? found.way2() / (area * cosine) : 0;
}

}  // namespace

AreaLamps::AreaLamps(const SceneData& data, const Shading& shading, GroupSet groups, bool apart)
    : data_(data), shading_(shading), apart_(apart), sources_of_shapes_(data.shapes.size(), none) {
    for (std::uint32_t s = 0; s < data.shapes.size(); ++s) {
        const Shape& shape = data.shapes[s];
        if (!is_lamp(data, shape, groups)) continue;
        if (const MovingShape* moving = shading.moving(s)) {
            add(s, *moving);
            continue;
        }
        std::visit([&](const auto& placed) { add(s, placed); }, shading.placed(s));
    }
    for (std::size_t i = 0; size() <= most_known && i < size(); ++i) known_.push_back(even(i));
}

// Of a mesh that moves each triangle is a lamp, as they may not stay in one plane.
void AreaLamps::add(std::uint32_t shape, const MovingShape& moving) {
    const Box box = moving.bounds();
    balls_.add(box.center(), length(box.size()) / 2);
    const auto* mesh = std::get_if<Mesh>(&moving.at_step(0));
    add_source(shape, mesh ? std::uint32_t(mesh->triangles.size()) : 1, 0);
}

void AreaLamps::add(std::uint32_t shape, const Mesh* placed) {
    const Mesh& mesh = *placed;
    const auto count = std::uint32_t(mesh.triangles.size());
    bool flat = true;
    Box box;
    for (std::uint32_t t = 0; t < count; ++t) {
        const Corners at = corners(mesh, t);
        flat = flat && count <= few_facets &&
               dot(geometric_normal(mesh, t, at), geometric_normal(mesh, 0, corners(mesh, 0))) > 0.9999f;
        for (const Vec3 p : {at.a, at.b, at.c}) box.add(p);
    }
    const Vec3 center = count ? box.center() : Vec3{};
    float radius2 = 0;
    for (std::uint32_t t = 0; t < count; ++t) {
        const Corners at = corners(mesh, t);
        for (const Vec3 p : {at.a, at.b, at.c}) radius2 = std::max(radius2, length_squared(p - center));
    }
    balls_.add(center, std::sqrt(radius2));
    if (!flat) return add_source(shape, count, 0);

    std::vector<double> areas;
    const std::size_t first = facets_.size();
    for (std::uint32_t t = 0; t < count; ++t) {
        facets_.push_back(facet(mesh, t));
        areas.push_back(double{area_of(facets_.back())});
    }
    ends_.resize(facets_.size(), 1);
    prefix_cdf(std::span<const double>(areas), std::span(ends_).subspan(first));
    if (count > 0) add_source(shape, 1, count);
}

// The last of the facets are its own.
void AreaLamps::add_source(std::uint32_t shape, std::uint32_t lamps, std::uint32_t facets) {
    const AreaEmission& emission = *data_.shapes[shape].emission;
    Source source;
    source.shape = shape;
    source.first_lamp = std::uint32_t(source_of_.size());
    source.by_triangle = facets == 0 && std::holds_alternative<const Mesh*>(shading_.placed(shape));
    source.first = std::uint32_t(facets_.size()) - facets;
    source.facets = facets;
    source.radiance = emission.radiance;
    source.two_sided = emission.two_sided;
    source.group = group_of(shape);
    source.unseen = emission.unseen;
    source.uniform = !emission.texture && !shading_.has_holes(shape) && !emission.unseen;
    source.area = on_shape(source, 0, [&](const auto& placed) { return area(source, placed); });
    if (!std::isfinite(source.area)) source.area = 0;  // never chosen
    if (source.uniform && facets == 2)
        if (const auto whole = parallelogram(facets_[source.first], facets_[source.first + 1])) {
            source.whole = std::uint32_t(wholes_.size());
            wholes_.push_back(*whole);
        }
    sources_of_shapes_[shape] = std::uint32_t(sources_.size());
    source_of_.resize(source_of_.size() + lamps, std::uint32_t(sources_.size()));
    sources_.push_back(source);
}

float AreaLamps::area(const Source& source, const Mesh*) const {
    float area = 0;
    for (std::uint32_t f = source.first; f < facets_.size(); ++f) area += area_of(facets_[f]);
    return area;
}

AreaLamps::Lamp AreaLamps::lamp(std::size_t index, ShutterTime time) const {
    const Source& source = sources_[source_of_[index]];
    const MovingShape* moving = shading_.moving(source.shape);
    if (!source.by_triangle) {
        if (!moving || !std::holds_alternative<Sphere>(moving->at_step(0))) return {source, 0, source.area, time};
        const Sphere ball = moving->sphere(part_of_shutter(time));
        return {source, 0, area(source, &ball), time};
    }
    const auto triangle = std::uint32_t(index - source.first_lamp);
    const Corners at = moving ? moving->corners(triangle, time) : corners(mesh_of(source), triangle);
    const float area = area_of(at);
    return {source, triangle, std::isfinite(area) ? area : 0, time};
}

template <class With>
void AreaLamps::at_each_step(std::size_t index, const With& with) const {
    const MovingShape* moving = shading_.moving(sources_[source_of_[index]].shape);
    const std::size_t steps = moving ? moving->steps() : 1;
    for (std::size_t step = 0; step < steps; ++step)
        with(lamp(index, steps > 1 ? ShutterTime(step * shutter_closes / (steps - 1)) : ShutterTime(0)));
}

// Of two triangles that are its halves.
std::optional<Facet> AreaLamps::parallelogram(const Facet& first, const Facet& second) {
    const auto corners_of = [](const Facet& f) {
        return std::array{f.corner, f.corner + f.first_edge, f.corner + f.second_edge};
    };
    const auto a = corners_of(first), b = corners_of(second);
    const float tolerance = 1e-5f * (length(first.first_edge) + length(first.second_edge));
    const auto near = [&](Vec3 p, Vec3 q) { return length(p - q) <= tolerance; };
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 p = a[(i + 1) % 3], q = a[(i + 2) % 3], r = b[(j + 1) % 3], s = b[(j + 2) % 3];
            const bool share_a_side = (near(p, r) && near(q, s)) || (near(p, s) && near(q, r));
            if (share_a_side && near(a[i] + b[j], p + q)) return Facet{a[i], p - a[i], q - a[i], first.normal};
        }
    return {};
}

// Of 16 points. Never nothing: what lies between them may shine.
Rgb AreaLamps::mean_of_texture(const Lamp& lamp) const {
    const std::uint32_t shape = lamp.source.shape;
    if (!data_.shapes[shape].emission->texture || !(lamp.area > 0)) return {1, 1, 1};
    Rgb sum{0.16f, 0.16f, 0.16f};
    for (int i = 0; i < 16; ++i) {
        const Vec2 u{(float(i % 4) + 0.5f) / 4, (float(i / 4) + 0.5f) / 4};
        const PointOnLamp point = on_shape(lamp, [&](const auto& placed) { return start(lamp, placed, u).point; });
        sum += texture_at(shape, point.primitive, point.u, point.v);
    }
    return sum / 16.16f;
}

std::optional<std::size_t> AreaLamps::lamp_at(const SurfacePoint& point) const {
    if (point.geometry >= sources_of_shapes_.size() || sources_of_shapes_[point.geometry] == none) return {};
    const Source& source = sources_[sources_of_shapes_[point.geometry]];
    return source.first_lamp + (source.by_triangle ? point.primitive : 0);
}

Rgb AreaLamps::texture_at(std::uint32_t shape, std::uint32_t primitive, float u, float v) const {
    return look_up(data_.textures, *data_.shapes[shape].emission->texture, shading_.place(shape, primitive, u, v));
}

Rgb AreaLamps::radiance(const SurfacePoint& point, Vec3 direction) const {
    if (sources_of_shapes_[point.geometry] == none) return {};
    const AreaEmission& emission = *data_.shapes[point.geometry].emission;
    if (!shines_towards(emission.two_sided, point.normal, direction)) return {};
    if (!emission.texture) return emission.radiance;
    return emission.radiance * texture_at(point.geometry, point.primitive, point.u, point.v);
}

Rgb AreaLamps::radiance_at(const Source& source, const PointOnLamp& point) const {
    if (!data_.shapes[source.shape].emission->texture) return source.radiance;
    return source.radiance * texture_at(source.shape, point.primitive, point.u, point.v);
}

// `primitive`: which of the mesh's triangles it is.
Facet AreaLamps::facet_of(const Lamp& lamp, std::uint32_t& primitive, float& u) const {
    const Source& source = lamp.source;
    primitive = lamp.triangle;
    if (const MovingShape* moving = source.by_triangle ? shading_.moving(source.shape) : nullptr)
        return facet(*moving, mesh_of(source), primitive, lamp.time);
    if (source.by_triangle) return facet(mesh_of(source), primitive);
    if (source.facets > 1) primitive = std::uint32_t(pick(std::span(ends_).subspan(source.first, source.facets), u));
    return facets_[source.first + primitive];
}

AreaLamps::Start AreaLamps::start(const Lamp& lamp, const Mesh*, Vec2 u) const {
    std::uint32_t primitive = 0;
    const Facet facet = facet_of(lamp, primitive, u.x);
    const Vec2 at = triangle(u);
    return {{facet.at(at), facet.normal, primitive, at.x, at.y}, lamp.area};
}

std::optional<LightSample> AreaLamps::sample(std::size_t index, const LitPoint& from, Vec2 u) const {
    const Lamp one = lamp(index, from.time);
    return on_shape(one, [&](const auto& placed) { return sample(one, placed, from.position, u); });
}

void AreaLamps::expect(std::span<const LightChoice> chosen) const {
    const auto each = [&](const auto& fetch) {
        for (const auto& [lamp, chance] : chosen)
            if (chance > 0 && lamp < size()) fetch(lamp);
    };
    const auto each_triangle = [&](const auto& fetch) {
        each([&](std::uint32_t lamp) {
            const Source& source = sources_[source_of_[lamp]];
            if (source.by_triangle) fetch(mesh_of(source), lamp - source.first_lamp);
        });
    };
    each([&](std::uint32_t lamp) { __builtin_prefetch(&source_of_[lamp]); });
    each_triangle([](const Mesh& mesh, std::uint32_t triangle) { fetch_triangle(mesh, triangle); });
    each_triangle([](const Mesh& mesh, std::uint32_t triangle) { fetch_corners(mesh, triangle); });
}

std::optional<LightSample> AreaLamps::sample(const Lamp& lamp, const Mesh*, Vec3 from, Vec2 u) const {
    const Source& source = lamp.source;
    const bool whole = source.whole != none;
    std::uint32_t primitive = 0;
    const Facet on = whole ? wholes_[source.whole] : facet_of(lamp, primitive, u.x);
    const Vec2 at = Facet::uniform(u, whole);
    const Vec3 position = on.at(at);
    const auto [direction, pdf, found] = direction_to_lamp(from, position, on.normal, lamp.area, source.two_sided);
    if (!found) return {};
    Rgb radiance = source.radiance;
    if (!source.uniform) {
        const PointOnLamp point{position, on.normal, primitive, at.x, at.y};
        if (!is_there(source, point)) return {};
        radiance = radiance_at(source, point);
    }
    return LightSample{
        before_lamp(on, position, direction), direction, radiance, pdf, source.unseen, false, source.group};
}

AreaLamps::EvenLamp AreaLamps::even(const Lamp& one, const Mesh*) const {
    const Source& source = one.source;
    const bool whole = source.whole != none;
    if (!source.uniform || (!whole && source.facets > 1)) return {};
    std::uint32_t primitive = 0;
    float u = 0;
    const Facet facet = whole ? wholes_[source.whole] : facet_of(one, primitive, u);
    return FlatLamp{facet, whole, one.area, source.radiance, source.two_sided, source.group};
}

AreaLamps::EvenLamp AreaLamps::even(std::size_t index) const {
    const Lamp one = lamp(index, 0);
    if (shading_.moving(one.source.shape)) return {};
    return on_shape(one, [&](const auto& placed) { return even(one, placed); });
}

float AreaLamps::pdf(std::size_t index, Vec3 from, Vec3 direction, const SurfacePoint& on) const {
    const Lamp one = lamp(index, on.time);
    const Found found{from, direction, on, one.area, one.source.two_sided};
    return on_shape(one, [&](const auto& placed) { return density(placed, found); });
}

LightBounds AreaLamps::bounds(std::size_t index) const {
    std::optional<LightBounds> all;
    at_each_step(index, [&](const Lamp& one) {
        const float radiance = luminance(one.source.radiance * mean_of_texture(one));
        const LightBounds step = on_shape(one, [&](const auto& placed) { return bounds(one, placed, radiance); });
        all = all ? around_both(*all, step) : step;
    });
    return *all;
}

LightBounds AreaLamps::bounds(const Lamp& one, const Mesh*, float radiance) const {
    const Source& source = one.source;
    Box box;
    const auto add = [&](const Facet& f) {
        for (const Vec3 p : {f.corner, f.corner + f.first_edge, f.corner + f.second_edge}) box.add(p);
    };
    std::uint32_t primitive = 0;
    float u = 0;
    const Facet first = facet_of(one, primitive, u);
    add(first);
    for (std::uint32_t f = 0; f < source.facets; ++f) add(facets_[source.first + f]);
    return {box.low, box.high, first.normal, 1, 0, radiance * one.area, source.two_sided};
}

Rgb AreaLamps::power(std::size_t index) const {
    Rgb most;
    at_each_step(index, [&](const Lamp& one) {
        const Rgb step = one.source.radiance * mean_of_texture(one) * (pi * one.area * (one.source.two_sided ? 2 : 1));
        if (!(luminance(step) < luminance(most))) most = step;
    });
    return most;
}

std::optional<Emission> AreaLamps::emit(std::size_t index, Vec2 position_sample, Vec2 direction_sample,
                                        ShutterTime time) const {
    const Lamp one = lamp(index, time);
    const Source& source = one.source;
    if (!(one.area > 0)) return {};
    float sides = 1;
    auto [start, area] = on_shape(one, [&](const auto& placed) { return this->start(one, placed, position_sample); });
    if (source.two_sided) {
        sides = 2;
        const bool back = direction_sample.x >= 0.5f;
        direction_sample.x = std::min(2 * (direction_sample.x - (back ? 0.5f : 0)), 0x1.fffffep-1f);
        if (back) start.normal = -start.normal;
    }
    if (!is_there(source, start)) return {};
    const SurfacePoint point = shading_.point(source.shape, start.primitive, start.u, start.v, time);
    const Vec3 direction = Frame::around(start.normal).to_world(cosine_hemisphere(direction_sample));
    return Emission{point.origin_towards(direction), direction, radiance_at(source, start) * (pi * area * sides),
                    source.group};
}

// Where a mask has holes a lamp does not shine, unless there is nothing of it to be seen.
bool AreaLamps::is_there(const Source& source, const PointOnLamp& point) const {
    return source.unseen || !shading_.has_holes(source.shape) ||
           shading_.is_there(source.shape, point.primitive, point.u, point.v);
}

std::size_t AreaLamps::memory() const {
    return sources_.size() * sizeof(Source) + source_of_.size() * sizeof(std::uint32_t) +
           facets_.size() * sizeof(Facet) + ends_.size() * sizeof(float) + wholes_.size() * sizeof(Facet) +
           known_.size() * sizeof(EvenLamp) + sources_of_shapes_.size() * sizeof(std::uint32_t);
}

}  // namespace lightnet
