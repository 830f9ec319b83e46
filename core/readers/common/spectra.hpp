// Spectra as linear RGB: named metals, glasses, black bodies, measured tables.
#pragma once

#include <array>
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

/// CIE 1931 XYZ to linear sRGB (IEC 61966-2-1); below 0 where sRGB can't show it.
std::array<double, 3> rgb_of_xyz(double x, double y, double z);

/// Light, and what light meets (a reflectance, an index of refraction, an absorption). One spectrum is another RGB as
/// the one than as the other, so they are two types, and who takes the one for the other does not compile.
/// DECISIONS: light-and-surface-colours
struct LightColour {
    Rgb rgb;
    friend bool operator==(const LightColour&, const LightColour&) = default;
};
struct SurfaceColour {
    Rgb rgb;
    friend bool operator==(const SurfaceColour&, const SurfaceColour&) = default;
};

/// Of a surface (or an index of refraction) with that spectrum, under daylight D65: the same value at all wavelengths
/// c gives {c, c, c}.
SurfaceColour surface_colour(std::span<const SpectrumPoint> spectrum);
/// Of a light with that spectrum, of luminance 1; D65 gives {1, 1, 1}. Colours that no screen can show are cut at 0.
/// Black when the spectrum is.
LightColour light_colour(std::span<const SpectrumPoint> spectrum);
/// As light_colour(), in steps of a nanometre: for tables with lines in them.
LightColour light_colour_of_lines(std::span<const SpectrumPoint> spectrum);
/// Of a light with that spectrum: the mean over the wavelengths, as the eye sees it and without any adaptation. The
/// same value c everywhere gives {1.205, 0.948, 0.909} c. Colours that no screen can show are cut at 0.
LightColour mean_light(std::span<const SpectrumPoint> spectrum);
/// As mean_light(), in steps of a nanometre: for tables with lines in them.
LightColour mean_light_of_lines(std::span<const SpectrumPoint> spectrum);
/// Has light of that spectrum (of a black body of that many kelvin) a colour that no sRGB screen can show? It is cut.
bool beyond_srgb(std::span<const SpectrumPoint> spectrum);
bool blackbody_beyond_srgb(float kelvin);
/// The spectrum (of one point at least), but 0 beyond its ends, where it does not begin at `low` and end at `high`
/// nanometres, or farther out.
std::vector<SpectrumPoint> dark_beyond_ends(std::vector<SpectrumPoint> spectrum, float low, float high);
/// Of a black body of that many kelvin (> 0), of luminance 1.
LightColour blackbody_colour(float kelvin);

/// Of daylight (CIE series D) of that many kelvin, of luminance 1; 6504 is D65, {1, 1, 1}. Beneath 4000 K, where the
/// series ends, of a black body.
LightColour daylight_colour(float kelvin);

/// Indices of refraction that pbrt names: "metal-Cu-eta", "metal-Cu-k", "glass-BK7".
std::optional<SurfaceColour> named_index(std::string_view name);
/// Lights that pbrt names: "stdillum-D65" and its like.
std::optional<LightColour> named_light(std::string_view name);
/// All names above, for suggestions.
const std::vector<std::string>& spectrum_names();

/// A table in text: wavelength and value in turn, '#' begins a remark. Throws Error without a file name.
std::vector<SpectrumPoint> read_spd(std::string_view text);

}  // namespace lightnet
