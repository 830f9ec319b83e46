// Light that comes back out of a coat over metal, by how often it met the metal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/scene/bsdf/coat.hpp"

namespace lightnet {

/// What a coat returns of light that met the metal below once, twice, or more often, were the metal a perfect mirror of
/// its facets: found by walks between the layers, and shared by pairs of directions so that it is reciprocal and each
/// direction's sum is that of its walks. Made once per material; any thread may ask.
class CoatedMetal {
public:
    /// Keeps looking at `coat`.
    CoatedMetal(const Coat& coat, const FacetRange& above, const FacetRange& below);

    static constexpr std::size_t orders = 4;  // met once, twice, thrice, and more often
    /// Of one direction.
    struct Returned {
        std::array<float, orders> energy{};  // share of the light from there; of the last order its first member's
        std::array<float, orders> factor{};  // of the lobe that the metal has through the coat
        float again = 0;                     // a member of the last order over the one before

        /// All orders of a metal of that reflectance, by pairs of directions and over all of them.
        float factor_with(const Returned& other, float reflectance) const;
        float albedo(float reflectance) const;
    };
    /// Of light from direction `cosine` above the coat.
    Returned returned(const Microfacets& above, const Microfacets& below, float cosine) const;

private:
    static constexpr std::size_t steps = 24;
    using ByCosine = std::array<Returned, steps + 1>;
    using Kernel = std::array<std::array<float, steps + 1>, steps + 1>;
    struct Between {
        std::size_t low;
        float share;  // of the next
    };
    static float node(std::size_t step);
    static Between between(float cosine);
    ByCosine made(const Microfacets& above, const Microfacets& below, std::uint32_t walks) const;
    void walk(const Microfacets& above, const Microfacets& below, std::uint32_t walks, ByCosine& result) const;
    Kernel lobe(const Microfacets& above, const Microfacets& below, std::uint32_t samples) const;

    const Coat& coat_;
    std::size_t rows_, columns_;  // by roughness above and below
    std::vector<ByCosine> tables_;
};

/// The metal's facets, as they look through those of a coat.
Microfacets seen_through(const Microfacets& metal, const Microfacets& coat, float eta);
/// The direction within a smooth coat that belongs to one above it (both upwards), and the way back: none where all is
/// reflected.
Vec3 into_coat(Vec3 w, float eta);
std::optional<Vec3> out_of_coat(Vec3 w, float eta);

}  // namespace lightnet
