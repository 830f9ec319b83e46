// Photons, found by where they are.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/columns.hpp"
#include "core/base/query.hpp"
#include "core/estimate/nearest.hpp"
#include "core/estimate/photon.hpp"
#include "core/network/light/builders.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

/// A balanced tree of bounding boxes, as wide as the processor compares at once. Immutable; any thread may ask. Its
/// order depends on the photons alone.
class PhotonTree {
public:
    using Photons = std::vector<Photon, InLines<Photon>>;

    PhotonTree(Photons photons, Builders& builders);
    ~PhotonTree();
    PhotonTree(PhotonTree&&) noexcept;
    PhotonTree(std::span<const Photon> photons, Builders& builders)
        : PhotonTree(Photons(photons.begin(), photons.end()), builders) {}
    explicit PhotonTree(std::span<const Photon> photons, OneBuilder alone = {})
        : PhotonTree(photons, static_cast<Builders&>(alone)) {}

    /// How far a photon lies away for a point of a surface, squared, as a search counts it: heights above the surface
    /// four times. And whether it lies on a surface that is taken for the same one, by the cosine between both.
    static float distance2(Vec3 offset, Vec3 normal) {
        const float height = dot(offset, normal);
        return length_squared(offset) + height_counts * height * height;
    }
    /// How high above the surface a photon is found, as a part of how far along it.
    static constexpr float flatness = 0.25f;
    static bool turned_alike(float cosine) { return std::fabs(cosine) >= least_cosine; }

    /// What `photons` may need beyond their number so that they need not be copied.
    static constexpr std::size_t room = Nearest::width;

    std::size_t size() const { return size_; }
    Photon operator[](std::size_t i) const;

    /// Which photons are looked for: the nearest `most` within `radius` that lie on a surface turned like this one.
    struct Wanted {
        Vec3 position, normal;
        float radius;          // m
        std::size_t most = 0;  // 0: all of them
        PhotonWindow when = {};
    };
    /// Those, by distance (heights above the surface count four times), those of equal distance by what they are: what
    /// is found, and in which order, does not depend on photons farther away. It lies in `scratch`.
    std::span<const Nearest::Item> find(const Wanted& wanted, Nearest& scratch) const;

    /// Where, and for whom.
    struct Lookup {
        const SurfacePoint& point;
        const Bsdf& bsdf;
        Vec3 outgoing;
        std::uint8_t lobes;
        PhotonWindow when = {};
    };
    /// Radiance that the surface scatters on of what the photons bring: their density under Epanechnikov's kernel,
    /// 2 (1 - d²/r²) / (π r²), whose radius r is the distance of the farthest of `most` photons, or `radius` where
    /// there are fewer; of those of a part of the shutter's time, over that part. Without bias where light is even on a
    /// plane larger than that.
    Rgb radiance(const Lookup& at, float radius, std::size_t most, Nearest& scratch) const;
    /// Radiance of each group of lamps, as radiance() estimates that of their sum, of the photons that are nearest of
    /// all. All groups that photons have must have a place; `to` comes zeroed.
    void radiance(const Lookup& at, float radius, std::size_t most, Nearest& scratch, std::span<Rgb> to) const;

private:
    static constexpr float height_counts =
        1 / (flatness * flatness) - 1;  // of a height squared, beside its part of the distance: a flat ellipsoid
    static constexpr float least_cosine = 0.7f;  // between normals of a surface that is taken for the same one

    struct Light;
    struct Leaf;
    struct Boxes;
    class Search;
    /// Some leaves that follow one another, and their photons.
    struct Part {
        std::size_t first, leaves;
    };
    using Level = std::vector<Boxes, InLines<Boxes>>;

    const Leaf& leaf(std::size_t i) const;
    const Light& light_of(std::size_t i) const;
    std::size_t children(std::size_t level, std::size_t at) const;
    void sort(Builders& builders);
    void sort(Part part);
    std::array<Part, 2> halved(Part part);
    void put_in_leaves(Part part);
    void put_in_columns(std::size_t leaf);
    void put_in_boxes();

    std::size_t size_;
    Photons photons_;            // a place for leaves, each in that of its photons
    std::vector<Level> levels_;  // around leaves, around those of the level before, … around all
};

}  // namespace lightnet
