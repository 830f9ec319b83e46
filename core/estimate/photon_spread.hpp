// The part of a photon's disc that lies on surfaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/math/random.hpp"
#include "core/estimate/photon_tree.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// An estimate of density divides by the area of whole discs, though a part of them lies off the surface: at edges and
/// corners, on slats, in gaps, and below what stands on a floor. There it finds too little light. So each photon brings
/// what is lost of its disc as well: its light is spread over the surface that there is, and none gets lost. After the
/// boundary kernels of density estimation: Jones 1993, "Simple boundary correction for kernel density estimation"; here
/// by the photon, whose light is all given away. As discs shrink, it changes less and less.
///
/// What is told of a photon depends on it and on the key alone. Any thread may ask.
class PhotonSpread {
public:
    /// Discs in which there will be `gather` photons, and no larger than `most` (m), when `times` as many are sent as
    /// for the `pilot`. `gather` 0: as large as that.
    PhotonSpread(const Scene& scene, std::shared_ptr<const PhotonTree> pilot, std::size_t gather, double times,
                 float most);

    /// Discs that are all of this radius (m).
    PhotonSpread(const Scene& scene, float radius) : PhotonSpread(scene, nullptr, 0, 1, radius) {}

    /// Multiplies their light by 1 / the part of their discs that is surface, as it is seen from a little above them:
    /// by the number of tries until a point of the disc is on it, which is the same on average. Where little of a disc
    /// is surface, or a low ceiling hides it, that is bounded: single photons would make spots.
    void spread(std::span<Photon> photons, Key key) const;

    /// Sums of light, of all photons and of those of whom one try missed the surface.
    struct Missed {
        double missed = 0, all = 0;
    };
    Missed missed(std::span<const Photon> photons, Key key) const;

private:
    struct Disc;
    struct Try;
    template <class Landed>
    void try_all(std::span<const Photon> photons, Key key, std::uint32_t tries, const Landed& landed) const;
    std::vector<Disc> discs_of(std::span<const Photon> photons) const;
    float radius_of(const Photon& photon, Nearest& scratch) const;
    void look_behind(std::span<const Disc> discs, std::span<Try> tries) const;
    bool lands(const Disc& disc, const std::optional<Hit>& hit) const;

    const Scene& scene_;
    std::shared_ptr<const PhotonTree> pilot_;
    float
        scale_;  // of squares of radii: from discs of the pilot to those that are meant; 0: all are as large as `most`
    float most_;
};

}  // namespace lightnet
