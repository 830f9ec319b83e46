// Surfaces with gloss that many light paths have come to at once, sorted by their models.
#pragma once

#include "core/estimate/guided_columns.hpp"
#include "core/scene/batch/glossy_surfaces.hpp"

namespace lightnet {

/// Each model in columns of its own. One thread.
class GlossyGroups {
public:
    using Kind = ColumnShape::Kind;

    /// with(group) of each that holds a point.
    template <class With>
    void each(With&& with) {
        all(*this, [&](Kind, auto& group) {
            if (group.size() > 0) with(group);
        });
    }
    template <class With>
    void each(With&& with) const {
        all(*this, [&](Kind, const auto& group) {
            if (group.size() > 0) with(group);
        });
    }
    /// with(group) of the one for points of `kind`, if there is one.
    template <class With>
    [[gnu::always_inline]] void of(Kind kind, With&& with) {
        all(*this, [&](Kind one, auto& group) {
            if (one == kind) with(group);
        });
    }
    void clear() {
        all(*this, [](Kind, auto& group) { group.clear(); });
    }

private:
    template <class Self, class With>
    [[gnu::always_inline]] static void all(Self& self, With&& with) {
        with(Kind::coated, self.coated_), with(Kind::coated_beckmann, self.coated_beckmann_);
        with(Kind::metal, self.metal_), with(Kind::metal_beckmann, self.metal_beckmann_);
        with(Kind::principled, self.principled_);
    }

    Guided<CoatedSurfaces<GgxLaw>> coated_;
    Guided<CoatedSurfaces<BeckmannLaw>> coated_beckmann_;
    Guided<MetalSurfaces<GgxLaw>> metal_;
    Guided<MetalSurfaces<BeckmannLaw>> metal_beckmann_;
    Guided<PrincipledSurfaces> principled_;
};

}  // namespace lightnet
