#include "core/scene/bsdf/coat.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math/samples.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/scattering.hpp"

namespace lightnet {
namespace {

constexpr std::size_t roughnesses = 12;

/// Calls add(w, facet, weight) for facets that directions `w` of that cosine see, as often as they do. Where the
/// surface isn't alike all around its normal, neither are the directions. The weights sum up to 1.
template <class Add>
void over_visible(const Microfacets& facets, float cosine, std::uint32_t count, Key key, Add add) {
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const bool grooved = facets.alpha_u != facets.alpha_v;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(key, i);
        const Vec2 u = samples.next_2d();
        const float turn = grooved ? 2 * pi * samples.next() : 0;
        const Vec3 w{sine * std::cos(turn), sine * std::sin(turn), cosine};
        add(w, facets.sample_visible(w, u), 1 / float(count));
    }
}

float left_of(float thickness, float cosine) { return thickness > 0 ? std::exp(-thickness / cosine) : 1; }

/// What single scattering by the facets makes of light from outside: reflected, and let in as far as the base.
struct Outer {
    float reflected, passed;
};
Outer outer_of(const Microfacets& facets, float eta, float thickness, float cosine, Key key) {
    double reflected = 0, passed = 0;
    over_visible(facets, cosine, 1024, key, [&](Vec3 w, Vec3 m, float weight) {
        const float fresnel = fresnel_dielectric(dot(w, m), eta), seen = facets.visible(w);
        const Vec3 up = reflect(w, m), down = refract(w, m, eta).direction;
        if (up.z > 0) reflected += weight * fresnel * facets.visible(w, up) / seen;
        if (down.z < 0) passed += weight * (1 - fresnel) * facets.visible(w, down) / seen * left_of(thickness, -down.z);
    });
    return {float(reflected), float(passed)};
}

/// What the facets send back of light from within, from the base and to the base again.
float inner_of(const Microfacets& facets, float eta, float thickness, float cosine, Key key) {
    double back = 0;
    over_visible(facets, cosine, 512, key, [&](Vec3 w, Vec3 m, float weight) {
        const Vec3 out = reflect(w, m);
        if (out.z > 0)
            back += weight * fresnel_dielectric(-dot(w, m), eta) * facets.visible(w, out) / facets.visible(w) *
                    left_of(thickness, out.z);
    });
    return float(back) * left_of(thickness, cosine);
}

}  // namespace

Coat::Coat(float eta, const FacetRange& facets, CoatLayer layer) : eta_(eta), layer_(layer) {
    if (!facets.varies) {
        rows_.push_back(row_of(facets.facets));
        return;
    }
    for (std::size_t i = 0; i < roughnesses; ++i) {
        const float root = float(i) / (roughnesses - 1), alpha = root * root;
        rows_.push_back(row_of({alpha, alpha, facets.facets.law}));
    }
}

Coat::Row Coat::row_of(const Microfacets& facets) const {
    const bool smooth = is_specular(facets.alpha_u, facets.alpha_v);
    Row row;
    for (std::size_t i = 0; i <= steps; ++i) {
        const float cosine = std::max(1e-3f, float(i) / steps);
        const float mirrored = fresnel_dielectric(cosine, eta_);
        const auto [reflected, passed] = smooth ? Outer{mirrored, (1 - mirrored) * left_within(cosine)}
                                                : outer_of(facets, eta_, layer_.thickness, cosine, i);
        row.reflected[i] = reflected;
        row.passed[i] = passed;
    }
    const int strips = smooth ? 1024 : 48;
    double inner = 0;
    for (int i = 0; i < strips; ++i) {
        const float cosine = (float(i) + 0.5f) / float(strips);
        inner += 2 * cosine / float(strips) *
                 (smooth ? fresnel_dielectric(-cosine, eta_) * left_of(2 * layer_.thickness, cosine)
                         : inner_of(facets, eta_, layer_.thickness, cosine, Key(i)));
    }
    row.inner = float(inner);
    return row;
}

float Coat::at(const std::array<float, steps + 1>& by_cosine, float cosine) {
    const float at = std::clamp(cosine, 0.0f, 1.0f) * steps;
    const auto low = std::min(static_cast<std::size_t>(at), steps - 1);
    const float share = at - float(low);
    return by_cosine[low] * (1 - share) + by_cosine[low + 1] * share;
}

Coat::Between Coat::between(const Microfacets& facets) const {
    if (rows_.size() == 1) return {0, 0};
    const float root = std::sqrt(std::sqrt(facets.alpha_u * facets.alpha_v));
    const float at = std::min(root, 1.0f) * float(rows_.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), rows_.size() - 2);
    return {low, at - float(low)};
}

float Coat::of_rows(const Microfacets& facets, float cosine, std::array<float, steps + 1> Row::*values) const {
    const auto [low, share] = between(facets);
    const float first = at(rows_[low].*values, cosine);
    return share == 0 ? first : first * (1 - share) + at(rows_[low + 1].*values, cosine) * share;
}

float Coat::reflectance(const Microfacets& facets, float cosine) const {
    if (is_specular(facets.alpha_u, facets.alpha_v)) return fresnel_dielectric(cosine, eta_);
    return of_rows(facets, cosine, &Row::reflected);
}

float Coat::transmittance(const Microfacets& facets, float cosine) const {
    if (is_specular(facets.alpha_u, facets.alpha_v))
        return (1 - fresnel_dielectric(cosine, eta_)) * left_within(cosine);
    return of_rows(facets, cosine, &Row::passed);
}

float Coat::left_within(float cosine) const {
    if (layer_.thickness == 0) return 1;
    const float inside2 = 1 - (1 - cosine * cosine) / (eta_ * eta_);
    return inside2 > 0 ? std::exp(-layer_.thickness / std::sqrt(inside2)) : 0;
}

float Coat::series(float reflectance, float back) const {
    const float sum = reflectance / (1 - back);
    if (!layer_.bounces) return sum;
    float lost = 1, power = back;  // back to the power of `bounces`, the same on every libm
    for (std::uint32_t left = layer_.bounces; left > 0; left /= 2) {
        if (left % 2) lost *= power;
        power *= power;
    }
    return sum * (1 - lost);
}

float Coat::inner_reflectance(const Microfacets& facets) const {
    const auto [low, share] = between(facets);
    return share == 0 ? rows_[low].inner : rows_[low].inner * (1 - share) + rows_[low + 1].inner * share;
}

}  // namespace lightnet
