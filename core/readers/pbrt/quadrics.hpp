// Disks, cylinders, and spheres that are cut or stretched.
#pragma once

#include <optional>

#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/shapes.hpp"

namespace lightnet::pbrt {

/// Parts of a sphere, as pbrt's parameters cut it: z in the unit of the shape, phi in radians.
struct SpherePart {
    float radius = 1, z_min = -1, z_max = 1, phi_max = 0;
};

/// Where the shape stands. None: it was reported why.
std::optional<Geometry> sphere_part(const SpherePart& part, Parameters& parameters, const Placement& placement);
std::optional<Geometry> disk(Parameters& parameters, const Placement& placement);
std::optional<Geometry> cylinder(Parameters& parameters, const Placement& placement);

}  // namespace lightnet::pbrt
