// Where light comes from, as it was learnt: path guiding.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/base/math/frame.hpp"
#include "core/base/math/rgb.hpp"
#include "core/estimate/guide_square.hpp"
#include "core/network/light/builders.hpp"
#include "core/scene/direct_light.hpp"

namespace lightnet {

/// Light that a path has found in one direction: what a guide learns from.
struct GuideRecord {
    Vec3 position;
    float radiance = 0;                    // that arrived, luminance, W·sr⁻¹·m⁻²
    float density = 1;                     // with which the direction was sampled, as of its place in the square
    std::uint32_t turn = 0;                // of the surface: LightGuide::turn_of()
    std::array<std::uint16_t, 2> place{};  // of the direction: 0 … 65535 of the square

    static std::uint16_t packed(float x) { return static_cast<std::uint16_t>(x * 65536); }
    Vec2 at() const { return {(float(place[0]) + 0.5f) / 65536, (float(place[1]) + 0.5f) / 65536}; }
    /// Is it one that a path can have made?
    bool sound() const {
        return finite(position) && std::isfinite(radiance) && radiance >= 0 && std::isfinite(density) && density > 0;
    }
    friend bool operator==(const GuideRecord&, const GuideRecord&) = default;
};
static_assert(sizeof(GuideRecord) == 28);

/// A part of the scene's surfaces, and what is known there.
struct GuideCell {
    GuideSquare square;
    float share = 0.5f;  // of samples by the guide, where the BSDF has other lobes than an even one
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
        const bool front = dot(outgoing, normal) > 0, front_shading = dot(outgoing, shading) > 0;
        const Vec3 up = front == front_shading ? shading : normal;
        return {up, dot(outgoing, up) < 0};
    }
};

/// One point as a guide knows it. Directions are distributed partly by the guide and partly by the BSDF, or all by the
/// guide where the surface scatters evenly: one-sample model of multiple importance sampling, Veach 1997,
/// section 9.2.4.
class GuidedPoint final : public Guidance {
public:
    GuidedPoint() = default;
    GuidedPoint(const GuideCell* cell, const GuideSide& side, bool even)
        : cell_(cell), frame_(Frame::around(side.up)), turned_(side.turned), share_(even ? 1 : cell->share) {}

    explicit operator bool() const { return cell_; }
    float radiance() const { return cell_->radiance; }
    /// Of samples by the guide.
    float share() const { return share_; }
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
        const float guided = z > 0 && share_ > 0 ? density(place(direction)) * z * inverse_pi : 0;
        return share_ * guided + (1 - share_) * bsdf;
    }

private:
    const GuideCell* cell_ = nullptr;
    Frame frame_;
    bool turned_ = false;
    float share_ = 0;
};

/// Müller, Gross & Novák 2017, "Practical Path Guiding for Efficient Light-Transport Simulation": a tree over surfaces,
/// whose leaves have a square of directions each, where theirs have a quadtree. Immutable; any thread may ask. It
/// depends on its records alone, and on their order.
class LightGuide {
public:
    /// Knows nothing.
    LightGuide() { roots_.fill(nothing); }
    /// Records that it does not learn from are passed over.
    LightGuide(std::span<const GuideRecord> records, Builders& builders);

    static bool learns_from(const GuideRecord& record) { return record.turn < turns && record.sound(); }

    /// Sides of surfaces that are turned alike have a tree of their own: within one, frames around their normals turn
    /// without a jump.
    static constexpr std::uint32_t turns = 24;
    static std::uint32_t turn_of(const GuideSide& side) {
        const float x = std::fabs(side.up.x), y = std::fabs(side.up.y), z = std::fabs(side.up.z);
        const std::uint32_t axis = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
        const bool negative = std::signbit(axis == 2 ? side.up.z : axis == 1 ? side.up.y : side.up.x);
        return axis * 8 + negative * 4u + std::signbit(side.up.z) * 2u + side.turned;
    }

    /// What is known there; null: nothing.
    const GuideCell* find(Vec3 position, const GuideSide& side) const {
        const std::uint32_t root = roots_[turn_of(side)];
        if (root == nothing) return nullptr;
        const Branch* branch = &branches_[root];
        while (branch->axis < 3) branch = &branches_[branch->next + (position[branch->axis] >= branch->border)];
        return &cells_[branch->next];
    }
    /// The point as it knows it; `even`: the surface scatters evenly. False: it knows nothing.
    GuidedPoint at(Vec3 position, const GuideSide& side, bool even) const {
        const GuideCell* cell = find(position, side);
        return cell ? GuidedPoint(cell, side, even) : GuidedPoint();
    }
    std::size_t size() const { return cells_.size(); }

private:
    static constexpr std::uint32_t nothing = 0xffffffffu;
    struct Branch {
        float border = 0;
        std::uint32_t axis = 3;  // 3: a leaf
        std::uint32_t next = 0;  // of the two that follow, or the cell
    };

    std::array<std::uint32_t, turns> roots_;
    std::vector<Branch> branches_;
    std::vector<GuideCell> cells_;
};

}  // namespace lightnet
