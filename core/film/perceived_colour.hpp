// Colour spaces in which distances are about as large as they look. All are relative to the white of sRGB.
#pragma once

#include <array>

#include "core/base/math/rgb.hpp"

namespace lightnet {

using Triple = std::array<double, 3>;

/// YCxCz: a linear form of CIELAB, in which filters may work. From linear RGB, and back.
Triple ycxcz_of(Rgb linear);
Rgb rgb_of_ycxcz(const Triple& colour);

/// CIELAB of linear RGB, its chroma scaled by how light it is (the Hunt effect: dark colours look less colourful).
Triple hunt_lab_of(Rgb linear);

/// HyAB: city block distance in lightness, straight distance in chroma (Abasi et al. 2020), for large differences.
double hyab(const Triple& a, const Triple& b);

}  // namespace lightnet
