// The random numbers of one question.
#pragma once

#include <cstdint>

#include "core/math/random.hpp"
#include "core/math/sobol.hpp"

namespace lightnet {

/// Numbers in [0,1) for sample `index` of the stream `key`. Each call uses the next dimension; over the indices of one
/// key, each dimension (and each pair) is well stratified. A value: copy it to branch, keep it on the stack.
class Samples {
public:
    Samples(Key key, std::uint32_t index) : key_(key), index_(index) {}

    Vec2 next_2d() { return sobol_point(mix(key_ + 0xd1342543de82ef95ull * ++dimension_), index_); }
    float next() { return sobol_coordinate(mix(key_ + 0xd1342543de82ef95ull * ++dimension_), index_); }
    /// Passes over a dimension that isn't needed here, so that later ones keep their places.
    float skip() {
        ++dimension_;
        return 0;
    }

private:
    Key key_;
    std::uint32_t index_;
    std::uint32_t dimension_ = 0;
};

}  // namespace lightnet
