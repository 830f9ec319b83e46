#include "core/scene/lights.hpp"

#include "core/math/frame.hpp"
#include "core/math/sampling.hpp"
#include "core/scene/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace lightnet {
namespace {

// A ball around all triangles: the middle of their box, and the farthest corner.
std::pair<Vec3, float> ball_around(const Mesh& mesh) {
    constexpr float far = std::numeric_limits<float>::infinity();
    Vec3 low{far, far, far}, high{-far, -far, -far};
    const auto each_corner = [&](const auto& visit) {
        for (const auto& triangle : mesh.triangles)
            for (const auto vertex : triangle) visit(mesh.positions[vertex]);
    };
    each_corner([&](Vec3 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    });
    const Vec3 center = (low + high) * 0.5f;
    float radius2 = 0;
    each_corner([&](Vec3 p) { radius2 = std::max(radius2, length_squared(p - center)); });
    return {center, std::sqrt(radius2)};
}

// Sums 0 … 1 of `parts`, and their total.
double running_shares(const std::vector<double>& parts, std::vector<float>& ends) {
    double total = 0, sum = 0;
    for (const double part : parts) total += part;
    for (const double part : parts) ends.push_back(float((sum += part) / total));
    if (!ends.empty()) ends.back() = 1;
    return total;
}

// Which part `u` falls into; `u` becomes the place within it, so that good numbers stay good.
std::size_t pick(const std::vector<float>& ends, float& u) {
    const auto at = std::upper_bound(ends.begin(), ends.end() - 1, u);
    const float start = at == ends.begin() ? 0 : *(at - 1);
    u = std::clamp((u - start) / (*at - start), 0.0f, 0x1.fffffep-1f);
    return std::size_t(at - ends.begin());
}

bool shines_towards(const AreaEmission& emission, Vec3 normal, Vec3 direction) {
    return emission.two_sided || dot(normal, direction) > 0;
}

// 1 - cos of the cone that a sphere fills, seen from a distance; without cancellation for small ones.
float one_minus_cosine(float radius, float distance2) {
    const float sine2 = radius * radius / distance2;
    return sine2 / (1 + std::sqrt(std::max(0.0f, 1 - sine2)));
}

bool inside(const Sphere& sphere, float distance2) { return distance2 <= sphere.radius * sphere.radius * 1.00001f; }

}  // namespace

Lights::Lights(const std::vector<Shape>& shapes) : lamp_of_(shapes.size(), no_lamp) {
    std::vector<double> powers;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        const Shape& shape = shapes[s];
        if (!shape.emission || is_black(shape.emission->radiance)) continue;
        Lamp lamp;
        lamp.shape = &shape;
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            std::vector<double> areas;
            for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
                const Corners at = corners(*mesh, t);
                lamp.facets.push_back({at.a, at.b - at.a, at.c - at.a, geometric_normal(*mesh, t, at)});
                areas.push_back(0.5 * length(cross(at.b - at.a, at.c - at.a)));
            }
            lamp.area = float(running_shares(areas, lamp.ends));
            std::tie(lamp.center, lamp.radius) = ball_around(*mesh);
        } else {
            const auto& ball = std::get<Sphere>(shape.geometry);
            lamp.center = ball.center;
            lamp.radius = ball.radius;
            lamp.area = 4 * pi * ball.radius * ball.radius;
        }
        lamp.radius *= 1.001f;  // roundings
        if (!(lamp.area > 0)) continue;
        lamp_of_[s] = std::uint32_t(lamps_.size());
        powers.push_back(double{lamp.area} * luminance(shape.emission->radiance) * (shape.emission->two_sided ? 2 : 1));
        lamps_.push_back(std::move(lamp));
    }
    const double total = running_shares(powers, ends_);
    for (std::size_t i = 0; i < lamps_.size(); ++i) lamps_[i].chance = float(powers[i] / total);
}

std::optional<LightSample> Lights::sample(Vec3 from, float choice, Vec2 u) const {
    if (lamps_.empty()) return {};
    const Lamp& lamp = lamps_[many() ? pick(ends_, choice) : 0];
    return std::holds_alternative<Mesh>(lamp.shape->geometry) ? on_mesh(lamp, from, u) : on_sphere(lamp, from, u);
}

std::optional<LightSample> Lights::on_mesh(const Lamp& lamp, Vec3 from, Vec2 u) const {
    const auto& [corner, first_edge, second_edge, normal] = lamp.facets[pick(lamp.ends, u.x)];
    const Vec2 at = triangle(u);
    const Vec3 position = corner + first_edge * at.x + second_edge * at.y;
    const Vec3 way = position - from;
    const float distance2 = length_squared(way);
    const Vec3 direction = way / std::sqrt(distance2);
    const float cosine = std::fabs(dot(normal, direction));
    if (!(distance2 > 0) || cosine < 1e-7f || !shines_towards(*lamp.shape->emission, normal, -direction)) return {};
    return LightSample{position, direction, lamp.shape->emission->radiance,
                       lamp.chance / lamp.area * distance2 / cosine};
}

std::optional<LightSample> Lights::on_sphere(const Lamp& lamp, Vec3 from, Vec2 u) const {
    const auto& ball = std::get<Sphere>(lamp.shape->geometry);
    const Vec3 to_center = ball.center - from;
    const float distance2 = length_squared(to_center);
    Vec3 normal;  // outwards, at the sampled point
    float pdf = 0;
    if (inside(ball, distance2)) {
        normal = sphere(u);
    } else {
        const float drop = one_minus_cosine(ball.radius, distance2);
        const Vec3 axis = to_center / std::sqrt(distance2);
        const Vec3 ray = Frame::around(axis).to_world(cone(u, drop));
        // Where the ray meets the sphere; at its rim where rounding lets it pass by.
        const float along = dot(to_center, ray);
        const Vec3 aside = ray * along - to_center;
        const float rest = std::max(0.0f, ball.radius * ball.radius - length_squared(aside));
        normal = normalize(aside - ray * std::sqrt(rest));
        pdf = 1 / (2 * pi * drop);
    }
    const Vec3 position = ball.center + normal * ball.radius;
    const Vec3 way = position - from;
    const float way2 = length_squared(way);
    if (!(way2 > 0)) return {};
    const Vec3 direction = way / std::sqrt(way2);
    if (pdf == 0) pdf = way2 / (lamp.area * std::max(1e-6f, std::fabs(dot(normal, direction))));
    if (!shines_towards(*lamp.shape->emission, ball.flip_normals ? -normal : normal, -direction)) return {};
    return LightSample{position, direction, lamp.shape->emission->radiance, lamp.chance * pdf};
}

bool Lights::may_meet(const Ray& ray) const {
    constexpr std::size_t few = 32;  // looking at more costs as much as the ray
    if (lamps_.size() > few) return true;
    return std::any_of(lamps_.begin(), lamps_.end(), [&](const Lamp& lamp) {
        const Vec3 to_center = lamp.center - ray.origin;
        const float along = dot(to_center, ray.direction), distance2 = length_squared(to_center);
        const float radius2 = lamp.radius * lamp.radius;
        return distance2 <= radius2 || (along > 0 && distance2 - along * along <= radius2 + distance2 * 1e-5f);
    });
}

float Lights::pdf(Vec3 from, Vec3 direction, const SurfacePoint& on) const {
    const std::uint32_t index = on.geometry < lamp_of_.size() ? lamp_of_[on.geometry] : no_lamp;
    if (index == no_lamp) return 0;
    const Lamp& lamp = lamps_[index];
    if (const auto* ball = std::get_if<Sphere>(&lamp.shape->geometry)) {
        const float distance2 = length_squared(ball->center - from);
        if (!inside(*ball, distance2)) return lamp.chance / (2 * pi * one_minus_cosine(ball->radius, distance2));
    }
    const float cosine = std::max(1e-6f, std::fabs(dot(on.normal, direction)));
    return lamp.chance / lamp.area * length_squared(on.position - from) / cosine;
}

}  // namespace lightnet
