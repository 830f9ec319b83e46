// Light of images around a scene, worked out.
#pragma once

#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

Rgb mean_colour(const Image& image);
inline float mean_luminance(const Image& image) { return luminance(mean_colour(image)); }

/// Square images have equal areas, others rows of latitude.
EnvironmentData::Layout layout_of(const Image& image);

/// Illuminance (lux, for radiances in nits) of a plane that looks along the environment's own +z axis (+y, where it
/// has rows of latitude), by the upper half of its image alone, not multiplied by its radiance.
float upper_illuminance(const EnvironmentData& environment);

}  // namespace lightnet::pbrt
