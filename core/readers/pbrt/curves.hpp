// Curves of pbrt: hair as round curves, ribbons as meshes.
#pragma once

#include <optional>

#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/shapes.hpp"

namespace lightnet::pbrt {

/// One strand. None: it was reported why.
std::optional<Geometry> curve(Parameters& parameters, const Placement& placement);

}  // namespace lightnet::pbrt
