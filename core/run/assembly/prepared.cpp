#include "core/run/assembly/prepared.hpp"

#include <algorithm>
#include <span>

#include "core/base/error.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "core/network/light/mapped.hpp"

namespace lightnet {

std::vector<std::size_t> preparing_nodes(const Graph& graph, const Registry& registry) {
    const auto used = used_nodes(graph, renderer_of(graph, registry));
    const auto ranks = ranks_of(graph);
    std::vector<std::size_t> nodes;
    for (std::size_t node = 0; node < graph.nodes.size(); ++node)
        if (used[node] && registry.find(graph.nodes[node].kind)->run.prepares) nodes.push_back(node);
    std::stable_sort(nodes.begin(), nodes.end(), [&](auto a, auto b) { return ranks[a] < ranks[b]; });
    return nodes;
}

std::vector<std::size_t> stages_of(const std::vector<std::size_t>& nodes, const Graph& graph,
                                   const Registry& registry) {
    const auto ranks = ranks_of(graph);
    const auto rehearses = [&](std::size_t node) { return registry.find(graph.nodes[node].kind)->run.rehearses; };
    std::vector<std::size_t> stages;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const bool together =
            i > 0 && ranks[nodes[i]] == ranks[nodes[i - 1]] && !rehearses(nodes[i]) && !rehearses(nodes[i - 1]);
        stages.push_back(together ? stages.back() : i);
    }
    return stages;
}

std::vector<bool> renewed_nodes(const Graph& graph, const Registry& registry) {
    const Edges edges = edges_of(graph);
    std::vector<bool> changes(graph.nodes.size()), renewed(graph.nodes.size());
    for (const auto node : leaves_first(edges)) {
        const auto& needed = edges.needed[node];
        const auto& run = registry.find(graph.nodes[node].kind)->run;
        changes[node] = run.passes || std::any_of(needed.begin(), needed.end(), [&](auto i) { return changes[i]; });
        renewed[node] = changes[node] && run.prepares;
    }
    return renewed;
}

std::vector<Tile> rehearsal_tiles(const Graph& graph, const Registry& registry, std::uint32_t stride,
                                  std::uint32_t pass) {
    if (stride == 0) throw Error("a rehearsal's stride must be at least 1");
    const auto film = film_of(graph, registry);
    constexpr std::uint32_t wanted_pixels = 16, longest = 256;
    const std::uint32_t side = std::min(longest, wanted_pixels * std::min(stride, longest));
    std::vector<Tile> tiles;
    for (std::uint32_t y = 0; y < film.height; y += side)
        for (std::uint32_t x = 0; x < film.width; x += side)
            tiles.push_back({x, y, std::min(side, film.width - x), std::min(side, film.height - y),
                             pass * samples_per_block, 1, stride});
    return tiles;
}

Bytes rehearsal_result(const std::vector<Query>& noted) {
    const auto bytes = std::as_bytes(std::span(noted));
    const std::vector<std::byte> shard(bytes.begin(), bytes.end());
    return join_shards(std::span(&shard, 1));
}

namespace {

// Where something stands in its file changes nothing.
std::string text_of(Graph graph) {
    graph.file.clear();
    for (auto& node : graph.nodes) node.where = {};
    return to_json(graph);
}

// What the graph changes about the scene, without who looks.
std::string scene_text(const Graph& graph) {
    Graph scenes;
    for (Node node : graph.nodes) {
        if (node.kind != "Scene") continue;
        for (const char* sight : {"camera", "next_camera", "previous_camera"}) node.params.erase(sight);
        scenes.nodes.push_back(std::move(node));
    }
    return text_of(std::move(scenes));
}

}  // namespace

void leave_film_out(Node& image, const Kind& kind) {
    for (const auto& param : kind.params)
        if (param.type == ParamType::film || param.name == "samples" || param.name == "error")
            image.params.erase(param.name);
}

std::string text_of_light(const Graph& graph, const Registry& registry) {
    const auto used = used_nodes(graph, renderer_of(graph, registry));
    Graph light;
    for (std::size_t i = 0; i < written_nodes(graph); ++i) {
        if (!used[i]) continue;
        Node& node = light.nodes.emplace_back(graph.nodes[i]);
        const Kind& kind = *registry.find(node.kind);
        if (kind.role == Role::scene) node.entries.clear(), node.params.clear();
        if (kind.role == Role::image) leave_film_out(node, kind);
    }
    const auto film = film_of(graph, registry);
    return text_of(std::move(light)) + '\n' + std::to_string(film.width) + ' ' + std::to_string(film.height);
}

Hash hash_of_read(const MadeFrom& made_from, const std::vector<bool>& used, SceneParts more) {
    GroupSet lamps = more.contain(ScenePart::lamps) ? all_groups : 0;
    for (std::size_t i = 0; i < made_from.reads.size(); ++i)
        if (used[i]) {
            more |= made_from.reads[i];
            if (made_from.reads[i].contain(ScenePart::lamps)) lamps |= made_from.lamps[i];
        }
    return made_from.scene->of(more, lamps);
}

Recipes::Recipes(const Graph& graph, MadeFrom made_from) : graph_(graph), made_from_(std::move(made_from)) {
    whole_ = made_from_.scene ? made_from_.light : text_of(written(graph));
    whole_ += '\n' + text_of_scene(std::vector<bool>(graph.nodes.size(), true));
    for (std::size_t node = 0; node < written_nodes(graph); ++node) {
        const auto used = used_nodes(graph, node);
        Graph part;
        for (std::size_t i = 0; i < written_nodes(graph); ++i)
            if (used[i]) part.nodes.push_back(graph.nodes[i]);
        subgraph_.push_back(text_of(std::move(part)) + '\n' + text_of_scene(used));
    }
}

std::string Recipes::text_of_scene(const std::vector<bool>& used) const {
    if (!made_from_.scene) return made_from_.files + '\n' + scene_text(graph_);
    return to_hex(hash_of_read(made_from_, used));
}

Hash Recipes::of(std::size_t node, std::uint32_t call, bool rehearsed, const std::string& part) const {
    return content_hash(made_from_.run + '\n' + graph_.nodes[node].name + '\n' + std::to_string(call) + '\n' +
                        (rehearsed ? whole_ : subgraph_[node]) + part);
}

}  // namespace lightnet
