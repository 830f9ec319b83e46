// The scene of a graph: what its file says, and what the graph changes about it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/overrides.hpp"
#include "core/run/assembly/kept.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// What the Scene node of a checked graph's renderer overrides. Names of files are taken from the graph's folder.
SceneOverrides scene_overrides(const Graph& graph, const Registry& registry);

/// What it says of the variables of the scene's file: for read_scene().
std::map<std::string, std::string> scene_constants(const Graph& graph, const Registry& registry);
/// Those of its node of kind Scene, also before anybody has checked it: what is of another type counts for nothing.
std::map<std::string, std::string> scene_constants(const Graph& graph, const Node& scene);

/// A scene as the graph wants it, and what its nodes go on from.
struct LoadedScene {
    SceneData data;
    KeptResults kept{};
    std::shared_ptr<const Scene> built{};  // of the data, which is empty then; null: still to be built
    std::optional<SceneTree> tree{};       // of the data, without who looks; none: nobody has looked into it
};

/// Changes a scene as read from its file. Throws UserError, also with what nodes of the graph find wrong with it.
LoadedScene override_scene(const Graph& graph, const Registry& registry, Files& files, SceneData scene);

/// Who looks at a scene that another graph has changed, which differs in the camera alone. None: more hangs on the
/// camera, so the scene has to be changed from its files on. Throws UserError when that camera can't be.
std::optional<Onlooker> another_look(const Graph& graph, const Registry& registry, const SceneData& changed);

/// Edits lamps and materials of a scene that another graph has changed, which differs in these and the camera alone.
/// Throws UserError.
void edit_again(const Graph& graph, const Registry& registry, SceneData& changed);

/// Appends what nodes of the graph find wrong with the scene.
void find_mistakes(const Graph& graph, const Registry& registry, const SceneData& scene,
                   std::vector<Problem>& problems);

/// Reads the scene in the file at `path` and applies what the graph changes. Throws UserError with all that is wrong.
LoadedScene load_scene(const Graph& graph, const Registry& registry, Files& files, const std::string& path);

}  // namespace lightnet
