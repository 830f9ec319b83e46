// Meshes of pbrt's shapes, set where they stand.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/shapes.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// The shapes 'trianglemesh', 'bilinearmesh' and 'loopsubdiv', in their own space. None: reported.
std::optional<Mesh> triangle_mesh(Parameters& parameters);
std::optional<Mesh> bilinear_mesh(Parameters& parameters);
std::optional<Mesh> subdivision_mesh(Parameters& parameters);

/// Moves a mesh from its own space into the world; `turn` turns the shading normals. Returns what is wrong, or "".
/// Touches nothing but the mesh, so that it may be done in any thread.
std::string place(Mesh& mesh, const Placement& placement, bool turn);

}  // namespace lightnet::pbrt
