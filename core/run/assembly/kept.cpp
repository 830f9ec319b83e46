#include "core/run/assembly/kept.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/words_of.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/run/assembly/prepared.hpp"

namespace lightnet {
namespace {

constexpr std::string_view first_line = "lightnet kept 1";
constexpr std::size_t longest_head = 1024;

template <class T>
const T* param_of(const Node& node, const char* name) {
    const auto found = node.params.find(name);
    return found == node.params.end() ? nullptr : std::get_if<T>(&found->second.data);
}

std::string text_of(const Node& node, const char* name) {
    const auto* text = param_of<std::string>(node, name);
    return text ? *text : "";
}

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The rest of the line that begins with `word`.
std::string after(const std::string& head, const std::string& word) {
    const auto at = head.find("\n" + word + " ");
    if (at == std::string::npos) return "";
    const auto begin = at + word.size() + 2;
    return head.substr(begin, head.find('\n', begin) - begin);
}

}  // namespace

std::string kept_text(const Kind& kind, const Hash& scene, std::span<const std::byte> results) {
    return std::string(first_line) + "\nwhat " + kind.run.freezes + "\nscene " + to_hex(scene) + "\nsum " +
           to_hex(content_hash(results)) + "\n\n" + std::string(as_text(results));
}

Bytes kept_results(const Kind& kind, const Hash& scene, std::span<const std::byte> file) {
    const auto text = as_text(file);
    const auto end = text.substr(0, longest_head).find("\n\n");
    if (!text.starts_with(first_line) || end == std::string_view::npos) throw Error("is no file that a run has kept");
    const std::string head(text.substr(0, end + 1));
    if (const auto what = after(head, "what"); what != kind.run.freezes)
        throw Error("keeps " + what + ", but " + kind.run.freezes + " are wanted");
    if (after(head, "scene") != to_hex(scene))
        throw Error("belongs to another scene: its surfaces, materials or lights differ from those here");
    const auto results = file.subspan(end + 2);
    if (after(head, "sum") != to_hex(content_hash(results))) throw Error("is damaged");
    return bytes_of(results);
}

bool goes_on_from_kept(const Graph& graph, const Registry& registry) {
    return std::any_of(graph.nodes.begin(), graph.nodes.end(), [&](const Node& node) {
        const Kind* kind = registry.find(node.kind);
        return kind && kind->run.keeps && !text_of(node, "extend").empty();
    });
}

KeptResults read_kept(const Graph& graph, const Registry& registry, Files& files, const SceneData& scene,
                      std::vector<Problem>& problems) {
    KeptResults kept;
    std::optional<Hash> identity;
    for (const auto& node : graph.nodes) {
        const Kind* kind = registry.find(node.kind);
        const auto name = text_of(node, "extend");
        if (!kind || !kind->run.keeps || name.empty()) continue;
        const auto path = beside_graph(graph, name);
        try {
            if (!identity) identity = identity_of(scene);
            kept[node.name] = kept_results(*kind, *identity, *files.read(path));
        } catch (const std::exception& error) {
            const std::string what = words_of(error);
            const bool says_path = what.find(path) != std::string::npos;
            problems.push_back({node.where, node.kind + " '" + node.name +
                                                "': 'extend': " + (says_path ? "" : "'" + path + "' ") + what});
        }
    }
    return kept;
}

std::vector<std::pair<std::size_t, std::string>> files_to_keep(const Graph& graph, const Registry& registry) {
    std::vector<std::pair<std::size_t, std::string>> files;
    for (const auto node : preparing_nodes(graph, registry))
        if (const auto name = text_of(graph.nodes[node], "keep");
            registry.find(graph.nodes[node].kind)->run.keeps && !name.empty())
            files.emplace_back(node, beside_graph(graph, name));
    return files;
}

}  // namespace lightnet
