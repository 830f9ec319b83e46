// Spectra as linear RGB: named metals, glasses, black bodies, measured tables.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math/rgb.hpp"

namespace lightnet {

/// A spectrum: linear between its points, constant beyond them.
struct SpectrumPoint {
    float wavelength = 0;  // nanometres, ascending
    float value = 0;
};

/// The colour of a surface (or an index of refraction) with that spectrum, under daylight D65: the same value at all
/// wavelengths c gives {c, c, c}.
Rgb surface_colour(std::span<const SpectrumPoint> spectrum);
/// The colour of a light with that spectrum, of luminance 1; D65 gives {1, 1, 1}. Colours that no screen can show are
/// cut at 0. Black when the spectrum is.
Rgb light_colour(std::span<const SpectrumPoint> spectrum);
/// The mean over the wavelengths, as the eye sees it and without any adaptation: the same value c everywhere gives
/// {1.205, 0.948, 0.909} c. Colours that no screen can show are cut at 0.
Rgb mean_colour(std::span<const SpectrumPoint> spectrum);
/// The colour of a black body of that many kelvin (> 0), of luminance 1.
Rgb blackbody_colour(float kelvin);

/// The colour of daylight (CIE series D) of that many kelvin, of luminance 1; 6504 is D65, {1, 1, 1}. Beneath 4000 K,
/// where the series ends, of a black body.
Rgb daylight_colour(float kelvin);

/// Indices of refraction that pbrt names: "metal-Cu-eta", "metal-Cu-k", "glass-BK7".
std::optional<Rgb> named_index(std::string_view name);
/// Lights that pbrt names: "stdillum-D65" and its like.
std::optional<Rgb> named_light(std::string_view name);
/// All names above, for suggestions.
const std::vector<std::string>& spectrum_names();

/// A table in text: wavelength and value in turn, '#' begins a remark. Throws Error without a file name.
std::vector<SpectrumPoint> read_spd(std::string_view text);

}  // namespace lightnet
