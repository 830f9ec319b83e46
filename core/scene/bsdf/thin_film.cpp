#include "core/scene/bsdf/thin_film.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/math/exponential.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/principled.hpp"

namespace lightnet {
namespace {

/// cos x, for x of a size that makes sense.
float cosine_of(float x) {
    constexpr float high = 1.5703125f, low = 4.83826794896e-4f;  // π/2, in two parts
    const float quarters = std::floor(x * (2 * inverse_pi) + 0.5f);
    const auto [sine, cosine] = sine_cosine_near_zero(x - quarters * high - quarters * low);
    switch (static_cast<std::int64_t>(quarters) & 3) {
        case 0:
            return cosine;
        case 1:
            return -sine;
        case 2:
            return -cosine;
        default:
            return sine;
    }
}

/// A Gaussian of wave numbers, as seen through a way that is `path` metres longer.
struct Band {
    float weight, centre, variance;

    float seen(float path, float shift) const {
        const float phase = 2 * pi * path, damped = -phase * phase * variance;
        return damped < -80 ? 0 : weight * cosine_of(centre * phase + shift) * exponential(damped);
    }
};

/// The CIE's observer as four Gaussians, weighed so that a way of length 0 is as bright as no film.
Rgb seen(float path, Rgb shift) {
    constexpr Band x{0.84659f, 1.6810e6f, 4.3278e9f}, x_blue{0.15387f, 2.2399e6f, 4.5282e9f};
    constexpr Band y{1.00022f, 1.7953e6f, 9.3046e9f}, z{1.00111f, 2.2084e6f, 6.6121e9f};
    const float cie_x = x.seen(path, shift.r) + x_blue.seen(path, shift.r);
    const float cie_y = y.seen(path, shift.g), cie_z = z.seen(path, shift.b);
    return {3.2404542f * cie_x - 1.5371385f * cie_y - 0.4985314f * cie_z,
            -0.9692660f * cie_x + 1.8760108f * cie_y + 0.0415560f * cie_z,
            0.0556434f * cie_x - 0.2040259f * cie_y + 1.0572252f * cie_z};
}

float head_on(float eta, float outside) {
    const float root = (eta - outside) / (eta + outside);
    return root * root;
}

/// The index, seen from air, of what reflects that much head-on.
float eta_of(float reflectance) {
    const float root = std::sqrt(std::clamp(reflectance, 0.0f, 0.9999f));
    return (1 + root) / (1 - root);
}

/// One colour of what lies below the film.
struct Below {
    float reflected, shift;
};
Below below(float base, float eta, float cosine) {
    const float own = eta_of(base);
    return {schlick(head_on(own, eta), 1, cosine), own < eta ? pi : 0};
}

/// A film much thinner than light's waves is none.
float effective_eta(const ThinFilm& film) {
    const float t = std::clamp(film.thickness / 0.03f, 0.0f, 1.0f);
    return 1 + (film.eta - 1) * (t * t * (3 - 2 * t));
}

}  // namespace

Rgb film_reflectance(const ThinFilm& film, Rgb base, float cosine) {
    const float eta = effective_eta(film), c = std::clamp(cosine, 0.0f, 1.0f);
    const float within2 = 1 - (1 - c * c) / (eta * eta);
    if (within2 < 0) return {1, 1, 1};
    const float within = std::sqrt(within2), above = schlick(head_on(eta, 1), 1, c),
                through = (1 - above) * (1 - above);
    const float turned = eta < 1 ? 0 : pi;  // the wave, by the film's upper side from within
    const Below r = below(base.r, eta, within), g = below(base.g, eta, within), b = below(base.b, eta, within);
    const float path = 2 * eta * film.thickness * within * 1e-9f;
    const Rgb lower{r.reflected, g.reflected, b.reflected}, shift{turned + r.shift, turned + g.shift, turned + b.shift};
    const Rgb one_way{std::clamp(above * lower.r, 1e-5f, 0.9999f), std::clamp(above * lower.g, 1e-5f, 0.9999f),
                      std::clamp(above * lower.b, 1e-5f, 0.9999f)};
    const Rgb again{through * lower.r / (1 - one_way.r), through * lower.g / (1 - one_way.g),
                    through * lower.b / (1 - one_way.b)};
    const Rgb roots{std::sqrt(one_way.r), std::sqrt(one_way.g), std::sqrt(one_way.b)};
    Rgb sum = again + Rgb{above, above, above}, strength = again - Rgb{1 - above, 1 - above, 1 - above};
    for (const float order : {1.0f, 2.0f}) {
        strength = strength * roots;
        sum += strength * seen(order * path, shift * order) * 2;
    }
    return {std::clamp(sum.r, 0.0f, 1.0f), std::clamp(sum.g, 0.0f, 1.0f), std::clamp(sum.b, 0.0f, 1.0f)};
}

float film_ceiling(const ThinFilm& film, Rgb base) {
    constexpr int steps = 32;
    float most = 0;
    for (int i = 1; i <= steps; ++i) {
        const float root = float(i) / steps, cosine = root * root, rest = 1 - cosine,
                    grazing = rest * rest * rest * rest * rest;
        most = std::max(most, (max_component(film_reflectance(film, base, cosine)) - grazing) / (1 - grazing));
    }
    return std::min(1.0f, most + 0.005f);  // for what lies between the steps
}

}  // namespace lightnet
