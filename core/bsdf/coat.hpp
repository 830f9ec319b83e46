// A clear dielectric coat: what is known of it before one knows what lies below.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/bsdf/ggx.hpp"

namespace lightnet {

/// How much light coats of one index reflect, by roughness and angle. Made once per material; any thread may ask.
class Coat {
public:
    /// Of one roughness.
    Coat(float eta, const Ggx& facets);
    /// Of any roughness (the same along both tangents), for those that change over a surface.
    explicit Coat(float eta);

    float eta() const { return eta_; }
    /// Share of light from direction `cosine` that the coat itself reflects.
    float reflectance(const Ggx& facets, float cosine) const;
    /// Share of diffuse light from below that the coat sends back down.
    float inner_reflectance(const Ggx& facets) const;

private:
    static constexpr std::size_t steps = 64;
    struct Row {
        std::array<float, steps + 1> by_cosine{};
        float inner = 0;
        float at(float cosine) const;
    };
    Row row_of(const Ggx& facets) const;
    /// Where among the rows a roughness lies: index of the lower one, and the share of the next.
    struct Between {
        std::size_t low;
        float share;
    };
    Between between(const Ggx& facets) const;

    float eta_;
    std::vector<Row> rows_;  // one, or by the square root of α
};

}  // namespace lightnet
