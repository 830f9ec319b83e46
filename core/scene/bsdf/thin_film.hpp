// A film about as thin as light's waves are long: the colours of soap bubbles, oil and tempered steel.
#pragma once

#include "core/base/math/rgb.hpp"

namespace lightnet {

struct ThinFilm {
    float share = 0;        // of the surface that it covers
    float eta = 1.3f;       // its index
    float thickness = 400;  // nanometres
    friend bool operator==(const ThinFilm&, const ThinFilm&) = default;
};

/// What a film in air reflects together with what lies below it, which without it would reflect `base` head-on; of
/// light from `cosine` to the normal, 0 … 1. The way of Belcour and Barla 2017, "A Practical Extension to Microfacet
/// Theory for the Modeling of Varying Iridescence", with Schlick's terms for both interfaces, as glTF has it. In RGB,
/// so an approximation; without libm's functions, so the same everywhere.
Rgb film_reflectance(const ThinFilm& film, Rgb base, float cosine);

/// The least F0 with which Schlick's term up to 1 is nowhere below film_reflectance(). What lies below films may have
/// the rest of the light.
float film_ceiling(const ThinFilm& film, Rgb base);

}  // namespace lightnet
