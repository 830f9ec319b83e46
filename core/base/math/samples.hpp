// The random numbers of one question.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/math/random.hpp"
#include "core/base/math/sobol.hpp"

namespace lightnet {

/// Numbers in [0,1) for sample `index` of the stream `key`. Each call uses the next dimension; over the indices of one
/// key, each dimension (and each pair) is well stratified. A value: copy it to branch, keep it on the stack.
class Samples {
public:
    /// `dimension`: how many have been used.
    Samples(Key key, std::uint32_t index, std::uint32_t dimension = 0)
        : key_(key), index_(index), dimension_(dimension) {}

    Vec2 next_2d() { return sobol_point(mix(key_ + offset_of(dimension_++)), index_); }
    float next() { return sobol_coordinate(mix(key_ + offset_of(dimension_++)), index_); }
    /// Passes over a dimension that isn't needed here, so that later ones keep their places.
    float skip() {
        ++dimension_;
        return 0;
    }

    /// What next_2d() gives for many keys and indices when `dimension` numbers have been used, for a third of the work.
    static void many_2d(std::span<const Key> keys, std::span<const std::uint32_t> indices, std::uint32_t dimension,
                        std::span<Vec2> points) {
        sobol_points(keys, offset_of(dimension), indices, points);
    }
    /// What next() gives for many keys and indices when `dimension` numbers have been used.
    static void many(std::span<const Key> keys, std::span<const std::uint32_t> indices, std::uint32_t dimension,
                     std::span<float> values) {
        sobol_coordinates(keys, offset_of(dimension), indices, values);
    }

private:
    static constexpr Key offset_of(std::uint32_t dimension) { return 0xd1342543de82ef95ull * (dimension + 1); }

    Key key_;
    std::uint32_t index_;
    std::uint32_t dimension_;
};

}  // namespace lightnet
