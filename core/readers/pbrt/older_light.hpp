// Lights of pbrt-v3, where pbrt-v4 means something else.
#pragma once

#include "core/base/math/transform.hpp"
#include "core/readers/common/spectra.hpp"

namespace lightnet::pbrt {

/// A black body of that many kelvin (> 0) whose radiance is 1 at the wavelength where it is brightest.
LightColour peaked_blackbody(float kelvin);

/// From the axes of a picture as sky_layout.hpp lays it out by latitude and longitude into those of pbrt-v3's lights.
/// Of the sky z is up, and the picture begins at x and goes on to y.
Matrix older_sky_axes();
/// The axes of a goniometric light of pbrt-v3, of which y is up, and whose picture goes on to z.
Matrix older_goniometer_axes();

}  // namespace lightnet::pbrt
