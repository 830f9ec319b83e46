// Space, cut into sectors for the replicas of a sharded node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/math/vec.hpp"

namespace lightnet {

/// A kd-tree whose leaves are the sectors; those at the rim have no end, so that every point lies in one. Depends on
/// the landmarks and on the count alone. Immutable; any thread may ask.
class Sectors {
public:
    /// About as many of the landmarks lie in each sector. `count` is at least 1.
    Sectors(std::vector<Vec3> landmarks, std::uint32_t count);

    std::uint32_t count() const { return count_; }
    /// The sector in which a point lies.
    std::uint32_t at(Vec3 point) const {
        std::int32_t node = root_;
        while (node >= 0) {
            const Border& border = borders_[static_cast<std::size_t>(node)];
            node = point[border.axis] < border.at ? border.below : border.above;
        }
        return static_cast<std::uint32_t>(-1 - node);
    }
    /// Calls `visit` with every sector that has a point within `reach` of this one along each axis, rounding included:
    /// whatever lies so near to a question is known in the question's sector.
    template <class Visit>
    void near(Vec3 point, float reach, const Visit& visit) const {
        visit_near(root_, point, static_cast<double>(reach) * (1 + 1e-6), visit);
    }

private:
    // Children are borders from 0 on, sectors from -1 downwards.
    struct Border {
        std::size_t axis;
        float at;
        std::int32_t below, above;
    };
    struct Range {
        std::size_t first, end;
    };
    std::int32_t cut(std::vector<Vec3>& landmarks, Range range, std::uint32_t first, std::uint32_t count);

    template <class Visit>
    void visit_near(std::int32_t node, Vec3 point, double reach, const Visit& visit) const {
        if (node < 0) return visit(static_cast<std::uint32_t>(-1 - node));
        const Border& border = borders_[static_cast<std::size_t>(node)];
        if (point[border.axis] - reach < border.at) visit_near(border.below, point, reach, visit);
        if (point[border.axis] + reach >= border.at) visit_near(border.above, point, reach, visit);
    }

    std::uint32_t count_;
    std::vector<Border> borders_;
    std::int32_t root_;
};

}  // namespace lightnet
