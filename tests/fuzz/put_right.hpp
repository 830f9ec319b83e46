// Headers of packets, as a sender with bad intentions makes them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lightnet::fuzz {

/// A header that is right (magic, version, size and checksum) about a body that is not.
std::vector<std::byte> put_right(std::span<const std::byte> header, std::span<const std::byte> body);

}  // namespace lightnet::fuzz
