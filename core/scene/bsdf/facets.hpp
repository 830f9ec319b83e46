// Reflection and refraction by microfacets, without Fresnel's terms: what rough models share. Walter et al. 2007.
#pragma once

#include <cmath>
#include <optional>

#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/microfacets.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// What microfacets send from `incoming` to `outgoing`, were they perfect mirrors or perfect windows.
struct Facets {
    float value = 0;   // f × |cos incoming|, sr⁻¹; 0: no facet does
    float pdf = 0;     // of `incoming`, by visible normals, per steradian
    float cosine = 0;  // between outgoing and the facet's normal; below 0 from behind the surface
};

/// Both directions lie above the surface.
template <class Law>
[[gnu::always_inline]] inline Facets reflection(const FacetsOf<Law>& facets, Vec3 outgoing, Vec3 incoming) {
    const Vec3 m = normalize(outgoing + incoming);
    const float cosine = dot(outgoing, m);
    const float both = facets.density(m) / (4 * outgoing.z);
    const float lambda_o = facets.lambda(outgoing), lambda_i = facets.lambda(incoming);
    const float value = both * facets.visible_to_both(lambda_o, lambda_i), pdf = both / (1 + lambda_o);
    const bool seen = cosine > 0;
    return {seen ? value : 0, seen ? pdf : 0, seen ? cosine : 0};
}
inline Facets reflection(const Microfacets& facets, Vec3 outgoing, Vec3 incoming) {
    return facets.as_they_are([&](const auto& f) { return reflection(f, outgoing, incoming); });
}

/// Where facets that are seen from `outgoing` reflect it to.
template <class Law>
[[gnu::always_inline]] inline Vec3 reflected_by(const FacetsOf<Law>& facets, Vec3 outgoing, Vec2 u) {
    return normalize(reflect(outgoing, facets.sample_visible(outgoing, u)));
}

/// The directions lie on different sides; `eta` inside over outside. The value holds the squeezing of radiance.
inline Facets refraction(const Microfacets& facets, Vec3 outgoing, Vec3 incoming, float eta) {
    const float relative = outgoing.z > 0 ? eta : 1 / eta;
    Vec3 m = incoming * relative + outgoing;
    if (length_squared(m) == 0) return {};
    m = normalize(m);
    if (m.z < 0) m = -m;
    const float o_m = dot(outgoing, m), i_m = dot(incoming, m);
    if (o_m * outgoing.z <= 0 || i_m * incoming.z <= 0) return {};  // the facet is seen from behind
    const float root = i_m + o_m / relative;
    const float both = facets.density(m) * std::fabs(i_m * o_m / (root * root * outgoing.z));
    return {both * facets.visible(outgoing, incoming) / (relative * relative), both * facets.visible(outgoing), o_m};
}

/// The way that light comes by a facet with normal `m`, which reflects it or lets it through: bent by `eta` (inside
/// over outside) into a solid, mirrored to the other side by a sheet. Its weight is still to be found. None: there is
/// none.
inline std::optional<BsdfSample> way_by_facet(Vec3 outgoing, Vec3 m, bool transmitted, bool thin, float eta) {
    BsdfSample result;
    result.lobe = lobe::glossy;
    result.transmitted = transmitted;
    if (transmitted && !thin) {
        const Refracted bent = refract(outgoing, m, eta);
        if (!bent.possible) return {};
        result.incoming = normalize(bent.direction);
        result.eta = bent.eta;
    } else {
        result.incoming = normalize(reflect(outgoing, m));
        if (transmitted) result.incoming.z = -result.incoming.z;
    }
    if ((result.incoming.z * outgoing.z < 0) != transmitted) return {};
    return result;
}

}  // namespace lightnet
