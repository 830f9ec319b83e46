#include "core/scene/lamps/area_lamps.hpp"

#include "core/base/math/box.hpp"
#include "core/base/math/frame.hpp"
#include "core/base/math/octahedral.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/shares.hpp"
#include "core/scene/surfaces/triangle.hpp"
#include "core/scene/textures/look_up.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace lightnet {
namespace {

constexpr std::uint32_t few_facets = 4;  // that are chosen by area alone where they lie in one plane

// 1 - cos of the cone that a sphere fills, seen from a distance; without cancellation for small ones.
float one_minus_cosine(float radius, float distance2) {
    const float sine2 = radius * radius / distance2;
    return sine2 / (1 + std::sqrt(std::max(0.0f, 1 - sine2)));
}

bool inside(const Sphere& sphere, float distance2) { return distance2 <= sphere.radius * sphere.radius * 1.00001f; }

bool shines_towards(bool two_sided, Vec3 normal, Vec3 direction) { return two_sided || dot(normal, direction) > 0; }

bool shines(const SceneData& data, const Shape& shape, GroupSet groups) {
    return shape.emission && (groups >> shape.emission->label.group & 1) && !is_black(shape.emission->radiance) &&
           !std::holds_alternative<NoMaterial>(data.materials[shape.material].model);
}

}  // namespace

AreaLamps::AreaLamps(const SceneData& data, const Shading& shading, GroupSet groups, bool apart)
    : data_(data), shading_(shading), apart_(apart), places_(data.shapes.size()) {
    for (std::uint32_t s = 0; s < data.shapes.size(); ++s) {
        const Shape& shape = data.shapes[s];
        if (!shines(data, shape, groups)) continue;
        places_[s].lamp = std::uint32_t(lamps_.size());
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            add_mesh(s, *mesh);
        } else {
            const auto& ball = std::get<Sphere>(shape.geometry);
            balls_.push_back({ball.center, ball.radius});
            add_lamp(s, 0, 0);
        }
        balls_.back().radius *= 1.001f;  // roundings
    }
}

void AreaLamps::add_mesh(std::uint32_t shape, const Mesh& mesh) {
    const auto first = std::uint32_t(facets_.size()), count = std::uint32_t(mesh.triangles.size());
    std::vector<double> areas(count);
    bool flat = true;
    Box box;
    for (std::uint32_t t = 0; t < count; ++t) {
        const Corners at = corners(mesh, t);
        facets_.push_back({at.a, at.b - at.a, at.c - at.a, geometric_normal(mesh, t, at)});
        areas[t] = 0.5 * length(cross(at.b - at.a, at.c - at.a));
        flat &= dot(facets_.back().normal, facets_[first].normal) > 0.9999f;
        for (const Vec3 p : {at.a, at.b, at.c}) box.add(p);
    }
    const Vec3 center = count ? box.center() : Vec3{};
    float radius2 = 0;
    for (std::uint32_t t = 0; t < count; ++t) {
        const Corners at = corners(mesh, t);
        for (const Vec3 p : {at.a, at.b, at.c}) radius2 = std::max(radius2, length_squared(p - center));
    }
    balls_.push_back({center, std::sqrt(radius2)});

    ends_.resize(facets_.size(), 1);
    places_[shape].facet = first;
    places_[shape].by_triangle = !flat || count > few_facets;
    if (places_[shape].by_triangle) {
        for (std::uint32_t t = 0; t < count; ++t) add_lamp(shape, first + t, 1);
    } else if (count > 0) {
        running_shares(std::span<const double>(areas), std::span(ends_).subspan(first));
        add_lamp(shape, first, count);
    }
}

void AreaLamps::add_lamp(std::uint32_t shape, std::uint32_t first, std::uint32_t facets) {
    const AreaEmission& emission = *data_.shapes[shape].emission;
    Lamp lamp;
    lamp.shape = shape;
    lamp.first = first;
    lamp.facets = facets;
    lamp.radiance = emission.radiance;
    lamp.two_sided = emission.two_sided;
    lamp.group = group_of(shape);
    lamp.uniform = !emission.texture && !shading_.has_holes(shape);
    for (std::uint32_t f = first; f < first + facets; ++f)
        lamp.area += 0.5f * length(cross(facets_[f].first_edge, facets_[f].second_edge));
    if (const auto* ball = std::get_if<Sphere>(&data_.shapes[shape].geometry))
        lamp.area = 4 * pi * ball->radius * ball->radius;
    if (!std::isfinite(lamp.area)) lamp.area = 0;  // never chosen
    if (lamp.uniform && facets == 2)
        if (const auto whole = parallelogram(facets_[first], facets_[first + 1])) {
            lamp.whole = std::uint32_t(wholes_.size());
            wholes_.push_back(*whole);
        }
    lamp.mean = mean_of_texture(lamp);
    lamps_.push_back(lamp);
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
    if (!data_.shapes[lamp.shape].emission->texture || !(lamp.area > 0)) return {1, 1, 1};
    Rgb sum{0.16f, 0.16f, 0.16f};
    for (int i = 0; i < 16; ++i) {
        const Vec2 u{(float(i % 4) + 0.5f) / 4, (float(i / 4) + 0.5f) / 4};
        PointOnLamp point;
        if (lamp.facets) {
            point = on_mesh(lamp, u);
        } else {
            const Vec2 name = to_octahedral(sphere(u));
            point.u = name.x;
            point.v = name.y;
        }
        sum += texture_at(lamp.shape, point.primitive, point.u, point.v);
    }
    return sum / 16.16f;
}

std::optional<std::size_t> AreaLamps::lamp_at(const SurfacePoint& point) const {
    if (point.geometry >= places_.size() || places_[point.geometry].lamp == none) return {};
    const LampsOfShape& place = places_[point.geometry];
    return place.lamp + (place.by_triangle ? point.primitive : 0);
}

Rgb AreaLamps::texture_at(std::uint32_t shape, std::uint32_t primitive, float u, float v) const {
    return look_up(data_.textures, *data_.shapes[shape].emission->texture, shading_.place(shape, primitive, u, v));
}

Rgb AreaLamps::radiance(const SurfacePoint& point, Vec3 direction) const {
    if (places_[point.geometry].lamp == none) return {};
    const AreaEmission& emission = *data_.shapes[point.geometry].emission;
    if (!shines_towards(emission.two_sided, point.normal, direction)) return {};
    if (!emission.texture) return emission.radiance;
    return emission.radiance * texture_at(point.geometry, point.primitive, point.u, point.v);
}

Rgb AreaLamps::radiance_at(const Lamp& lamp, const PointOnLamp& point) const {
    if (!data_.shapes[lamp.shape].emission->texture) return lamp.radiance;
    return lamp.radiance * texture_at(lamp.shape, point.primitive, point.u, point.v);
}

std::uint32_t AreaLamps::facet_of(const Lamp& lamp, float& u) const {
    if (lamp.facets == 1) return lamp.first;
    return lamp.first + std::uint32_t(pick(std::span(ends_).subspan(lamp.first, lamp.facets), u));
}

AreaLamps::PointOnLamp AreaLamps::on_mesh(const Lamp& lamp, Vec2 u) const {
    const std::uint32_t facet = facet_of(lamp, u.x);
    const Vec2 at = triangle(u);
    return {facets_[facet].at(at), facets_[facet].normal, facet - places_[lamp.shape].facet, at.x, at.y};
}

AreaLamps::PointOnLamp AreaLamps::on_sphere(const Sphere& ball, Vec3 outwards) const {
    const Vec2 name = to_octahedral(outwards);
    return {ball.center + outwards * ball.radius, ball.flip_normals ? -outwards : outwards, 0, name.x, name.y};
}

std::optional<LightSample> AreaLamps::sample(std::size_t lamp, Vec3 from, Vec2 u) const {
    return lamps_[lamp].facets ? from_mesh(lamps_[lamp], from, u) : from_sphere(lamps_[lamp], from, u);
}

std::optional<LightSample> AreaLamps::from_mesh(const Lamp& lamp, Vec3 from, Vec2 u) const {
    const bool whole = lamp.whole != none;
    const std::uint32_t facet = whole ? 0 : facet_of(lamp, u.x);
    const Facet& on = whole ? wholes_[lamp.whole] : facets_[facet];
    const Vec2 at = Facet::uniform(u, whole);
    const Vec3 position = on.at(at);
    const auto [direction, pdf, found] = direction_to_lamp(from, position, on.normal, lamp.area, lamp.two_sided);
    if (!found) return {};
    Rgb radiance = lamp.radiance;
    if (!lamp.uniform) {
        const PointOnLamp point{position, on.normal, facet - places_[lamp.shape].facet, at.x, at.y};
        if (!is_there(lamp, point)) return {};
        radiance = radiance_at(lamp, point);
    }
    return LightSample{position, direction, radiance, pdf, false, false, lamp.group};
}

std::optional<FlatLamp> AreaLamps::flat(std::size_t index) const {
    const Lamp& lamp = lamps_[index];
    const bool whole = lamp.whole != none;
    if (!lamp.uniform || (!whole && lamp.facets != 1)) return {};
    const Facet& facet = whole ? wholes_[lamp.whole] : facets_[lamp.first];
    return FlatLamp{facet, whole, lamp.area, lamp.radiance, lamp.two_sided, lamp.group};
}

std::optional<LightSample> AreaLamps::from_sphere(const Lamp& lamp, Vec3 from, Vec2 u) const {
    const auto& ball = std::get<Sphere>(data_.shapes[lamp.shape].geometry);
    const Vec3 to_center = ball.center - from;
    const float distance2 = length_squared(to_center);
    Vec3 outwards;
    float pdf = 0;
    if (inside(ball, distance2)) {
        outwards = sphere(u);
    } else {
        const float drop = one_minus_cosine(ball.radius, distance2);
        const Vec3 axis = to_center / std::sqrt(distance2);
        const Vec3 ray = Frame::around(axis).to_world(cone(u, drop));
        // Where the ray meets the sphere; at its rim where rounding lets it pass by.
        const float along = dot(to_center, ray);
        const Vec3 aside = ray * along - to_center;
        const float rest = std::max(0.0f, ball.radius * ball.radius - length_squared(aside));
        outwards = normalize(aside - ray * std::sqrt(rest));
        pdf = 1 / (2 * pi * drop);
    }
    const PointOnLamp point = on_sphere(ball, outwards);
    const Vec3 way = point.position - from;
    const float way2 = length_squared(way);
    if (!(way2 > 0)) return {};
    const Vec3 direction = way / std::sqrt(way2);
    if (pdf == 0) pdf = way2 / (lamp.area * std::max(1e-6f, std::fabs(dot(outwards, direction))));
    if (!shines_towards(lamp.two_sided, point.normal, -direction) || !is_there(lamp, point)) return {};
    return LightSample{point.position, direction, radiance_at(lamp, point), pdf, false, false, lamp.group};
}

float AreaLamps::pdf(std::size_t index, Vec3 from, Vec3 direction, const SurfacePoint& on) const {
    const Lamp& lamp = lamps_[index];
    if (const auto* ball = std::get_if<Sphere>(&data_.shapes[lamp.shape].geometry)) {
        const float distance2 = length_squared(ball->center - from);
        if (!inside(*ball, distance2)) return 1 / (2 * pi * one_minus_cosine(ball->radius, distance2));
    }
    const float cosine = std::max(1e-6f, std::fabs(dot(on.normal, direction)));
    return lamp.area > 0 ? length_squared(on.position - from) / (lamp.area * cosine) : 0;
}

bool AreaLamps::may_meet(const Ray& ray) const {
    constexpr std::size_t few = 32;  // looking at more costs as much as the ray
    if (balls_.size() > few) return true;
    return std::any_of(balls_.begin(), balls_.end(), [&](const Ball& ball) {
        const Vec3 to_center = ball.center - ray.origin;
        const float along = dot(to_center, ray.direction), distance2 = length_squared(to_center);
        const float radius2 = ball.radius * ball.radius;
        return distance2 <= radius2 || (along > 0 && distance2 - along * along <= radius2 + distance2 * 1e-5f);
    });
}

LightBounds AreaLamps::bounds(std::size_t index) const {
    const Lamp& lamp = lamps_[index];
    const float radiance = luminance(lamp.radiance * lamp.mean);
    if (const auto* ball = std::get_if<Sphere>(&data_.shapes[lamp.shape].geometry)) {
        const Vec3 r{ball->radius, ball->radius, ball->radius};
        return {ball->center - r, ball->center + r, {0, 0, 1}, -1, 0, radiance * lamp.area / 4, false};
    }
    Box box;
    for (const Facet& f : std::span(facets_).subspan(lamp.first, lamp.facets))
        for (const Vec3 p : {f.corner, f.corner + f.first_edge, f.corner + f.second_edge}) box.add(p);
    return {box.low, box.high, facets_[lamp.first].normal, 1, 0, radiance * lamp.area, lamp.two_sided};
}

Rgb AreaLamps::power(std::size_t index) const {
    const Lamp& lamp = lamps_[index];
    return lamp.radiance * lamp.mean * (pi * lamp.area * (lamp.two_sided ? 2 : 1));
}

std::optional<Emission> AreaLamps::emit(std::size_t index, Vec2 position_sample, Vec2 direction_sample) const {
    const Lamp& lamp = lamps_[index];
    if (!(lamp.area > 0)) return {};
    float sides = 1;
    PointOnLamp start = lamp.facets
                            ? on_mesh(lamp, position_sample)
                            : on_sphere(std::get<Sphere>(data_.shapes[lamp.shape].geometry), sphere(position_sample));
    if (lamp.two_sided) {
        sides = 2;
        const bool back = direction_sample.x >= 0.5f;
        direction_sample.x = std::min(2 * (direction_sample.x - (back ? 0.5f : 0)), 0x1.fffffep-1f);
        if (back) start.normal = -start.normal;
    }
    if (!is_there(lamp, start)) return {};
    const SurfacePoint point = shading_.point(lamp.shape, start.primitive, start.u, start.v);
    const Vec3 direction = Frame::around(start.normal).to_world(cosine_hemisphere(direction_sample));
    return Emission{point.origin_towards(direction), direction, radiance_at(lamp, start) * (pi * lamp.area * sides),
                    lamp.group};
}

// Where a mask has holes a lamp does not shine.
bool AreaLamps::is_there(const Lamp& lamp, const PointOnLamp& point) const {
    return !shading_.has_holes(lamp.shape) || shading_.is_there(lamp.shape, point.primitive, point.u, point.v);
}

std::size_t AreaLamps::memory() const {
    return lamps_.size() * sizeof(Lamp) + facets_.size() * sizeof(Facet) + ends_.size() * sizeof(float) +
           wholes_.size() * sizeof(Facet) + balls_.size() * sizeof(Ball) + places_.size() * sizeof(LampsOfShape);
}

}  // namespace lightnet
