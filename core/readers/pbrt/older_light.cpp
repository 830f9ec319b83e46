#include "core/readers/pbrt/older_light.hpp"

#include <cmath>
#include <vector>

namespace lightnet::pbrt {
namespace {

/// Planck's law, in parts of what it is at the brightest wavelength (nanometres).
double part_of_peak(double wavelength, double kelvin) {
    constexpr double second_radiation = 1.4387769e7, wien = 2.8977720e6;  // nm·K
    const double peak = wien / kelvin;
    const auto planck = [&](double w) { return std::pow(w / peak, -5) / std::expm1(second_radiation / (w * kelvin)); };
    return planck(wavelength) / planck(peak);
}

Matrix of_columns(Vec3 x, Vec3 y, Vec3 z) {
    Matrix m;
    for (std::size_t i = 0; i < 3; ++i) m.m[i][0] = x[i], m.m[i][1] = y[i], m.m[i][2] = z[i];
    return m;
}

}  // namespace

LightColour peaked_blackbody(float kelvin) {
    std::vector<SpectrumPoint> points;
    for (float w = 360; w <= 830; w += 5) points.push_back({w, float(part_of_peak(w, kelvin))});
    return mean_light(points);
}

// The middle of the picture lies at -x, and right of it -y.
Matrix older_sky_axes() { return of_columns({0, -1, 0}, {0, 0, 1}, {1, 0, 0}); }
Matrix older_goniometer_axes() { return of_columns({0, 0, -1}, {0, 1, 0}, {1, 0, 0}); }

}  // namespace lightnet::pbrt
