// Path guiding: the directions from which light comes, as they were learnt.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/base/math/columns.hpp"
#include "core/base/math/frame.hpp"
#include "core/base/math/rgb.hpp"
#include "core/estimate/guide_square.hpp"
#include "core/network/light/builders.hpp"
#include "core/scene/direct_light.hpp"

namespace lightnet {

/// A direction by which a path has gone on from a surface.
struct GuideStep {
    Vec3 position;
    float density = 1;       // with which the direction was sampled, as of its place in the square
    std::uint32_t turn = 0;  // of the surface: LightGuide::turn_of()
    Vec2 place;              // of the direction, in the square
};

/// Light that a path has found in one direction: what a guide learns from. Small, as many travel.
class GuideRecord {
public:
    GuideRecord() = default;
    /// `radiance`: that arrived, luminance, W·sr⁻¹·m⁻².
    GuideRecord(const GuideStep& step, float radiance)
        : position_(step.position),
          bits_(step.turn << turn_at | packed(step.place.x) << place_bits | packed(step.place.y) |
                rounded(radiance / step.density) << light_at) {}
    /// Of another kind, whose three numbers mean something else: no guide learns from it.
    explicit GuideRecord(Vec3 numbers) : position_(numbers), bits_(strange << turn_at) {}

    Vec3 position() const { return position_; }
    /// Radiance over density.
    float light() const { return std::bit_cast<float>((bits_ >> light_at & light_mask) << light_cut); }
    std::uint32_t turn() const { return bits_ >> turn_at; }
    Vec2 place() const { return {unpacked(bits_ >> place_bits), unpacked(bits_)}; }
    /// Is it one that a path can have made?
    bool sound() const { return finite(position_) && std::isfinite(light()); }
    friend bool operator==(const GuideRecord&, const GuideRecord&) = default;

private:
    static constexpr int place_bits = 7, light_at = 2 * place_bits, light_bits = 13, turn_at = light_at + light_bits;
    static constexpr int light_cut = 31 - light_bits;  // of a float without its sign
    static constexpr std::uint32_t light_mask = (1u << light_bits) - 1, place_mask = (1u << place_bits) - 1;
    static constexpr std::uint32_t strange = 31;
    static std::uint32_t rounded(float light) {
        return (std::bit_cast<std::uint32_t>(light) + (1u << (light_cut - 1))) >> light_cut & light_mask;
    }
    static std::uint32_t packed(float x) { return std::uint32_t(x * (1 << place_bits)) & place_mask; }
    static float unpacked(std::uint32_t x) { return (float(x & place_mask) + 0.5f) / (1 << place_bits); }

    Vec3 position_;
    std::uint32_t bits_ = 0;
};
static_assert(sizeof(GuideRecord) == 16);

/// A part of the scene's surfaces, and what is known there.
struct GuideCell {
    GuideSquare square;
    float radiance = 0;  // mean over the hemisphere, cosine-weighted, luminance, W·sr⁻¹·m⁻²
};

/// The side of a surface on which directions are guided. Directions are places of the unit square: the disk over which
/// a hemisphere with the density of its cosine lies even (Shirley & Chiu 1997). An even square means what a diffuse
/// reflector does by itself.
struct GuideSide {
    Vec3 up;              // shading normal, on the side of the geometric one; or that one
    bool turned = false;  // light leaves on the other side

    /// As Bsdf has it.
    static GuideSide of(Vec3 normal, Vec3 shading, Vec3 outgoing) {
        const float front = dot(outgoing, normal) > 0 ? 1 : 0, front_shading = dot(outgoing, shading) > 0 ? 1 : 0;
        const bool agree = front == front_shading;
        const Vec3 up{agree ? shading.x : normal.x, agree ? shading.y : normal.y, agree ? shading.z : normal.z};
        return {up, dot(outgoing, up) < 0};
    }
};

/// Density of a direction, per steradian, if of all those that are drawn that share follows a guide, and would else go
/// by the cosine. `bsdf`: by the BSDF alone; `height`: of the direction above the surface; `density`: of its place.
[[gnu::always_inline]] inline float guided_pdf(float bsdf, float share, float height, float density) {
    return bsdf + share * (height * inverse_pi) * (density - 1);
}

/// One point as a guide knows it. Directions follow the guide where the BSDF alone would go by the cosine: all those of
/// a diffuse surface, and of one with gloss those of its diffuse lobe.
/// DECISIONS: guided-by-the-cosine
class GuidedPoint final : public Guidance {
public:
    GuidedPoint() = default;
    /// `choices`: of the surface's BSDF.
    GuidedPoint(const GuideCell* cell, const GuideSide& side, CosineChoices choices)
        : cell_(cell), frame_(Frame::around(side.up)), turned_(side.turned), choices_(choices) {}

    explicit operator bool() const { return cell_; }
    float radiance() const { return cell_->radiance; }
    /// Do directions follow it?
    bool leads() const { return choices_.chance() > 0; }
    /// Those that are drawn by this choice?
    bool leads(float choice) const { return choices_.contain(choice); }
    SquarePoint warped(Vec2 u) const { return cell_->square.warp(u); }
    float density(Vec2 place) const { return cell_->square.density(place); }
    /// How high a direction stands on the guide's side.
    float height(Vec3 direction) const {
        const float z = dot(direction, frame_.z);
        return turned_ ? -z : z;
    }
    Vec2 place(Vec3 direction) const { return from_disk({dot(direction, frame_.x), dot(direction, frame_.y)}); }
    Vec3 direction(Vec2 place) const {
        Vec3 local = cosine_hemisphere(place);
        if (turned_) local.z = -local.z;
        return normalize(frame_.to_world(local));
    }
    float pdf(Vec3 direction, float bsdf) const override {
        const float z = height(direction);
        if (!leads() || !(bsdf > 0) || !(z > 0)) return bsdf;
        return guided_pdf(bsdf, choices_.chance(), z, density(place(direction)));
    }

private:
    const GuideCell* cell_ = nullptr;
    Frame frame_;
    bool turned_ = false;
    CosineChoices choices_;
};

/// Müller, Gross & Novák 2017, "Practical Path Guiding for Efficient Light-Transport Simulation": a tree over surfaces,
/// whose leaves have a square of directions each, where theirs have a quadtree. Immutable; any thread may ask. It
/// depends on its records alone, and on their order.
class LightGuide {
public:
    /// Knows nothing.
    LightGuide() { roots_.fill(0); }
    /// Records that it does not learn from are passed over.
    LightGuide(std::span<const GuideRecord> records, Builders& builders)
        : LightGuide(std::span<const std::span<const GuideRecord>>(&records, 1), builders) {}
    /// From several lots of them.
    LightGuide(std::span<const std::span<const GuideRecord>> lots, Builders& builders);

    static bool learns_from(const GuideRecord& record) { return record.turn() < turns && record.sound(); }

    /// Sides of surfaces that are turned alike have a tree of their own: within one, frames around their normals turn
    /// without a jump.
    static constexpr std::uint32_t turns = 24;
    static std::uint32_t turn_of(const GuideSide& side) {
        const auto negative = [](float v) { return std::bit_cast<std::uint32_t>(v) >> 31; };
        const float x = std::fabs(side.up.x), y = std::fabs(side.up.y), z = std::fabs(side.up.z);
        const bool most_z = (z >= x) & (z >= y), most_y = y >= x;
        const std::uint32_t low = most_y ? 1 : 0, axis = most_z ? 2 : low;
        const float lower = most_y ? side.up.y : side.up.x, along = most_z ? side.up.z : lower;
        return axis * 8 + negative(along) * 4 + negative(side.up.z) * 2 + std::uint32_t{side.turned};
    }

    /// What is known there; null: nothing.
    const GuideCell* find(Vec3 position, const GuideSide& side) const {
        std::uint32_t at = roots_[turn_of(side)];
        while (branches_[at].next != at)
            at = branches_[at].next + (position[branches_[at].axis] >= branches_[at].border);
        return cell_at(at);
    }
    /// What is known at each of `count` positions, whose sides are given by turn_of(); null: nothing.
    void find(const Columns3& positions, const Flags& sides, std::size_t count,
              std::array<const GuideCell*, lanes>& cells) const;
    /// The point as it knows it. False: it knows nothing.
    GuidedPoint at(Vec3 position, const GuideSide& side, CosineChoices choices) const {
        const GuideCell* cell = find(position, side);
        return cell ? GuidedPoint(cell, side, choices) : GuidedPoint();
    }
    std::size_t size() const { return cells_.size(); }

private:
    void learn(std::span<const std::span<GuideRecord>> leaves, Builders& builders);

    static constexpr std::uint32_t nothing = 0xffffffffu;
    // A leaf is followed by itself, so that many may go on together until the last of them has come to its own.
    struct Branch {
        float border = std::numeric_limits<float>::quiet_NaN();  // of a leaf: nothing lies above
        std::uint32_t axis = 0;
        std::uint32_t next = 0;        // of the two that follow
        std::uint32_t cell = nothing;  // of a leaf
    };
    const GuideCell* cell_at(std::uint32_t branch) const {
        const std::uint32_t cell = branches_[branch].cell;
        return cell == nothing ? nullptr : &cells_[cell];
    }

    std::array<std::uint32_t, turns> roots_;
    std::vector<Branch> branches_{Branch{}};  // the first: where nothing is known
    std::vector<GuideCell> cells_;
    int most_cuts_ = 0;
};

}  // namespace lightnet
