// Shapes that pbrt-v3 has and pbrt-v4 has not, as meshes in their own space.
#pragma once

#include <optional>

#include "core/readers/pbrt/parameters.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// A square of nu × nv heights: exact, as pbrt cuts it into triangles, too. None: reported.
std::optional<Mesh> height_field(Parameters& parameters);

/// Around the z axis, cut into triangles with smooth normals, which is named.
std::optional<Mesh> cone(Parameters& parameters);
std::optional<Mesh> paraboloid(Parameters& parameters);
std::optional<Mesh> hyperboloid(Parameters& parameters);

}  // namespace lightnet::pbrt
