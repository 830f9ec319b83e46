#include "core/readers/pbrt/pictured_lights.hpp"

#include <cmath>
#include <numbers>

namespace lightnet::pbrt {
namespace {

/// Cosine to +z of a point of the equal-area square (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using
/// SIMD"): u, v in ±1.
double height(double u, double v) {
    const double distance = 1 - (std::fabs(u) + std::fabs(v)), r = 1 - std::fabs(distance);
    return std::copysign(1 - r * r, distance);
}

}  // namespace

Rgb mean_colour(const Image& image) {
    double r = 0, g = 0, b = 0;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const Rgb p = image.colour(x, y);
            r += p.r, g += p.g, b += p.b;
        }
    const double n = image.empty() ? 1 : double(image.width) * image.height;
    return {float(r / n), float(g / n), float(b / n)};
}

EnvironmentData::Layout layout_of(const Image& image) {
    return image.width == image.height ? EnvironmentData::Layout::equal_area
                                       : EnvironmentData::Layout::latitude_longitude;
}

float upper_illuminance(const EnvironmentData& environment) {
    const Image& image = *environment.image;
    const bool square = environment.layout == EnvironmentData::Layout::equal_area;
    double sum = 0;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const double u = (x + 0.5) / image.width, v = (y + 0.5) / image.height;
            const double cosine = square ? height(2 * u - 1, 2 * v - 1) : std::cos(std::numbers::pi * v);
            // solid angle of a pixel: 4π by their number, or by the latitude
            const double weight = square ? 4 * std::numbers::pi
                                         : 2 * std::numbers::pi * std::numbers::pi * std::sin(std::numbers::pi * v);
            if (cosine > 0) sum += double(luminance(image.colour(x, y))) * weight * cosine;
        }
    return float(sum / (image.empty() ? 1 : double(image.width) * image.height));
}

}  // namespace lightnet::pbrt
