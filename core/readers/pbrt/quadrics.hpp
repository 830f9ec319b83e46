// Round shapes cut into triangles.
#pragma once

#include "core/readers/pbrt/parameters.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// Parts of a sphere, as pbrt's parameters cut it: z in the unit of the shape, phi in radians.
struct SpherePart {
    float radius = 1, z_min = -1, z_max = 1, phi_max = 0;
};

/// All in the shape's own space, with shading normals as the shape has them by itself.
Mesh sphere_mesh(const SpherePart& part);
Mesh disk_mesh(Parameters& parameters);
Mesh cylinder_mesh(Parameters& parameters);

}  // namespace lightnet::pbrt
