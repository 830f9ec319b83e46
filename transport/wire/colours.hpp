// The colours of an answer: the body of a packet.
//
// A column `rgb` of colours. Where many are black, as of layers that nothing lights, it has the others alone, and a
// column `lit` tells by one bit per colour which those are.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/math/rgb.hpp"

namespace lightnet::packet {

void pack_colours(std::span<const Rgb> colours, std::vector<std::byte>& body);
/// Reads `count` colours, the same bits. None: there are others in `body`, or something else.
std::optional<std::vector<Rgb>> unpack_colours(std::size_t count, std::span<const std::byte> body);

}  // namespace lightnet::packet
