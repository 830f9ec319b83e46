// Indices that say what they are of.
#pragma once

#include <cstdint>

namespace lightnet {

/// The place of an `Element` in its list. Becomes a number, and is made from one, without a word; but whoever looks
/// through a type's members can tell it from other numbers, and from the indices into other lists.
template <class Element>
struct IndexOf {
    std::uint32_t value = 0;

    constexpr IndexOf() = default;
    constexpr IndexOf(std::uint32_t index) : value(index) {}
    constexpr operator std::uint32_t() const { return value; }
};

}  // namespace lightnet
