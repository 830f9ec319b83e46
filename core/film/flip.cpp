#include "core/film/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "core/film/perceived_colour.hpp"
#include "core/film/plane.hpp"

namespace lightnet {
namespace {

using std::numbers::pi;

// The constants of the article, section 4.
constexpr double colour_power = 0.7;       // q_c
constexpr double knee = 0.4;               // p_c, in parts of the largest colour difference
constexpr double value_at_knee = 0.95;     // p_t
constexpr double feature_power = 0.5;      // q_f
constexpr double feature_degrees = 0.082;  // w: how wide features are that the eye finds

using Planes = std::array<Plane, 3>;  // of YCxCz

// DECISIONS: flip-as-shown
float shown(float value, float scale) {
    const float exposed = value * scale;
    return exposed > 0 ? std::min(exposed, 1.0f) : 0;  // no number: 0, too
}

Planes planes_of(std::uint32_t width, std::span<const Rgb> pixels, float scale) {
    Planes planes;
    const auto height = static_cast<std::uint32_t>(pixels.size() / width);
    for (Plane& plane : planes) plane = {width, height, std::vector<float>(pixels.size())};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Rgb c = pixels[i];
        const auto colour = ycxcz_of({shown(c.r, scale), shown(c.g, scale), shown(c.b, scale)});
        for (std::size_t k = 0; k < 3; ++k) planes[k].values[i] = static_cast<float>(colour[k]);
    }
    return planes;
}

/// a √(π/b) exp(-π² x² / b), x in degrees: what the eye makes of a point.
struct Spread {
    double a, b;
};

// Contrast sensitivity: what is too fine to be seen is smoothed away. A sum of spreads is filtered one by one.
Plane seen(const Plane& plane, std::initializer_list<Spread> spreads, double pixels_per_degree) {
    constexpr double widest = 0.04;  // b of all spreads of all channels
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
    Plane sum{plane.width, plane.height, std::vector<float>(plane.values.size())};
    double all = 0;
    for (const auto& [a, b] : spreads) {
        const Weights weights = gaussian(pi * pi / (b * pixels_per_degree * pixels_per_degree), radius);
        // gaussian() has divided by the sum of its weights, whose square this spread has in two dimensions
        const double share = a * std::sqrt(pi / b) / std::pow(weights[static_cast<std::size_t>(radius)], 2);
        const Plane smooth = filtered(plane, weights, weights);
        for (std::size_t i = 0; i < sum.values.size(); ++i)
            sum.values[i] += static_cast<float>(share) * smooth.values[i];
        all += share;
    }
    for (float& value : sum.values) value /= static_cast<float>(all);
    return sum;
}

Planes seen(const Planes& planes, double pixels_per_degree) {
    return {seen(planes[0], {{1, 0.0047}}, pixels_per_degree), seen(planes[1], {{1, 0.0053}}, pixels_per_degree),
            seen(planes[2], {{34.1, 0.04}, {13.5, 0.025}}, pixels_per_degree)};
}

Triple lab_at(const Planes& planes, std::size_t i) {
    const Rgb c = rgb_of_ycxcz({planes[0].values[i], planes[1].values[i], planes[2].values[i]});
    return hunt_lab_of({shown(c.r, 1), shown(c.g, 1), shown(c.b, 1)});
}

double colour_error(const Triple& a, const Triple& b) {
    static const double largest = std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), colour_power);
    const double error = std::pow(hyab(a, b), colour_power), bend = knee * largest;
    if (error < bend) return value_at_knee / bend * error;
    return value_at_knee + (error - bend) / (largest - bend) * (1 - value_at_knee);
}

// Those above 0 add up to 1, those below to -1.
Weights balanced(Weights weights) {
    double above = 0, below = 0;
    for (const double weight : weights) (weight > 0 ? above : below) += std::abs(weight);
    for (double& weight : weights) weight /= weight > 0 ? above : below > 0 ? below : 1;
    return weights;
}

/// How much of an edge, or of a point, there is at each pixel.
struct Features {
    Plane edges, points;
};

Plane length(const Plane& x, Plane y) {
    for (std::size_t i = 0; i < y.values.size(); ++i) y.values[i] = std::hypot(x.values[i], y.values[i]);
    return y;
}

// First and second derivatives of a Gaussian, along x and along y.
Features features_of(Plane lightness, double pixels_per_degree) {
    for (float& value : lightness.values) value = (value + 16) / 116;
    const double deviation = 0.5 * feature_degrees * pixels_per_degree, variance = deviation * deviation;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const Weights smooth = gaussian(1 / (2 * variance), radius);
    Weights edge = smooth, point = smooth;
    for (int x = -radius; x <= radius; ++x) {
        edge[static_cast<std::size_t>(x + radius)] *= -x;
        point[static_cast<std::size_t>(x + radius)] *= x * x / variance - 1;
    }
    edge = balanced(edge), point = balanced(point);
    return {length(filtered(lightness, edge, smooth), filtered(lightness, smooth, edge)),
            length(filtered(lightness, point, smooth), filtered(lightness, smooth, point))};
}

double feature_error(const Features& a, const Features& b, std::size_t i) {
    const double edges = std::abs(a.edges.values[i] - b.edges.values[i]);
    const double points = std::abs(a.points.values[i] - b.points.values[i]);
    return std::min(1.0, std::pow(std::max(edges, points) / std::numbers::sqrt2, feature_power));
}

}  // namespace

Flip flip(std::uint32_t width, std::span<const Rgb> reference, std::span<const Rgb> picture, const FlipView& view) {
    Flip result;
    result.map.resize(picture.size());
    if (picture.empty()) return result;
    const auto scale = static_cast<float>(std::exp2(view.exposure));
    const auto a = planes_of(width, reference, scale), b = planes_of(width, picture, scale);
    const auto seen_a = seen(a, view.pixels_per_degree), seen_b = seen(b, view.pixels_per_degree);
    const auto features_a = features_of(a[0], view.pixels_per_degree);
    const auto features_b = features_of(b[0], view.pixels_per_degree);
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const double colour = colour_error(lab_at(seen_a, i), lab_at(seen_b, i));
        const double error = std::pow(colour, 1 - feature_error(features_a, features_b, i));
        result.map[i] = static_cast<float>(error);
        result.mean += error / static_cast<double>(picture.size());
    }
    return result;
}

}  // namespace lightnet
