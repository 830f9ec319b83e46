#include "core/network/graph/frames_beside.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace lightnet {
namespace {

struct Looks {
    bool before = false, after = false;
};

double frames_at(const Table& span, std::size_t end) {
    const auto* frames = end < span.list.size() ? std::get_if<double>(&span.list[end].data) : nullptr;
    return frames ? *frames : 0;
}

/// Beyond its own frame, through the shutter.
Looks looks_of(const Node& scene) {
    const auto shutter = scene.params.find("shutter");
    const auto* span = shutter == scene.params.end() ? nullptr : std::get_if<Table>(&shutter->second.data);
    if (!span) return {};
    return {frames_at(*span, 0) < 0, frames_at(*span, 1) > 0};
}

const Value* param_of(const Node& node, const std::string& name) {
    const auto found = node.params.find(name);
    return found == node.params.end() ? nullptr : &found->second;
}

void note(Node& scene, const Node& there, const std::string& which, bool with_time) {
    Table other;
    if (!there.entries.empty() && there.entries != scene.entries) other.named["file"] = there.entries[0];
    if (const Value* time = param_of(there, "time"); time && with_time) other.named["time"] = *time;
    if (!other.named.empty()) scene.params.try_emplace(which, Value{std::move(other)});
    const Value *now = param_of(scene, "camera"), *then = param_of(there, "camera");
    if (now && then && *now != *then) scene.params.try_emplace(which + "_camera", *then);
}

}  // namespace

bool asks_for_motion(const Graph& graph) {
    return std::ranges::any_of(graph.nodes, [](const Node& node) {
        const Value* of = param_of(node, "of");
        const auto* fact = of ? std::get_if<std::string>(&of->data) : nullptr;
        return fact && *fact == "motion";
    });
}

// DECISIONS: frames-beside-are-parameters
void note_frames_beside(Graph& graph, const std::function<Graph(int by)>& graph_at) {
    const bool motion = asks_for_motion(graph);
    std::map<int, Graph> others;
    const auto note_of = [&](Node& scene, int by, const std::string& which) {
        if (!others.contains(by)) others.emplace(by, graph_at(by));
        const Graph& other = others.at(by);
        const auto there = other.find(scene.name);
        if (there && other.nodes[*there].kind == scene.kind) note(scene, other.nodes[*there], which, motion);
    };
    for (Node& node : graph.nodes) {
        if (node.kind != "Scene") continue;
        const Looks looks = looks_of(node);
        if (looks.before) note_of(node, -1, "previous");
        if (looks.after || motion) note_of(node, 1, "next");
    }
}

}  // namespace lightnet
