// Single facets of the principled model: what they reflect and let through.
#include <algorithm>
#include <cmath>

#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/principled.hpp"

namespace lightnet {
namespace {

constexpr Rgb all_of(float value) { return {value, value, value}; }

}  // namespace

/// Glass knows Fresnel's own formula, as Schlick's has no total reflection; so its colour is a factor.
Rgb PrincipledBsdf::glass_tint() const {
    const float head_on = fresnel_dielectric(1, eta);
    if (!(head_on > 0)) return {};
    return {std::min(1.0f, f0.r / head_on), std::min(1.0f, f0.g / head_on), std::min(1.0f, f0.b / head_on)};
}

float PrincipledBsdf::glass_reflectance(float cosine) const { return fresnel_dielectric(cosine, eta); }

/// What reflects `bare` without the film, and below it as much head-on as `below`.
Rgb PrincipledBsdf::filmed(Rgb bare, Rgb below, float cosine) const {
    return bare * (1 - film.share) + film_reflectance(film, below, cosine) * film.share;
}

Rgb PrincipledBsdf::opaque_reflectance(float cosine) const {
    if (film.share == 0) return principled_mirror(base, metallic, f0, f90, plastic_share(), cosine);
    const float seen = std::fabs(cosine);
    return filmed(schlick(base, 1, seen), base, seen) * metallic +
           filmed(schlick(f0, f90, seen), f0, seen) * plastic_share();
}

/// Of glass with a film, or with an index for each colour.
Rgb PrincipledBsdf::glass_mirror(float cosine) const {
    const Rgb tint = glass_tint();
    const auto one = [&](float tinted, std::size_t colour) {
        const float glass = fresnel_dielectric(cosine, index(colour));
        return glass < 1 ? tinted * glass : 1;
    };
    const Rgb bare{one(tint.r, 0), one(tint.g, 1), one(tint.b, 2)};
    if (film.share == 0) return bare;
    // light that passes both ways is reflected alike on both
    const float outside2 = cosine < 0 ? 1 - eta * eta * (1 - cosine * cosine) : cosine * cosine;
    return outside2 > 0 ? filmed(bare, f0, std::sqrt(outside2)) : bare;
}

/// Of a facet seen at `cosine`, which is below 0 from inside a solid.
Rgb PrincipledBsdf::reflectance(float cosine) const {
    Rgb sum = opaque_reflectance(cosine);
    if (glass_share() > 0 && !plain_glass()) {
        sum += glass_mirror(cosine) * glass_share();
    } else if (glass_share() > 0) {
        const float glass = glass_reflectance(cosine);
        // what is reflected totally has nowhere else to go
        sum += (glass < 1 ? glass_tint() * glass : all_of(1)) * glass_share();
    }
    return sum;
}

float PrincipledBsdf::dispersed_transmittance(float cosine, std::size_t colour) const {
    const Rgb all = transmittance(cosine);
    return colour == 0 ? all.r : colour == 1 ? all.g : all.b;
}

Rgb PrincipledBsdf::transmittance(float cosine) const {
    if (!plain_glass()) {
        const auto left = [&](std::size_t colour) { return 1 - fresnel_dielectric(cosine, index(colour)); };
        const Rgb bare{left(0), left(1), left(2)};
        if (film.share == 0) return base * bare * glass_share();
        const float outside2 = cosine < 0 ? 1 - eta * eta * (1 - cosine * cosine) : cosine * cosine;
        if (!(outside2 > 0)) return {};
        return base * (all_of(1) - filmed(all_of(1) - bare, f0, std::sqrt(outside2))) * glass_share();
    }
    const float glass = glass_reflectance(cosine);
    return base * (glass_share() * (1 - glass));
}

/// With which probability a facet, once sampled, is taken for a mirror, not for a window.
float PrincipledBsdf::reflection_chance(float cosine) const {
    if (glass_share() == 0) return 1;
    const float r = max_component(reflectance(cosine)), t = max_component(transmittance(cosine));
    return r > 0 ? r / (r + t) : 0;
}

/// Of light on glass: what it reflects or lets through.
float PrincipledBsdf::window_share(float height) const {
    if (film.share > 0) return 1;
    const float glass = glass_reflectance(height);
    return glass < 1 ? (1 - glass) * max_component(base) + glass * max_component(glass_tint()) : 1;
}

}  // namespace lightnet
