// The light of a clear sky, as a formula.
#pragma once

#include <array>

#include "core/base/math/rgb.hpp"

namespace lightnet {

/// Hošek & Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance", for linear sRGB. Without the sun.
class ClearSky {
public:
    /// `turbidity`: 1 … 10. `albedo` of the ground: 0 … 1. `elevation` of the sun over the horizon, radians: 0 … π/2.
    ClearSky(double turbidity, Rgb albedo, double elevation);

    /// From a direction above the horizon, by the cosine of its angle from the zenith and by its angle from the sun,
    /// radians: W·sr⁻¹·m⁻²·nm⁻¹, the mean over wavelengths.
    Rgb radiance(double cos_zenith, double from_sun) const;

private:
    struct Colour {
        std::array<double, 9> shape{};
        double strength = 0;
    };
    static double value(const Colour& colour, double cos_zenith, double from_sun);

    std::array<Colour, 3> colours_;
};

}  // namespace lightnet
