// Directional albedos of single lobes, from tables: what layered models share light by.
#pragma once

#include "core/base/math/vec.hpp"

namespace lightnet {

/// Of GGX facets with Schlick's Fresnel term: low × F0 + high × F90. Any thread may ask.
struct GgxAlbedo {
    float low = 0, high = 0;
    float operator()(float f0, float f90) const { return low * f0 + high * f90; }
};
/// For light from direction `cosine`; α as of Microfacets, up to 1; below the limit of smooth surfaces those of a
/// mirror.
GgxAlbedo ggx_albedo(float alpha, float cosine);
/// Its mean over diffuse light.
GgxAlbedo ggx_mean_albedo(float alpha);

/// The fibres of cloth, of which the more stand up the smaller α is: Estevez and Kulla 2017, "Production Friendly
/// Microfacet Sheen BRDF", with Neubelt and Pettineo's (2013) shadowing. f × cos incoming, sr⁻¹, not yet limited to 1
/// in all. Both directions lie above.
float sheen_value(float alpha, Vec3 outgoing, Vec3 incoming);
/// Its directional albedo; may exceed 1.
float sheen_albedo(float alpha, float cosine);
/// α is at least this.
inline constexpr float least_sheen_alpha = 0.01f;

}  // namespace lightnet
