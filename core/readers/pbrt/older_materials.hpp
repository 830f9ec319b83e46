// The materials of pbrt-v3, made into those that a scene has.
#pragma once

#include <string>

#include "core/readers/pbrt/older_sums.hpp"

namespace lightnet::pbrt {

/// pbrt-v3's α of GGX for a roughness of 0 … 1.
float older_alpha(float roughness);

/// As make_material(), with the names and meanings of pbrt-v3.
Material make_older_material(const std::string& type, Parameters& parameters, const OlderSources& sources);

}  // namespace lightnet::pbrt
