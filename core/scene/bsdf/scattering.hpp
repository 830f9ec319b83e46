// Types that the models of scattering share.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/base/query.hpp"

namespace lightnet {

/// A sampled direction of incoming light.
struct BsdfSample {
    Vec3 incoming;          // unit, world space, away from the surface
    Rgb weight;             // f × |cos| / pdf
    float pdf = 0;          // per steradian, over all lobes asked for; meaningless for a specular lobe
    std::uint8_t lobe = 0;  // the one that was sampled: one of lobe::diffuse, glossy, specular
    bool transmitted = false;
    float eta = 1;  // of a refraction: index on the incoming side over the one on the outgoing side
};

/// What a BSDF says of a pair of directions.
struct BsdfValue {
    Rgb value;      // f × |cos incoming|, sr⁻¹
    float pdf = 0;  // per steradian
};

/// A sampled direction with the weight and the density that `of` gives it; none: it is never sampled.
inline std::optional<BsdfSample> weighed(BsdfSample found, const BsdfValue& of) {
    if (!(of.pdf > 0)) return {};
    found.weight = of.value / of.pdf;
    found.pdf = of.pdf;
    return found;
}

/// The numbers in [begin, end) are those for which sample() goes by the cosine, on the viewer's side.
struct CosineChoices {
    float begin = 0, end = 0;

    float chance() const { return end - begin; }
    bool contain(float choice) const { return choice >= begin && choice < end; }
};

/// A GGX roughness below this is taken for a perfect mirror. One threshold for renderer, light operators and checks.
inline constexpr float specular_alpha = 1e-3f;

inline bool is_specular(float alpha_u, float alpha_v) { return alpha_u < specular_alpha && alpha_v < specular_alpha; }

// Each model is a value that has lobes(), evaluate() and sample() as Bsdf has, in local coordinates: the shading normal
// is +z. For models whose `two_sided` is true, outgoing.z > 0 always, and both sides of the surface look alike. Models
// whose `chooses` is false have one lobe, and sample() does not look at its `choice`. Those with a diffuse lobe may say
// by cosine_choices(height of outgoing, lobes) for which choices they sample it.

}  // namespace lightnet
