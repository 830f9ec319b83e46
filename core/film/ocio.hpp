// Views of OpenColorIO: how pictures are shown on displays, as a config says that many programs share.
#pragma once

#include <string>
#include <vector>

#include "core/base/math/rgb.hpp"

namespace lightnet::ocio {

/// Views of the config that $OCIO names: those of its usual display by their names, all as "DISPLAY/VIEW". Empty: $OCIO
/// names none. Throws Error where the config can't be read.
std::vector<std::string> views();

/// Turns linear colours of BT.709, as a picture has them, into what the display of that view is sent, 0 to 1. What is
/// linear in BT.709 the config knows by a name (such as "lin_rec709"), or it has one of the roles of interchange,
/// aces_interchange and cie_xyz_d65_interchange. Throws Error where it has neither, or no such view.
void show(std::vector<Rgb>& pixels, const std::string& view);

}  // namespace lightnet::ocio
