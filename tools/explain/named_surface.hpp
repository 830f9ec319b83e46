// Surface points, as users know them.
#pragma once

#include <string>

#include "core/base/math/vec.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// A value.
struct NamedSurface {
    std::string shape, material, object;  // shape and material are never empty; object: "" where it is no instance
    std::string where;                    // "cornell_box.pbrt:7"; "": nobody knows
    Vec3 position;
};

/// What a ray has met.
NamedSurface named_surface(const Scene& scene, const Hit& hit);
/// What a question is about: a surface, or a collision in a medium.
NamedSurface named_point(const Scene& scene, const Query& question);

/// "floor (white) at 1, 2, 3"
std::string to_string(const NamedSurface& surface);
std::string to_string(Vec3 position);

}  // namespace lightnet
