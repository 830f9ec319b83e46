// Buffer views that EXT_meshopt_compression has packed.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/readers/gltf/json.hpp"

namespace lightnet::gltf {

/// What a view holds of which `packed` tells, by its packed bytes. None: reported.
std::optional<std::vector<std::byte>> unpack_view(const At& packed, std::span<const std::byte> bytes);

}  // namespace lightnet::gltf
