// pbrt's shapes, made into meshes and spheres in world space.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math/transform.hpp"
#include "core/scene/pbrt/parameters.hpp"
#include "core/scene/pbrt/sources.hpp"
#include "core/scene/scene_data.hpp"

namespace lightnet::pbrt {

using Geometry = std::variant<Mesh, Sphere>;

/// Where a shape stands.
struct Placement {
    Matrix to_world;
    Matrix from_world;
    bool reversed = false;  // ReverseOrientation

    /// Is the normal against the one that the shape has by itself? pbrt's rule: a mirroring turns it as well.
    bool flips() const { return reversed != swaps_handedness(to_world); }
};

/// The shape of that type. None: reported.
std::optional<Geometry> make_shape(const std::string& type, Parameters& parameters, const Sources& sources,
                                   const Placement& placement);

/// A copy of a shape that stands in world space already, moved again: instances.
Geometry moved(const Geometry& geometry, const Placement& placement);

/// In world space.
double area_of(const Geometry& geometry);

}  // namespace lightnet::pbrt
