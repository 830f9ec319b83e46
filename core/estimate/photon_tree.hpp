// Photons, found by where they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bsdf/bsdf.hpp"
#include "core/estimate/photon.hpp"
#include "core/light/query.hpp"
#include "core/scene/surface.hpp"

namespace lightnet {

/// A balanced kd-tree. Immutable; any thread may ask. Its order depends on the photons alone.
class PhotonTree {
public:
    /// `threads` of the caller's machine build it together.
    explicit PhotonTree(std::vector<Photon> photons, std::size_t threads = 1);
    explicit PhotonTree(std::span<const Photon> photons, std::size_t threads = 1)
        : PhotonTree(std::vector<Photon>(photons.begin(), photons.end()), threads) {}

    std::size_t size() const { return photons_.size(); }
    std::size_t memory() const { return photons_.size() * (sizeof(Photon) + sizeof(std::uint8_t)); }
    std::span<const Photon> photons() const { return photons_; }

    /// A photon that was found.
    struct Near {
        float distance2;  // m²; heights above the surface count four times
        std::uint32_t index;
    };
    /// Which photons are looked for: the nearest `most` within `radius` that lie on a surface turned like this one.
    struct Wanted {
        Vec3 position, normal;
        float radius;          // m
        std::size_t most = 0;  // 0: all of them
    };
    /// Writes them by distance, those of equal distance by what they are: what is found, and in which order, does not
    /// depend on photons farther away.
    void find(const Wanted& wanted, std::vector<Near>& found) const;

    /// Where, and for whom.
    struct Lookup {
        const SurfacePoint& point;
        const Bsdf& bsdf;
        Vec3 outgoing;
        std::uint8_t lobes;
    };
    /// Radiance that the surface scatters on of what the photons bring: their density under Epanechnikov's kernel,
    /// 2 (1 - d²/r²) / (π r²), whose radius r is the distance of the farthest of `most` photons, or `radius` where
    /// there are fewer. Without bias where light is even on a plane larger than that. `scratch` saves allocations.
    Rgb radiance(const Lookup& at, float radius, std::size_t most, std::vector<Near>& scratch) const;

private:
    class Search;
    bool comes_first(const Near& a, const Near& b) const;
    void build(std::size_t low, std::size_t high, std::size_t threads);

    std::vector<Photon> photons_;
    std::vector<std::uint8_t> axes_;
};

}  // namespace lightnet
