// A clear dielectric coat: what is known of it before one knows what lies below.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scene/bsdf/roughness.hpp"
#include "core/scene/textures/members.hpp"

namespace lightnet {

/// What becomes of light within a coat. Clear and complete, if nothing else is said.
struct CoatLayer {
    float thickness = 0;        // of light straight through, exp(-thickness) is left
    std::uint32_t bounces = 0;  // off the base: of light that meets it more often nothing is left; 0: all counts
};
void visit_members(Is<CoatLayer> auto& layer, const auto& visit) {
    auto& [thickness, bounces] = layer;
    visit(thickness, bounces);
}

/// How much light coats of one index reflect and let pass, by roughness and angle, over all directions to which they
/// do. Rough ones scatter once, as in pbrt: what would meet their facets a second time is lost. Made once per material;
/// any thread may ask.
class Coat {
public:
    Coat(float eta, const FacetRange& facets, CoatLayer layer = {});

    float eta() const { return eta_; }
    const CoatLayer& layer() const { return layer_; }
    /// Share of light from direction `cosine` that the coat itself reflects.
    float reflectance(const Microfacets& facets, float cosine) const;
    /// Share of light from direction `cosine` that reaches the base; also of diffuse light from the base that leaves
    /// into that direction, where radiance shrinks by η².
    float transmittance(const Microfacets& facets, float cosine) const;
    /// Share of diffuse light from the base that the coat sends back, and that reaches the base again.
    float inner_reflectance(const Microfacets& facets) const;
    /// Share of light that is left on the way from a smooth coat's surface to the base; `cosine` above the coat.
    float left_within(float cosine) const;
    /// All ways off a base of that reflectance, of which the coat sends `back` that share each time.
    float series(float reflectance, float back) const;

private:
    static constexpr std::size_t steps = 64;
    struct Row {
        std::array<float, steps + 1> reflected{}, passed{};  // by cosine
        float inner = 0;
    };
    static float at(const std::array<float, steps + 1>& by_cosine, float cosine);
    float of_rows(const Microfacets& facets, float cosine, std::array<float, steps + 1> Row::*values) const;
    Row row_of(const Microfacets& facets) const;
    /// Where among the rows a roughness lies: index of the lower one, and the share of the next.
    struct Between {
        std::size_t low;
        float share;
    };
    Between between(const Microfacets& facets) const;

    float eta_;
    CoatLayer layer_;
    std::vector<Row> rows_;  // one, or by the square root of α
};

}  // namespace lightnet
