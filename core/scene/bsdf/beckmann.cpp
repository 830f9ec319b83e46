#include "core/scene/bsdf/beckmann.hpp"

#include <algorithm>

namespace lightnet {
namespace {

// x with erf(x) = y. Giles 2012, "Approximating the erfinv Function", single precision.
float inverse_erf(float y) {
    const auto polynomial = [](float at, const auto& factors) {
        float sum = 0;
        for (const float factor : factors) sum = sum * at + factor;
        return sum;
    };
    constexpr float middle[]{2.81022636e-08f, 3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f, 0.00021858087f,
                             -0.00125372503f, -0.00417768164f, 0.246640727f,    1.50140941f};
    constexpr float tails[]{-0.000200214257f, 0.000100950558f, 0.00134934322f, -0.00367342844f, 0.00573950773f,
                            -0.0076224613f,   0.00943887047f,  1.00167406f,    2.83297682f};
    const float w = -std::log((1 - y) * (1 + y));
    return y * (w < 5 ? polynomial(w - 2.5f, middle) : polynomial(std::sqrt(w) - 3, tails));
}

constexpr float least = 1e-6f;  // of what is inverted: erf's range is open

// The slope, along a direction that is inclined by `tangent`, of a facet that it sees.
float visible_slope(float tangent, float u) {
    constexpr float inverse_root_pi = 0.5641895835f;
    // Up to erf(x) = s lie 1 + s + tangent e^(-x²)/√π of all, divided by what lies up to x = 1/tangent, where facets
    // turn away.
    const auto up_to = [&](float s, float x) { return 1 + s + tangent * inverse_root_pi * std::exp(-x * x); };
    const float cotangent = 1 / std::max(tangent, 1e-7f);
    float low = -1, high = std::erf(cotangent);
    const float wanted = std::max(u, least) * up_to(high, cotangent);
    float s = low + (high - low) * u;
    for (int step = 0; step < 24; ++step) {
        if (!(s > low && s < high)) s = 0.5f * (low + high);
        const float x = inverse_erf(s), miss = up_to(s, x) - wanted;
        if (std::fabs(miss) < 1e-6f) break;
        (miss > 0 ? high : low) = s;
        s -= miss / (1 - x * tangent);
    }
    return inverse_erf(std::clamp(s, least - 1, 1 - least));
}

}  // namespace

Vec3 BeckmannLaw::sample_visible(Vec3 w, Vec2 u) {
    const float across = std::sqrt(w.x * w.x + w.y * w.y);
    const Vec2 along = across > 1e-4f ? Vec2{w.x / across, w.y / across} : Vec2{1, 0};
    const float x = visible_slope(across / std::max(w.z, 1e-6f), u.x);
    const float y = inverse_erf(std::clamp(2 * u.y - 1, least - 1, 1 - least));
    return {-(along.x * x - along.y * y), -(along.y * x + along.x * y), 1};
}

}  // namespace lightnet
