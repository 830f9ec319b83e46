// Consistent hashing: which of several owners a key belongs to (Karger et al. 1997).
#pragma once

#include <cstdint>
#include <map>

#include "core/base/math/random.hpp"

namespace lightnet {

/// Points of a circle belong to owners, and a key to the owner of the next point. When an owner goes, only its own keys
/// move; when it comes back under its name, they come back with it.
class HashRing {
public:
    using Owner = std::uint32_t;

    /// `name` decides which keys it gets; one of twice the weight gets about twice as many.
    void add(Owner owner, std::uint64_t name, std::uint32_t weight = 1) {
        for (std::uint64_t i = 0; i < weight * points_of_each; ++i) points_.emplace(child(name, 0, i), owner);
    }
    void remove(Owner owner, std::uint64_t name, std::uint32_t weight = 1) {
        for (std::uint64_t i = 0; i < weight * points_of_each; ++i) {
            const auto point = points_.find(child(name, 0, i));
            if (point != points_.end() && point->second == owner) points_.erase(point);
        }
    }
    bool empty() const { return points_.empty(); }
    /// Only when there is an owner.
    Owner owner_of(std::uint64_t key) const {
        const auto next = points_.lower_bound(mix(key + 1));
        return (next == points_.end() ? points_.begin() : next)->second;
    }

private:
    static constexpr std::uint64_t points_of_each = 32;
    std::map<std::uint64_t, Owner> points_;
};

}  // namespace lightnet
