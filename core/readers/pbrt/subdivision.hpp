// Surfaces by subdivision.
#pragma once

#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// Loop's subdivision of a mesh of triangles, `levels` times, its vertices then moved to where they would end, with
/// shading normals (Loop 1987, "Smooth Subdivision Surfaces Based on Triangles"; boundaries and limits: Hoppe et al.
/// 1994, "Piecewise Smooth Surface Reconstruction", appendix). Edges of one face, or of more than two, are boundaries.
Mesh subdivide(const Mesh& control, int levels);

}  // namespace lightnet::pbrt
