#include "core/readers/pbrt/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/pbrt/meshes.hpp"
#include "core/readers/pbrt/transforms.hpp"

namespace lightnet::pbrt {
namespace {

using CubicCurve = std::array<Vec3, 4>;

/// What a strand is made of, as the file says it.
struct Strand {
    std::vector<Vec3> points;
    bool b_spline = false;
    int degree = 3;
    float first_width = 1, last_width = 1;

    std::size_t step() const { return b_spline ? 1 : std::size_t(degree); }
    std::size_t segments() const { return (points.size() - 1 - std::size_t(degree)) / step() + 1; }
    /// Its diameter there; `along` from 0 to 1.
    float width(float along) const { return first_width + (last_width - first_width) * along; }
};

Vec3 part_way(Vec3 a, Vec3 b, float t) { return a * (1 - t) + b * t; }

CubicCurve of_quadratic(Vec3 a, Vec3 b, Vec3 c) { return {a, part_way(a, b, 2.0f / 3), part_way(b, c, 1.0f / 3), c}; }

CubicCurve of_b_spline(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    return {(a + b * 4 + c) / 6, part_way(b, c, 1.0f / 3), part_way(b, c, 2.0f / 3), (b + c * 4 + d) / 6};
}

/// A segment as a cubic Bézier curve.
CubicCurve segment_of(const Strand& strand, std::size_t index) {
    const Vec3* p = &strand.points[index * strand.step()];
    if (strand.degree == 3)
        return strand.b_spline ? of_b_spline(p[0], p[1], p[2], p[3]) : CubicCurve{p[0], p[1], p[2], p[3]};
    if (strand.b_spline) return of_quadratic(part_way(p[0], p[1], 0.5f), p[1], part_way(p[1], p[2], 0.5f));
    return of_quadratic(p[0], p[1], p[2]);
}

std::string choice_of(Parameters& parameters, const char* name, const std::string& fallback,
                      const std::vector<std::string>& known) {
    std::string given = parameters.text(name, fallback);
    if (std::find(known.begin(), known.end(), given) != known.end()) return given;
    parameters.error(fmt::format("'{}' is no '{}' of a curve{}", given, name, did_you_mean(given, known)));
    return "";
}

bool fits_its_points(const Strand& strand, Parameters& parameters) {
    const std::size_t count = strand.points.size(), least = std::size_t(strand.degree) + 1;
    if (count >= least && (count - least) % strand.step() == 0) return true;
    parameters.error(
        strand.b_spline
            ? fmt::format("a B-spline of degree {} needs {} points or more: there are {}", strand.degree, least, count)
            : fmt::format("a Bézier curve of degree {} needs {} points, and {} for each further segment: "
                          "there are {}",
                          strand.degree, least, strand.degree, count));
    return false;
}

std::optional<Strand> strand_of(Parameters& parameters) {
    Strand strand;
    strand.points = parameters.triples("P", Type::point3);
    strand.degree = parameters.integer("degree", 3);
    const std::string basis = choice_of(parameters, "basis", "bezier", {"bezier", "bspline"});
    const float width = parameters.number("width", 1);
    strand.first_width = parameters.number("width0", width);
    strand.last_width = parameters.number("width1", width);
    strand.b_spline = basis == "bspline";
    if (basis.empty()) return std::nullopt;
    if (strand.degree != 2 && strand.degree != 3) {
        parameters.error(fmt::format("the degree of a curve is 2 or 3, not {}", strand.degree));
        return std::nullopt;
    }
    if (!(strand.first_width >= 0 && strand.last_width >= 0)) {
        parameters.error("the width of a curve must be 0 or more");
        return std::nullopt;
    }
    if (!fits_its_points(strand, parameters)) return std::nullopt;
    return strand;
}

/// By how much a transform makes hair thicker.
float thickening(const Matrix& to_world, Parameters& parameters) {
    if (const auto scale = uniform_scale(to_world)) return float(*scale);
    const auto& m = to_world.m;
    const double volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                          m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                          m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    parameters.warn("a curve is stretched by its transform: it stays round, with the mean of its widths");
    return float(std::cbrt(std::fabs(volume)));
}

/// Points that follow each other share the ends of their segments.
std::optional<Geometry> round_curve(const Strand& strand, Parameters& parameters, const Matrix& to_world) {
    const float scale = thickening(to_world, parameters) / 2;
    const std::size_t count = strand.segments();
    Curves curves;
    curves.strands = {0};
    for (std::size_t s = 0; s < count; ++s) {
        const CubicCurve cubic = segment_of(strand, s);
        curves.segments.push_back(std::uint32_t(3 * s));
        for (std::size_t i = s == 0 ? 0 : 1; i < 4; ++i) {
            const Vec3 at = transform_point(to_world, cubic[i]);
            const float along = (float(s) + float(i) / 3) / float(count);
            curves.points.push_back({at.x, at.y, at.z, strand.width(along) * scale});
        }
    }
    if (std::isfinite(curves.extent())) return curves;
    parameters.error("a point of it is not finite after the transforms");
    return std::nullopt;
}

Vec3 on_cubic(const CubicCurve& p, float t) {
    const float s = 1 - t;
    return p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) + p[3] * (t * t * t);
}

Vec3 slope_on(const CubicCurve& p, float t) {
    const float s = 1 - t;
    return (p[1] - p[0]) * (3 * s * s) + (p[2] - p[1]) * (6 * s * t) + (p[3] - p[2]) * (3 * t * t);
}

/// On the way from one normal to the other, at an even pace.
Vec3 turned_normal(Vec3 from, Vec3 to, float t) {
    const float angle = std::acos(std::clamp(dot(from, to), -1.0f, 1.0f)), sine = std::sin(angle);
    return sine > 1e-4f ? (from * std::sin((1 - t) * angle) + to * std::sin(t * angle)) / sine : from;
}

/// A strip of quadrilaterals on both sides of the curve's middle, at right angles to the normals that the file gives.
std::optional<Geometry> ribbon(const Strand& strand, Parameters& parameters, const Placement& placement) {
    constexpr std::uint32_t cuts = 16;  // of each segment
    auto normals = parameters.triples("N", Type::normal);
    const std::size_t count = strand.segments();
    if (normals.size() != count + 1) {
        parameters.error(fmt::format("a ribbon of {} segments needs {} normals 'N': there are {}", count, count + 1,
                                     normals.size()));
        return std::nullopt;
    }
    for (Vec3& normal : normals) normal = normalize(normal);
    Mesh mesh;
    for (std::size_t s = 0; s < count; ++s) {
        const CubicCurve cubic = segment_of(strand, s);
        for (std::uint32_t i = s == 0 ? 0 : 1; i <= cuts; ++i) {
            const float t = float(i) / cuts, u = (float(s) + t) / float(count);
            const Vec3 normal = turned_normal(normals[s], normals[s + 1], t);
            const Vec3 across = normalize(cross(normal, slope_on(cubic, t))) * (strand.width(u) / 2);
            const Vec3 middle = on_cubic(cubic, t);
            mesh.positions.insert(mesh.positions.end(), {middle - across, middle + across});
            mesh.normals.insert(mesh.normals.end(), {normal, normal});
            mesh.uvs.insert(mesh.uvs.end(), {Vec2{u, 0}, Vec2{u, 1}});
        }
    }
    for (std::uint32_t i = 0; i + 3 < mesh.positions.size(); i += 2) {
        mesh.triangles.push_back({i, i + 2, i + 3});
        mesh.triangles.push_back({i, i + 3, i + 1});
    }
    if (const std::string problem = place(mesh, placement, placement.reversed); !problem.empty()) {
        parameters.error(problem);
        return std::nullopt;
    }
    return mesh;
}

}  // namespace

std::optional<Geometry> curve(Parameters& parameters, const Placement& placement) {
    parameters.ignore({"splitdepth"});
    const std::string type = choice_of(parameters, "type", "flat", {"flat", "cylinder", "ribbon"});
    const auto strand = strand_of(parameters);
    if (type.empty() || !strand) return std::nullopt;
    if (type == "ribbon") return ribbon(*strand, parameters, placement);
    if (type == "flat") parameters.warn("a flat curve is taken as a round one");
    parameters.ignore({"N"});
    return round_curve(*strand, parameters, placement.to_world);
}

}  // namespace lightnet::pbrt
