// pbrt's hair.
#pragma once

#include "core/readers/pbrt/materials.hpp"

namespace lightnet::pbrt {

/// Material "hair" of pbrt-v4 and pbrt-v3.
HairMaterial hair_material(Parameters& parameters, const MaterialSources& sources);

}  // namespace lightnet::pbrt
