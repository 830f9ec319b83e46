// Changes to a graph that somebody makes while it is at work.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// Everything that has been said since the session began, the last word on each: it goes over what the graph's file
/// says, whenever that is read. A value.
struct GraphEdits {
    std::map<std::string, std::string> constants;  // of the file, as -D has them
    std::map<std::string, Value> params;           // by "node.parameter"
    std::optional<Value> camera;                   // of all scenes
    std::string scene;                             // file of all scenes; "": the graph's
};

/// One line of a session: {"id": …, "set": {"key.gain": 2, "image.samples": null}, "camera": {…}, "scene": "x.glb",
/// "constants": {"rays": 64}, "end": true}. Null takes back what was said. A value.
struct Edit {
    bool end = false;  // the session is over when the picture is there
    std::map<std::string, std::optional<std::string>> constants;
    std::map<std::string, std::optional<Value>> params;
    std::optional<std::optional<Value>> camera;
    std::optional<std::string> scene;  // "": the graph's again

    /// False: it only ends the session.
    bool changes() const { return !constants.empty() || !params.empty() || camera || scene; }
};

/// By what those who wait for an answer know the line, as JSON; "": nothing, also where the line is none.
std::string id_of(std::string_view line);
/// Throws Error that says what is wrong with the line.
Edit edit_of(std::string_view line);
void take(const Edit& edit, GraphEdits& edits);

/// Changes the graph; appends what can't be changed to `problems`, as of a file called "edit".
void apply(const GraphEdits& edits, const Registry& registry, Graph& graph, std::vector<Problem>& problems);

}  // namespace lightnet
