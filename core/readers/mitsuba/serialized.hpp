// Mitsuba's own format of meshes.
#pragma once

#include <cstddef>
#include <span>

#include "core/scene/data/scene_data.hpp"

namespace lightnet::mitsuba {

/// Mesh number `index` of a ".serialized" file, version 3 or 4: deflated, with floats or doubles. Its v goes down, as
/// it is in the file. Throws Error (without a file name) when the bytes are not sound; allocates no more than a small
/// multiple of what they really hold. `face_normals` says whether the file asks for flat faces.
Mesh read_serialized(std::span<const std::byte> bytes, std::size_t index, bool& face_normals);

}  // namespace lightnet::mitsuba
