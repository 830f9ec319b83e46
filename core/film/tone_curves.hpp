// Curves that let bright colours run into white, instead of being clipped.
#pragma once

#include "core/base/math/rgb.hpp"

namespace lightnet {

/// How linear colours become what a display shows. clipped: at 0 and 1. ocio: as a view of OpenColorIO says.
enum class Tone {
    clipped,
    filmic,  // Narkowicz 2016, "ACES Filmic Tone Mapping Curve", per channel
    aces,    // Hill 2017 ("BakingLab", MIT): a fit of the RRT and the ODT for sRGB of ACES 1.0
    agx,     // Sobotka's AgX, base look, by the fit of Wrensch 2023 ("Minimal AgX Implementation")
    ocio
};

/// Linear again, 0 to 1, for the transfer curve of sRGB; what is no number is black. Not for `ocio`, which is no curve.
Rgb toned(Rgb linear, Tone tone);

}  // namespace lightnet
