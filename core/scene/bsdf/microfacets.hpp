// The microfacets of a rough surface: how their normals lie, and which of them are seen. All directions are local: the
// surface's normal is +z.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/math/sampling.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bsdf/beckmann.hpp"
#include "core/scene/bsdf/ggx.hpp"

namespace lightnet {

/// The law that the facets' normals follow, and how what hides a facet from one direction has to do with what hides it
/// from another: by its height (pbrt), or not at all (Mitsuba).
struct FacetLaw {
    enum class Normals : std::uint8_t { ggx, beckmann } normals = Normals::ggx;
    enum class Masking : std::uint8_t { by_height, independent } masking = Masking::by_height;
    friend bool operator==(const FacetLaw&, const FacetLaw&) = default;

    /// use(GgxLaw) or use(BeckmannLaw).
    template <class Use>
    auto with_normals(Use use) const {
        return normals == Normals::ggx ? use(GgxLaw{}) : use(BeckmannLaw{});
    }
};

/// Facets of one law (GgxLaw, BeckmannLaw), by roughness along both tangents. Walter et al. 2007 and Heitz 2014.
/// Without a branch where the law has none, so that loops over many surfaces become vectors.
template <class Law>
struct FacetsOf {
    float alpha_u = 0, alpha_v = 0;
    std::uint32_t by_height = true;  // FacetLaw::Masking

    /// Density of normals `m`, per steradian.
    [[gnu::always_inline]] float density(Vec3 m) const {
        const float x = m.x / alpha_u, y = m.y / alpha_v;
        return Law::density(x * x + y * y, m.z * m.z) / (alpha_u * alpha_v);
    }
    /// Smith's Λ: 1/(1 + Λ) of the microfacets facing `w` are visible from it.
    [[gnu::always_inline]] float lambda(Vec3 w) const {
        const float x = alpha_u * w.x, y = alpha_v * w.y, z2 = w.z * w.z;
        const float found = Law::lambda(x * x + y * y, z2);
        return z2 == 0 ? 1e18f : found;
    }
    /// Seen from both directions, whose Λ are these (Heitz 2014, eq. 98 and 99).
    float visible_to_both(float a, float b) const {
        const float correlated = 1 + a + b, apart = (1 + a) * (1 + b);
        return 1 / (by_height ? correlated : apart);
    }
    /// A visible normal.
    [[gnu::always_inline]] Vec3 sample_visible(Vec3 w, Vec2 u) const {
        Vec3 stretched = normalize({alpha_u * w.x, alpha_v * w.y, w.z});
        const float side = stretched.z < 0 ? -1.0f : 1.0f;
        stretched = stretched * side;
        const Vec3 n = Law::sample_visible(stretched, u);
        return normalize({alpha_u * n.x, alpha_v * n.y, n.z > 1e-6f ? n.z : 1e-6f});
    }
};

/// Of any law; anisotropic. A value.
struct Microfacets {
    float alpha_u = 0, alpha_v = 0;
    FacetLaw law{};

    /// These, which follow that law.
    template <class Law>
    FacetsOf<Law> of() const {
        return {alpha_u, alpha_v, law.masking == FacetLaw::Masking::by_height};
    }
    /// use(FacetsOf<GgxLaw>) or use(FacetsOf<BeckmannLaw>): these.
    template <class Use>
    auto as_they_are(Use use) const {
        return law.with_normals([&]<class Law>(Law) { return use(of<Law>()); });
    }
    float lambda(Vec3 w) const {
        return as_they_are([&](const auto& facets) { return facets.lambda(w); });
    }
    float visible(Vec3 w) const { return 1 / (1 + lambda(w)); }
    float visible(Vec3 a, Vec3 b) const {
        return as_they_are([&](const auto& f) { return f.visible_to_both(f.lambda(a), f.lambda(b)); });
    }
    float density(Vec3 m) const {
        return as_they_are([&](const auto& facets) { return facets.density(m); });
    }
    Vec3 sample_visible(Vec3 w, Vec2 u) const {
        return as_they_are([&](const auto& facets) { return facets.sample_visible(w, u); });
    }
};

}  // namespace lightnet
