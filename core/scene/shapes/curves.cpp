#include "core/scene/shapes/curves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/math/frame.hpp"
#include "core/scene/shapes/placed_quadric.hpp"

namespace lightnet {
namespace {

using Four = std::array<float, 4>;

Vec3 position_of(const Four& point) { return {point[0], point[1], point[2]}; }

Four weights_of(Curves::Basis basis, float t) {
    const float s = 1 - t;
    if (basis == Curves::Basis::bezier) return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    return {s * s * s / 6, (4 + 3 * t * t * (t - 2)) / 6, (4 + 3 * s * s * (s - 2)) / 6, t * t * t / 6};
}

Four slopes_of(Curves::Basis basis, float t) {
    const float s = 1 - t;
    if (basis == Curves::Basis::bezier) return {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
    return {-s * s / 2, t * (3 * t - 4) / 2, -s * (3 * s - 4) / 2, t * t / 2};
}

Vec3 unit_or(Vec3 v, Vec3 other) {
    const float size = length(v);
    return size > 0 ? v / size : other;
}

/// A point on a square around the origin, by quarters of it: the inverse of square_angle().
Vec2 on_square(float quarters) {
    const float within = std::clamp(quarters, 0.0f, 4.0f);
    return within <= 2 ? Vec2{1 - within, 1 - std::fabs(1 - within)} : Vec2{within - 3, std::fabs(within - 3) - 1};
}

}  // namespace

std::string Curves::fault() const {
    const auto beyond = [&](std::uint32_t first) { return std::uint64_t{first} + 4 > points.size(); };
    if (std::any_of(segments.begin(), segments.end(), beyond)) return "a segment names a point that isn't there";
    const auto thin = [](const Four& point) { return !(point[3] >= 0) || !std::isfinite(point[3]); };
    if (std::any_of(points.begin(), points.end(), thin)) return "the radius of a point must be 0 or more";
    const bool ordered = std::adjacent_find(strands.begin(), strands.end(), std::greater_equal<>()) == strands.end();
    const bool all = segments.empty() || (!strands.empty() && strands.front() == 0 && strands.back() < segments.size());
    return ordered && all ? "" : "its strands don't follow each other";
}

void Curves::add_to(Box& box, const Matrix& by) const {
    const auto& m = by.m;
    std::array<float, 3> stretch{};  // of a ball, along the axes of the world
    for (std::size_t i = 0; i < 3; ++i)
        stretch[i] = float(std::sqrt(m[i][0] * m[i][0] + m[i][1] * m[i][1] + m[i][2] * m[i][2]));
    for (const Four& point : points) {
        const Vec3 at = transform_point(by, position_of(point));
        const Vec3 reach = Vec3{stretch[0], stretch[1], stretch[2]} * point[3];
        box.add(at - reach);
        box.add(at + reach);
    }
}

float Curves::extent() const {
    float largest = 0;
    for (const Four& p : points) {
        const float far = std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]) + std::fabs(p[3]);
        if (!(far <= largest)) largest = far;
        if (!std::isfinite(far)) return far;
    }
    return largest;
}

// By Simpson's rule on each half of a segment.
double Curves::area() const {
    double sum = 0;
    for (std::uint32_t s = 0; s < segments.size(); ++s) {
        constexpr std::array<double, 5> weights{1, 4, 2, 4, 1};
        for (std::size_t i = 0; i < weights.size(); ++i)
            sum += weights[i] / 12 * double{surface_of(at(s, float(i) / 4), -2).stretch};
    }
    return sum;
}

std::size_t Curves::memory() const {
    return points.size() * sizeof(Four) + (segments.size() + strands.size()) * sizeof(std::uint32_t);
}

OnCurve Curves::at(std::uint32_t segment, float parameter) const {
    const Four* of = &points[segments[segment]];
    const Four weights = weights_of(basis, parameter), slopes = slopes_of(basis, parameter);
    OnCurve at;
    for (std::size_t i = 0; i < 4; ++i) {
        at.position += position_of(of[i]) * weights[i];
        at.slope += position_of(of[i]) * slopes[i];
        at.radius += of[i][3] * weights[i];
        at.growth += of[i][3] * slopes[i];
    }
    // where points lie on each other at an end, as hair of many programs has them
    if (at.slope == Vec3{}) at.slope = position_of(of[3]) - position_of(of[0]);
    return at;
}

Curves::Share Curves::share(std::uint32_t segment) const {
    const auto next = std::upper_bound(strands.begin(), strands.end(), segment);
    const std::uint32_t first = *(next - 1);
    const auto end = next == strands.end() ? std::uint32_t(segments.size()) : *next;
    const float size = 1 / float(end - first);
    return {float(segment - first) * size, size};
}

void Curves::append(const Curves& others) {
    const auto first_point = std::uint32_t(points.size()), first_segment = std::uint32_t(segments.size());
    points.insert(points.end(), others.points.begin(), others.points.end());
    for (const auto segment : others.segments) segments.push_back(first_point + segment);
    for (const auto strand : others.strands) strands.push_back(first_segment + strand);
}

CurveSurface surface_of(const OnCurve& middle, float across) {
    const Vec3 tangent = unit_or(middle.slope, {0, 0, 1});
    const Frame frame = Frame::around(tangent);
    const Vec2 on = on_square(across + 2);
    const float size = std::sqrt(on.x * on.x + on.y * on.y);
    const Vec3 outwards = (frame.x * on.x + frame.y * on.y) / size;
    const float speed = length(middle.slope), turn = 2 * std::numbers::pi_v<float> * middle.radius;
    CurveSurface made;
    made.position = middle.position + outwards * middle.radius;
    made.normal = unit_or(outwards * speed - tangent * middle.growth, outwards);
    made.along = middle.slope + outwards * middle.growth;
    made.around = (frame.y * on.x - frame.x * on.y) * (turn / size);
    made.stretch = turn * std::sqrt(speed * speed + middle.growth * middle.growth);
    return made;
}

float across(const OnCurve& middle, Vec3 outwards) {
    const Frame frame = Frame::around(unit_or(middle.slope, {0, 0, 1}));
    return float(square_angle(double{dot(outwards, frame.x)}, double{dot(outwards, frame.y)}) - 2);
}

}  // namespace lightnet
