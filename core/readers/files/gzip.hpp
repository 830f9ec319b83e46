// Files, and parts of them, that were packed with gzip or zlib.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lightnet {

/// Told by the first bytes.
bool is_gzip(std::span<const std::byte> bytes);

/// Unpacks. Throws Error (without a file name) when the bytes are broken or would become more than `most` bytes;
/// holds no more than that at any time.
std::vector<std::byte> gunzip(std::span<const std::byte> bytes, std::size_t most = std::size_t{1} << 30);
/// As gunzip(), of what has zlib's header.
std::vector<std::byte> unzip(std::span<const std::byte> bytes, std::size_t most);

}  // namespace lightnet
