// Surfaces with gloss that many light paths have come to at once, sorted by their models.
#pragma once

#include <cstdint>

#include "core/scene/surfaces/glossy_surfaces.hpp"

namespace lightnet {

/// Each model in columns of its own. One thread.
class GlossyGroups {
public:
    using Kind = ColumnShape::Kind;

    /// with(group) of each that holds a point.
    template <class With>
    void each(With&& with) {
        each_of(*this, with);
    }
    template <class With>
    void each(With&& with) const {
        each_of(*this, with);
    }
    /// with(group) of the one for points of `kind`: it will hold one.
    template <class With>
    [[gnu::always_inline]] void add(Kind kind, With&& with) {
        held_ |= bit(kind);
        of(kind, with);
    }
    /// with(group) of the one for points of `kind`, if there is one.
    template <class With>
    [[gnu::always_inline]] void of(Kind kind, With&& with) {
        all(*this, [&](Kind one, auto& group) {
            if (one == kind) with(group);
        });
    }
    void clear() {
        each([](auto& group) { group.clear(); });
        held_ = 0;
    }

private:
    static std::uint32_t bit(Kind kind) { return 1u << static_cast<std::uint32_t>(kind); }
    // Most scenes hold few: the others are not even looked at.
    template <class Self, class With>
    static void each_of(Self& self, With&& with) {
        if (self.held_ == 0) return;
        all(self, [&](Kind kind, auto& group) {
            if ((self.held_ & bit(kind)) != 0) with(group);
        });
    }
    template <class Self, class With>
    [[gnu::always_inline]] static void all(Self& self, With&& with) {
        with(Kind::coated, self.coated_), with(Kind::coated_beckmann, self.coated_beckmann_);
        with(Kind::metal, self.metal_), with(Kind::metal_beckmann, self.metal_beckmann_);
        with(Kind::principled, self.principled_);
    }

    std::uint32_t held_ = 0;  // by kind
    CoatedSurfaces<GgxLaw> coated_;
    CoatedSurfaces<BeckmannLaw> coated_beckmann_;
    MetalSurfaces<GgxLaw> metal_;
    MetalSurfaces<BeckmannLaw> metal_beckmann_;
    PrincipledSurfaces principled_;
};

}  // namespace lightnet
