// A ray, and what it hits.
#pragma once

#include <cstdint>
#include <limits>

#include "core/math/vec.hpp"

namespace lightnet {

struct Ray {
    Vec3 origin;
    Vec3 direction;                                      // unit
    float far = std::numeric_limits<float>::infinity();  // metres along the direction
};

/// What names a point of a surface: no more than a Query carries.
struct Hit {
    std::uint32_t instance = 0xffffffffu;
    std::uint32_t geometry = 0;
    std::uint32_t primitive = 0;
    float u = 0, v = 0;  // barycentric; for spheres the octahedral normal
    float distance = 0;  // along the ray; not part of the name
};

}  // namespace lightnet
