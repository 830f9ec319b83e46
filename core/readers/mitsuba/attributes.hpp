// The numbers of meshes that Mitsuba's textures ask for by name: mesh_attribute.
#pragma once

#include <string>
#include <vector>

#include "core/readers/mitsuba/properties.hpp"

namespace lightnet::mitsuba {

/// Names of attributes ("vertex_color", "face_heat") for which textures below an element ask, references followed;
/// each once, in the order in which they stand.
std::vector<std::string> attributes_in(const Node& node, const Context& context);

}  // namespace lightnet::mitsuba
