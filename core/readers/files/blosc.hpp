// Parts of files that were packed by Blosc, a way of packing for arrays of numbers.
#pragma once

#include <cstddef>
#include <span>

namespace lightnet {

/// Unpacks one buffer into exactly so many bytes. Throws Error, without a file name, where it is broken or another
/// size.
void unpack_blosc(std::span<const std::byte> packed, std::span<std::byte> to);

}  // namespace lightnet
