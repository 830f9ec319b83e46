// Owen-scrambled Sobol' points, padded from pairs of dimensions.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/math/random.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// Point `index` of the two-dimensional Sobol' sequence, its order shuffled and its digits scrambled by `key`
/// (Burley 2020, "Practical Hash-based Owen Scrambling"). For one key, each aligned power of two of consecutive
/// indices is stratified in [0,1)². Different keys give independent sequences.
Vec2 sobol_point(Key key, std::uint32_t index);

/// Its first coordinate alone, for less.
float sobol_coordinate(Key key, std::uint32_t index);

/// Many at once, for a fraction of the work: sobol_point(mix(keys[i] + offset), indices[i]), to the bit.
void sobol_points(std::span<const Key> keys, Key offset, std::span<const std::uint32_t> indices,
                  std::span<Vec2> points);
/// Many first coordinates at once: sobol_coordinate(mix(keys[i] + offset), indices[i]), to the bit.
void sobol_coordinates(std::span<const Key> keys, Key offset, std::span<const std::uint32_t> indices,
                       std::span<float> values);

}  // namespace lightnet
