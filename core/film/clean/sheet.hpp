// Numbers per pixel of a picture that is being cleaned, with a margin for those who look at neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace lightnet::cleaning {

/// What is worked on at once has this many pixels along a side. The outermost of them serve the others only.
inline constexpr std::uint32_t area_side = 224;
/// So far a regression looks from its centre, and serves pixels.
inline constexpr std::uint32_t reach = 7;
/// Colours are compared at pixels and so far to their sides.
inline constexpr std::uint32_t patch = 1;
/// Choices are smoothed over so many pixels to each side.
inline constexpr std::uint32_t choice_radius = 2;
/// Estimates of the error are taken over so many: all regressions that see a firefly then know what it costs to leave.
inline constexpr std::uint32_t error_radius = reach + choice_radius;
/// Pixels of an area that serve the others, to each side; what is left of it.
inline constexpr std::uint32_t rim = reach + error_radius + choice_radius, core_side = area_side - 2 * rim;
/// So far around an area its regressions look: they reach into it from outside, and look as far beyond.
inline constexpr std::uint32_t halo = 2 * reach + 4;
/// So far away a pixel may count for another: by its choice, and what that was made from.
inline constexpr std::uint32_t influence = rim + halo;
/// Around a picture, whose sides are taken up to whole cores.
inline constexpr std::uint32_t margin = halo + patch + rim;

/// Where an area begins, in pixels of the picture; may lie outside of it.
struct Place {
    std::int64_t x = 0, y = 0;
};

/// Gives a std::vector numbers that are not set to 0.
template <class T>
struct Unset : std::allocator<T> {
    template <class U>
    struct rebind {
        using other = Unset<U>;
    };
    template <class U>
    void construct(U* place) {
        ::new (static_cast<void*>(place)) U;
    }
    template <class U, class... Arguments>
    void construct(U* place, Arguments&&... arguments) {
        ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }
};

/// One number per pixel, row by row, and beyond the edges. A value.
class Sheet {
public:
    Sheet() = default;
    /// Its numbers are anything, until those of the picture are set and it is extended: whoever sets them, on whatever
    /// core, is the first to need the memory.
    Sheet(std::uint32_t width, std::uint32_t height);
    static Sheet of_zeros(std::uint32_t width, std::uint32_t height);

    float* at(std::int64_t x, std::int64_t y) { return values_.data() + index(x, y); }
    const float* at(std::int64_t x, std::int64_t y) const { return values_.data() + index(x, y); }
    std::size_t stride() const { return stride_; }

    void scale(float factor) {
        for (float& value : values_) value *= factor;
    }
    /// Beyond the edges of a picture of that size, its outermost pixels go on.
    void extend(std::uint32_t width, std::uint32_t height);

private:
    static std::size_t up_to_cores(std::uint32_t side) {
        return (std::size_t{side} + core_side - 1) / core_side * core_side;
    }
    std::size_t index(std::int64_t x, std::int64_t y) const {
        return static_cast<std::size_t>(y + margin) * stride_ + static_cast<std::size_t>(x + margin);
    }

    std::size_t stride_ = 0;
    std::vector<float, Unset<float>> values_;
};

using Colours = std::array<Sheet, 3>;

/// Of the places of a row, those that are in the picture.
struct Inside {
    std::int64_t first = 0, end = 0;

    /// How many of them are no further than `radius` from a place.
    std::int64_t count(std::int64_t place, std::int64_t radius) const {
        return std::max<std::int64_t>(0, std::min(end - 1, place + radius) - std::max(first, place - radius) + 1);
    }
};

/// Adds to each of `width` places what those of a row have that are no further than `radius` from it, from left to
/// right, so that a place knows nothing of where its row began.
void add_across(const float* row, Inside inside, std::int64_t radius, std::int64_t width, float* sums);

/// Gives the numbers of a row; there is scratch for them.
using RowOfSheet = std::function<const float*(std::int64_t y, float* scratch)>;

/// The mean of each pixel's neighbours up to `radius` away, of those that are in the picture. Rows are made on all
/// cores, and more than once.
Sheet smoothed(std::uint32_t width, std::uint32_t height, std::uint32_t radius, const RowOfSheet& row_of);
Sheet smoothed(const Sheet& sheet, std::uint32_t width, std::uint32_t height, std::uint32_t radius);

}  // namespace lightnet::cleaning
