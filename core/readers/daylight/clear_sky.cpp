#include "core/readers/daylight/clear_sky.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/readers/daylight/coefficients.hpp"

namespace lightnet {
namespace {

constexpr double sum_of_luminance_curve = 106.856980;  // of the CIE 1931 observer, in steps of a nanometre

/// The six weights of a Bézier curve at `t`.
std::array<double, 6> bernstein(double t) {
    constexpr std::array<double, 6> choose{1, 5, 10, 10, 5, 1};
    std::array<double, 6> weights{};
    for (std::size_t k = 0; k < weights.size(); ++k)
        weights[k] = choose[k] * std::pow(t, double(k)) * std::pow(1 - t, 5 - double(k));
    return weights;
}

}  // namespace

// Between the fits for albedo and turbidity the coefficients are linear. The paper, section 5.2.
ClearSky::ClearSky(double turbidity, Rgb albedo, double elevation) {
    const double haze = std::clamp(turbidity, 1.0, 10.0) - 1, half = std::numbers::pi / 2;
    const auto low = std::min<std::size_t>(static_cast<std::size_t>(haze), 8);
    const auto weights = bernstein(std::cbrt(std::clamp(elevation, 0.0, half) / half));
    const std::array<const SkyCoefficients*, 3> fits{&red_of_sky, &green_of_sky, &blue_of_sky};
    const std::array<float, 3> grounds{albedo.r, albedo.g, albedo.b};
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const bool white = (corner & 1) != 0, hazier = (corner & 2) != 0;
            const double ground = std::clamp(double{grounds[c]}, 0.0, 1.0), above = haze - double(low);
            const double part = (white ? ground : 1 - ground) * (hazier ? above : 1 - above);
            const std::size_t fit = (white ? 10 : 0) + low + (hazier ? 1 : 0);
            for (std::size_t k = 0; k < weights.size(); ++k) {
                for (std::size_t i = 0; i < 9; ++i)
                    colours_[c].shape[i] += part * weights[k] * fits[c]->shape[fit][k][i];
                colours_[c].strength += part * weights[k] * fits[c]->strength[fit][k];
            }
        }
}

// Equations 8 and 9, with the halo's term as the authors have it in their program.
double ClearSky::value(const Colour& colour, double cos_zenith, double from_sun) {
    const auto& [a, b, c, d, e, f, g, i, h] = colour.shape;
    const double near = std::cos(from_sun), squared = near * near, up = std::max(cos_zenith, 0.0);
    const double halo = (1 + squared) / std::pow(1 + h * h - 2 * h * near, 1.5);
    const double spread = c + d * std::exp(e * from_sun) + f * squared + g * halo + i * std::sqrt(up);
    return colour.strength * (1 + a * std::exp(b / (up + 0.01))) * spread / sum_of_luminance_curve;
}

Rgb ClearSky::radiance(double cos_zenith, double from_sun) const {
    const auto of = [&](const Colour& colour) { return float(std::max(0.0, value(colour, cos_zenith, from_sun))); };
    return {of(colours_[0]), of(colours_[1]), of(colours_[2])};
}

}  // namespace lightnet
