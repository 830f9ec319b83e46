// Irradiance that is known somewhere, found where it is of use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/estimate/hemisphere.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// How far a record counts.
struct Spacing {
    float accuracy = 0.25f;  // of the estimated error, relative: a record counts within this × its distance
    float least = 0;         // m, of that
    float most = 0;          // m
};

/// Records, in the cells of an octree that they reach. Immutable; any thread may ask.
class IrradianceOctree {
public:
    /// Limits how far each record counts: by its own gradient (an estimate never changes by more than itself), and by
    /// its neighbours, as they see what it may have missed (Krivanek et al. 2006, "Making radiance and irradiance
    /// caching practical", section 3.1).
    /// `groups` of lamps have a record each at a point, side by side: all count as far as that of their sum.
    IrradianceOctree(std::span<const IrradianceRecord> records, const Spacing& spacing, const Box& bounds,
                     std::size_t groups = 1);

    /// How many points have records.
    std::size_t size() const { return records_.size(); }
    /// Irradiance at a point, between all records that reach it when their reach is `stretch` times what it is; none:
    /// there is none. The weight of a record falls to 0 where it ends, so that no border shows. Error: Ward et al.
    /// 1988, equation 5; weight: Tabellion & Lamorlette 2004.
    std::optional<Rgb> irradiance(Vec3 position, Vec3 normal, float stretch) const;
    /// Irradiance of each group of lamps at a point, as irradiance() finds that of their sum. False: no record reaches
    /// the point.
    bool irradiance(Vec3 position, Vec3 normal, float stretch, std::span<Rgb> groups) const;
    /// Does any record reach the point?
    bool covers(Vec3 position, Vec3 normal) const;

    /// The record nearest to a point, on a surface turned like this one, either side; null: none that reaches the point
    /// is within that distance. Of records at one distance, the one that was computed first.
    const IrradianceRecord* nearest(Vec3 position, Vec3 normal, float within) const;

    /// Longest stretch that irradiance() may be asked for.
    static constexpr float most_stretch = 1.5f;

private:
    struct Entry {
        IrradianceRecord record;
        float reach;  // m: error 1
    };
    /// What decides whether an entry counts, by itself: a lookup sees many, and uses few.
    struct Reach {
        Vec3 position, normal;
        float reach;
        std::uint32_t entry;
    };
    struct Cell {
        std::array<std::uint32_t, 8> children{};  // 0: none
        std::vector<Reach> entries;
    };
    void add(std::span<const IrradianceRecord> groups);
    const IrradianceRecord& record(std::uint32_t entry, std::size_t group) const {
        return groups_ == 1 ? records_[entry].record : apart_[entry * groups_ + group];
    }
    float weight(const Reach& entry, Vec3 position, Vec3 normal, float stretch) const;
    void clamp_to_neighbours();
    void insert(std::uint32_t entry);
    void insert(std::uint32_t cell, Vec3 low, float size, std::uint32_t entry);
    template <class Function>
    void for_all_near(Vec3 position, Function function) const;

    std::size_t groups_;
    std::vector<Entry> records_;           // of the sums
    std::vector<IrradianceRecord> apart_;  // of each group, where there are several
    std::vector<Cell> cells_;
    Vec3 low_;
    float size_ = 0;
    Spacing spacing_;
};

}  // namespace lightnet
