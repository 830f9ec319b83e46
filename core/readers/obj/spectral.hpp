// Colours of MTL files by measured curves ("Kd spectral paint.rfl 0.8").
#pragma once

#include <optional>

#include "core/readers/common/assets.hpp"
#include "core/readers/obj/lines.hpp"

namespace lightnet::obj {

/// What stands behind 'spectral': a file of wavelengths (nm) and values in turn, and perhaps a factor. `shines`: it is
/// the curve of a light, else that of a surface. None: what keeps it from being read is reported or warned of.
std::optional<Rgb> spectral_colour(Lines& line, bool shines, Assets& assets);

}  // namespace lightnet::obj
