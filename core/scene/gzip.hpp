// Files that were packed with gzip.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lightnet {

/// Told by the first bytes.
bool is_gzip(std::span<const std::byte> bytes);

/// Unpacks. Throws Error (without a file name) when the bytes are broken or would become more than 1 GiB.
std::vector<std::byte> gunzip(std::span<const std::byte> bytes);

}  // namespace lightnet
