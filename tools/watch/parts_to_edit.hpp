// Lamps and materials of a scene, for a page that edits them.
#pragma once

#include "core/base/json_tree.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// {"scene": "room", "lamps": ["key", …], "materials": [{"name": "wall", "colour": [.7, .7, .7], "roughness": .2}, …],
/// "edits":
/// {"lamps": {"key": 2}, "colours": {…}, "roughness": {…}}}: by their names, the first so many; a colour that is no
/// single one is null, and what a material hasn't is missing. `edits`: what the graph's scene, called so, says of them.
/// `scene` is as the graph wants it.
JsonTree parts_to_edit(const Graph& graph, const Registry& registry, const SceneData& scene);

}  // namespace lightnet
