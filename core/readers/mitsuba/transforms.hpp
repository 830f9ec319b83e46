// Mitsuba's <transform>.
#pragma once

#include "core/base/math/transform.hpp"
#include "core/readers/mitsuba/properties.hpp"

namespace lightnet::mitsuba {

/// The statements of a <transform>, each applied after those before it. What is wrong is reported and left out.
Matrix transform_of(const Node& node, const Context& context);
/// Of the property `name`, by default "to_world"; the identity if it is not given.
Matrix transform_of(Properties& properties, std::string_view name = "to_world");

/// A to_uv transform over Mitsuba's texture coordinates, whose v goes down, as the same over ours. `flipped`: its
/// result goes down as well. Shears are left out, with a warning.
UvTransform uv_transform(Properties& properties, bool flipped);

/// The factor by which all lengths grow; none: it is not the same in all directions.
std::optional<float> uniform_scale(const Matrix& t);

}  // namespace lightnet::mitsuba
