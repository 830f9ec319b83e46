#include "core/readers/pbrt/current_transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/suggestion.hpp"
#include "core/readers/common/between_transforms.hpp"
#include "core/readers/pbrt/transforms.hpp"

namespace lightnet::pbrt {
namespace {

constexpr std::array statements{
    "ActiveTransform", "ConcatTransform", "CoordSysTransform", "CoordinateSystem", "Identity", "LookAt",
    "Rotate",          "Scale",           "Transform",         "TransformTimes",   "Translate"};

}  // namespace

bool CurrentTransform::knows(const std::string& directive) {
    return std::ranges::find(statements, directive) != statements.end();
}

void CurrentTransform::execute(const Statement& s, TransformState& state) {
    const auto& n = s.numbers;
    const auto apply_or = [&](const std::optional<Matrix>& matrix, const char* complaint) {
        if (matrix) return apply(*matrix, state);
        report_.error(s.where, complaint);
    };
    if (s.directive == "Translate") return apply(translation(n[0], n[1], n[2]), state);
    // what is scaled by 0, or by a singular matrix, does no harm until something stands there
    if (s.directive == "Scale") return apply(scaling(n[0], n[1], n[2]), state);
    if (s.directive == "Rotate")
        return apply_or(rotation(n[0], n[1], n[2], n[3]), "Rotate needs an axis that is not 0");
    if (s.directive == "LookAt")
        return apply_or(look_at(std::span<const double, 9>(n)), "LookAt: eye, target and up must span a view");
    if (s.directive == "ConcatTransform") return apply(by_columns(std::span<const double, 16>(n)), state);
    if (s.directive == "Identity") return replace({}, state);
    if (s.directive == "CoordinateSystem") return define(s.names[0], state.transform);
    if (s.directive == "CoordSysTransform") return coord_sys_transform(s, state);
    if (s.directive == "ActiveTransform") return active_transform(s, state);
    if (s.directive == "TransformTimes") return transform_times(s);
    const Matrix whole = by_columns(std::span<const double, 16>(n));  // Transform
    replace({whole, whole}, state);
}

void CurrentTransform::apply(const Matrix& matrix, TransformState& state) {
    auto& [start, end] = state.transform;
    if (state.start_active) start = start * matrix;
    if (state.end_active) end = end * matrix;
}

void CurrentTransform::replace(const MovingTransform& transform, TransformState& state) {
    if (state.start_active) state.transform.at_start = transform.at_start;
    if (state.end_active) state.transform.at_end = transform.at_end;
}

void CurrentTransform::coord_sys_transform(const Statement& s, TransformState& state) {
    if (const auto found = systems_.find(s.names[0]); found != systems_.end()) return replace(found->second, state);
    std::vector<std::string> known;
    for (const auto& [name, transform] : systems_) known.push_back(name);
    report_.error(s.where,
                  fmt::format("there is no coordinate system '{}'{}", s.names[0], did_you_mean(s.names[0], known)));
}

void CurrentTransform::active_transform(const Statement& s, TransformState& state) {
    const std::string& which = s.names[0];
    if (which != "All" && which != "StartTime" && which != "EndTime")
        return report_.error(s.where, fmt::format("ActiveTransform is All, StartTime or EndTime, not '{}'", which));
    state.start_active = which != "EndTime";
    state.end_active = which != "StartTime";
}

void CurrentTransform::transform_times(const Statement& s) {
    if (!(s.numbers[1] > s.numbers[0]))
        return report_.error(s.where, "TransformTimes: the end must come after the start");
    start_ = s.numbers[0], end_ = s.numbers[1];
}

void CurrentTransform::begin_world(TransformState& state) {
    state = {};
    define("world", {});
}

Matrix CurrentTransform::at(const MovingTransform& transform, double seconds) const {
    const std::array<TransformKey, 2> keys{{{start_, transform.at_start}, {end_, transform.at_end}}};
    return transform_at(keys, seconds);
}

}  // namespace lightnet::pbrt
