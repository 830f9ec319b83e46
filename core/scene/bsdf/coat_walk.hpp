// A random walk of light between a coat and the metal below, one reflection after the other.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/math/samples.hpp"
#include "core/scene/bsdf/coat.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {

/// One walk between microfacets that scatter once, as in pbrt. The metal reflects everything; what the coat lets out
/// and what it sends down again are both followed, so that chance enters by the facets alone.
class CoatWalk {
public:
    CoatWalk(const Coat& coat, const Microfacets& above, const Microfacets& below, Samples samples)
        : coat_(coat), above_(above), below_(below), samples_(samples) {}

    /// Calls add(n, share): that share of the light leaves when it has met the metal n + 1 times. `outgoing` lies
    /// above.
    template <class Add>
    void go(Vec3 outgoing, Add add) {
        constexpr std::uint32_t longest = 32;
        const std::uint32_t bounces = coat_.layer().bounces, most = bounces ? std::min(bounces, longest) : longest;
        enter(outgoing);
        for (std::uint32_t n = 0; n < most && share_ > 1e-4f; ++n) {
            share_ *= left(-w_.z);
            meet_metal();
            if (!(share_ > 0)) return;
            share_ *= left(w_.z);
            add(n, leave());
        }
    }

private:
    Vec3 facet(const Microfacets& facets, Vec3 w) {
        const Vec2 u = samples_.next_2d();
        return smooth(facets) ? Vec3{0, 0, 1} : facets.sample_visible(w, u);
    }
    static bool smooth(const Microfacets& facets) { return is_specular(facets.alpha_u, facets.alpha_v); }
    static float seen(const Microfacets& facets, Vec3 from, Vec3 to) {
        return smooth(facets) ? 1 : facets.visible(from, to) / facets.visible(from);
    }
    float left(float cosine) const {
        const float thickness = coat_.layer().thickness;
        return thickness > 0 ? std::exp(-thickness / cosine) : 1;
    }

    void enter(Vec3 outgoing) {
        const Vec3 m = facet(above_, outgoing);
        w_ = refract(outgoing, m, coat_.eta()).direction;
        const float passed = 1 - fresnel_dielectric(dot(outgoing, m), coat_.eta());
        share_ = w_.z < 0 ? passed * seen(above_, outgoing, w_) : 0;
    }
    void meet_metal() {
        const Vec3 up = -w_, m = facet(below_, up);
        w_ = normalize(reflect(up, m));
        share_ = w_.z > 0 ? share_ * seen(below_, up, w_) : 0;
    }
    /// What leaves; the walk goes on with what is sent down again.
    float leave() {
        const Vec3 from = -w_, m = facet(above_, from), out = refract(from, m, coat_.eta()).direction;
        const float reflected = fresnel_dielectric(dot(from, m), coat_.eta());
        const float gone = out.z > 0 ? share_ * (1 - reflected) * seen(above_, from, out) : 0;
        w_ = normalize(reflect(from, m));
        share_ = w_.z < 0 ? share_ * reflected * seen(above_, from, w_) : 0;
        return gone;
    }

    const Coat& coat_;
    Microfacets above_, below_;
    Samples samples_;
    Vec3 w_;  // where the light goes
    float share_ = 0;
};

}  // namespace lightnet
