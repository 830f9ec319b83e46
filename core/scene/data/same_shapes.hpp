// Two scenes in which rays meet the same.
#pragma once

#include <cstddef>
#include <vector>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Do the shapes of both stand alike, so that what finds surfaces of `built` finds those of `wanted`? Positions of a
/// mesh of `built` may have one more behind their last. False is safe: so it is where anything moves, or is cut out by
/// opacity, as more hangs on that than shapes.
bool have_same_shapes(const SceneData& built, const SceneData& wanted);

/// How many positions each shape has that is a mesh; of others 0.
std::vector<std::size_t> vertices_of(const SceneData& data);
/// With so many of them alone.
SceneData with_vertices(SceneData data, const std::vector<std::size_t>& vertices);

/// Puts one more behind each mesh's positions, as whoever reads several numbers at once may read beyond the last.
void pad_positions(SceneData& data);

}  // namespace lightnet
