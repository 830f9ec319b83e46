#include "core/readers/mitsuba/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet::mitsuba {
namespace {

using Knot = std::array<float, 4>;

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed_front(std::string_view text) {
    const auto first = text.find_first_not_of(blanks);
    return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

Error wrong(std::size_t line, const std::string& what) { return Error(fmt::format("line {}: {}", line, what)); }

Knot point_of(std::string_view text, std::size_t line, const Matrix& to_world) {
    Knot point{};
    for (float& number : point) {
        text = trimmed_front(text);
        if (!text.empty() && text.front() == '+') text.remove_prefix(1);
        const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (fault != std::errc{}) throw wrong(line, "a control point has four numbers: x y z radius");
        text.remove_prefix(std::size_t(end - text.data()));
    }
    const Vec3 at = transform_point(to_world, {point[0], point[1], point[2]});
    if (!finite(at)) throw wrong(line, "a control point is not finite");
    if (!std::isfinite(point[3]) || point[3] < 0) throw wrong(line, "a radius must be 0 or more");
    return {at.x, at.y, at.z, point[3]};
}

Knot mix_of(const Knot& a, const Knot& b, float t) {
    Knot made{};
    for (std::size_t i = 0; i < made.size(); ++i) made[i] = a[i] * (1 - t) + b[i] * t;
    return made;
}

void add_straight(Curves& to, const std::vector<Knot>& strand) {
    const std::size_t first = to.points.size();
    to.points.push_back(strand.front());
    for (std::size_t i = 0; i + 1 < strand.size(); ++i) {
        to.segments.push_back(std::uint32_t(first + 3 * i));
        for (const float t : {1.0f / 3, 2.0f / 3}) to.points.push_back(mix_of(strand[i], strand[i + 1], t));
        to.points.push_back(strand[i + 1]);
    }
}

void add_spline(Curves& to, const std::vector<Knot>& strand) {
    for (std::size_t i = 0; i + 3 < strand.size(); ++i) to.segments.push_back(std::uint32_t(to.points.size() + i));
    to.points.insert(to.points.end(), strand.begin(), strand.end());
}

}  // namespace

Curves read_curves(std::string_view text, bool linear, const Matrix& to_world) {
    Curves curves;
    curves.basis = linear ? Curves::Basis::bezier : Curves::Basis::b_spline;
    const std::size_t least = linear ? 2 : 4;
    std::vector<Knot> strand;
    const auto finish = [&](std::size_t line) {
        if (strand.empty()) return;
        if (strand.size() < least)
            throw wrong(line,
                        fmt::format("a curve needs {} control points or more: there are {}", least, strand.size()));
        curves.strands.push_back(std::uint32_t(curves.segments.size()));
        linear ? add_straight(curves, strand) : add_spline(curves, strand);
        strand.clear();
    };
    std::size_t line = 0;
    for (std::size_t at = 0; at < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view here = trimmed_front(text.substr(at, end - at));
        here.empty() ? finish(line) : strand.push_back(point_of(here, line + 1, to_world));
        at = end + 1;
    }
    finish(line);
    if (curves.segments.empty()) throw Error("there are no control points in it");
    return curves;
}

}  // namespace lightnet::mitsuba
