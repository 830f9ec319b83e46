// Values of any type as a structure of arrays.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "core/base/math/columns.hpp"

namespace lightnet {

/// Up to `lanes` values whose members are all as wide as a float; each of these is in a column of its own.
template <class T>
class LanesOf {
    static constexpr std::size_t width = sizeof(std::uint32_t), count = sizeof(T) / width;
    static constexpr auto places = std::make_index_sequence<count>{};
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) == count * width && alignof(T) == width);

public:
    [[gnu::always_inline]] void set(std::size_t i, const T& value) { set(i, value, places); }
    [[gnu::always_inline]] T operator[](std::size_t i) const { return at(i, places); }

private:
    // Number by number: as one value they would have to go through memory, which waits.
    template <std::size_t... k>
    [[gnu::always_inline]] void set(std::size_t i, const T& value, std::index_sequence<k...>) {
        const auto* bytes = reinterpret_cast<const std::byte*>(&value);
        (std::memcpy(&columns_[k][i], bytes + k * width, width), ...);
    }
    template <std::size_t... k>
    [[gnu::always_inline]] T at(std::size_t i, std::index_sequence<k...>) const {
        return std::bit_cast<T>(std::array<std::uint32_t, count>{columns_[k][i]...});
    }

    std::array<Flags, count> columns_;
};

}  // namespace lightnet
