// Surfaces with gloss that many light paths have come to at once, sorted by their models.
#pragma once

#include "core/scene/surfaces/glossy_surfaces.hpp"

namespace lightnet {

/// Each model in columns of its own. One thread.
class GlossyGroups {
public:
    /// with(group) of each that holds a point.
    template <class With>
    void each(With&& with) {
        const auto some = [&](auto& group) {
            if (group.size() > 0) with(group);
        };
        some(coated_), some(metal_), some(principled_);
    }
    template <class With>
    void each(With&& with) const {
        const auto some = [&](const auto& group) {
            if (group.size() > 0) with(group);
        };
        some(coated_), some(metal_), some(principled_);
    }
    /// with(group) of the one that holds points of `kind`, if there is one.
    template <class With>
    [[gnu::always_inline]] void of(ColumnShape::Kind kind, With&& with) {
        if (kind == ColumnShape::Kind::coated) with(coated_);
        if (kind == ColumnShape::Kind::metal) with(metal_);
        if (kind == ColumnShape::Kind::principled) with(principled_);
    }
    void clear() { coated_.clear(), metal_.clear(), principled_.clear(); }

private:
    CoatedSurfaces coated_;
    MetalSurfaces metal_;
    PrincipledSurfaces principled_;
};

}  // namespace lightnet
