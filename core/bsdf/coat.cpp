#include "core/bsdf/coat.hpp"

#include <algorithm>
#include <cmath>

#include "core/bsdf/fresnel.hpp"
#include "core/bsdf/scattering.hpp"

namespace lightnet {
namespace {

constexpr std::size_t roughnesses = 12;

/// Directional albedo of rough reflection, by a fixed grid over the visible normals.
float rough_reflectance(const Ggx& facets, float eta, float cosine, int grid) {
    const Vec3 w{std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine};
    double sum = 0;
    for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
            const Vec2 u{(float(i) + 0.5f) / float(grid), (float(j) + 0.5f) / float(grid)};
            const Vec3 m = facets.sample_visible(w, u), out = reflect(w, m);
            if (out.z <= 0) continue;
            sum += fresnel_dielectric(dot(w, m), eta) * facets.visible(w, out) / facets.visible(w);
        }
    return float(sum / (grid * grid));
}

/// What absorption leaves of diffuse light on its way from the base to a smooth coat, where it is reflected, and back.
/// That of rough coats differs little.
float left_of_reflected(float eta, float thickness) {
    constexpr int strips = 1024;
    double all = 0, left = 0;
    for (int i = 0; i < strips; ++i) {
        const float cosine = (float(i) + 0.5f) / strips;
        const double share = cosine * fresnel_dielectric(-cosine, eta);
        all += share;
        left += share * std::exp(-2 * thickness / cosine);
    }
    return float(left / all);
}

}  // namespace

Coat::Coat(float eta, const Ggx& facets, Layer layer) : eta_(eta), layer_(layer), rows_{row_of(facets)} {}

Coat::Coat(float eta, Layer layer) : eta_(eta), layer_(layer) {
    for (std::size_t i = 0; i < roughnesses; ++i) {
        const float root = float(i) / (roughnesses - 1), alpha = root * root;
        rows_.push_back(row_of({alpha, alpha}));
    }
}

Coat::Row Coat::row_of(const Ggx& facets) const {
    const bool smooth = is_specular(facets.alpha_u, facets.alpha_v);
    Row row;
    for (std::size_t i = 0; i <= steps; ++i) {
        const float cosine = std::max(1e-3f, float(i) / steps);
        row.by_cosine[i] = smooth ? fresnel_dielectric(cosine, eta_) : rough_reflectance(facets, eta_, cosine, 48);
    }
    constexpr int strips = 1024;
    double outer = 0;  // share of diffuse light from outside that is reflected
    for (int i = 0; i < strips; ++i) {
        const float cosine = (float(i) + 0.5f) / strips;
        outer += 2 * cosine * (smooth ? fresnel_dielectric(cosine, eta_) : row.at(cosine)) / strips;
    }
    row.inner = float(1 - (1 - outer) / (double{eta_} * eta_));  // radiance squeezed into a smaller cone below
    if (layer_.thickness > 0) row.inner *= left_of_reflected(eta_, layer_.thickness);
    return row;
}

float Coat::Row::at(float cosine) const {
    const float at = std::clamp(cosine, 0.0f, 1.0f) * steps;
    const auto low = std::min(static_cast<std::size_t>(at), steps - 1);
    const float share = at - float(low);
    return by_cosine[low] * (1 - share) + by_cosine[low + 1] * share;
}

Coat::Between Coat::between(const Ggx& facets) const {
    if (rows_.size() == 1) return {0, 0};
    const float root = std::sqrt(std::sqrt(facets.alpha_u * facets.alpha_v));
    const float at = std::min(root, 1.0f) * float(rows_.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), rows_.size() - 2);
    return {low, at - float(low)};
}

float Coat::reflectance(const Ggx& facets, float cosine) const {
    if (is_specular(facets.alpha_u, facets.alpha_v)) return fresnel_dielectric(cosine, eta_);
    const auto [low, share] = between(facets);
    const float first = rows_[low].at(cosine);
    return share == 0 ? first : first * (1 - share) + rows_[low + 1].at(cosine) * share;
}

float Coat::left_within(float cosine) const {
    if (layer_.thickness == 0) return 1;
    const float inside2 = 1 - (1 - cosine * cosine) / (eta_ * eta_);
    return inside2 > 0 ? std::exp(-layer_.thickness / std::sqrt(inside2)) : 0;
}

float Coat::series(float reflectance, float back) const {
    const float sum = reflectance / (1 - back);
    return layer_.bounces ? sum * (1 - std::pow(back, float(layer_.bounces))) : sum;
}

float Coat::inner_reflectance(const Ggx& facets) const {
    const auto [low, share] = between(facets);
    return share == 0 ? rows_[low].inner : rows_[low].inner * (1 - share) + rows_[low + 1].inner * share;
}

}  // namespace lightnet
