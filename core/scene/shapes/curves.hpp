// Hair: round curves whose thickness changes along them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

/// A point of the middle line of a curve, by its parameter within a segment.
struct OnCurve {
    Vec3 position;
    Vec3 slope;        // derivative by the parameter; never zero where the segment has a length
    float radius = 0;  // metres
    float growth = 0;  // derivative of the radius by the parameter
};

/// A shape: see IsShape for what its functions say. Cubic segments around whose middle line a circle goes, at right
/// angles to it; the ends are open. Rays meet the outside alone, as in Mitsuba. A point is named by the parameter
/// within its segment, 0 … 1, and by its direction from the middle line by the quarters of a square (0 … 4, less 2),
/// see across(). Texture coordinates: u from 0 to 1 along a strand, each segment of it alike; v once around.
struct Curves {
    enum class Basis { bezier, b_spline } basis = Basis::bezier;
    std::vector<std::array<float, 4>> points;  // control points: position and radius, metres
    std::vector<std::uint32_t> segments;       // the first of four points of each
    std::vector<std::uint32_t> strands;        // the first segment of each, in order, from 0

    static constexpr const char* names = "curves";
    static constexpr const char* part = "a control point";
    std::uint64_t pieces() const { return segments.size(); }
    std::string fault() const;
    void add_to(Box& box, const Matrix& by) const;
    float extent() const;
    float largest_piece() const { return 0; }
    double area() const;
    std::size_t memory() const;
    const Curves* placed() const { return this; }

    OnCurve at(std::uint32_t segment, float parameter) const;
    /// Texture coordinate along its strand at the start of a segment, and how much each of its segments adds.
    struct Share {
        float start, size;
    };
    Share share(std::uint32_t segment) const;
    /// Appends the strands of others of the same basis.
    void append(const Curves& others);
};
void visit_members(Is<Curves> auto& curves, const auto& visit) {
    auto& [basis, points, segments, strands] = curves;
    visit(basis, points, segments, strands);
}

/// A point of a curve's surface.
struct CurveSurface {
    Vec3 position, normal;  // unit, outwards
    Vec3 along, around;     // derivatives by the parameter, and by a turn from 0 to 1
    float stretch = 0;      // area per parameter and turn, m²
};
/// By its name.
CurveSurface surface_of(const OnCurve& middle, float across);
/// The second part of a name: of the point in that direction from the middle line. Any length but 0.
float across(const OnCurve& middle, Vec3 outwards);

}  // namespace lightnet
