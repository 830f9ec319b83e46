#include "core/network/graph/json.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/json_tree.hpp"
#include "core/base/printable.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"

// How values become texts. from_json.cpp reads them.
namespace lightnet {
namespace {

using Tree = JsonTree;

std::string dump(const Tree& json) { return to_text(json, {.by_name = true, .strict = true}); }

// Texts may be names of files, which are bytes.
Tree json_of(const std::string& text) {
    if (is_utf8(text)) return text;
    constexpr std::string_view digits = "0123456789abcdef";
    std::string bytes;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        (bytes += digits[byte >> 4]) += digits[byte & 15];
    }
    return {{"bytes", std::move(bytes)}};
}

Tree json_of(const SourceLine& where) { return Tree({json_of(where.file), where.line}); }

// JSON has no name for what isn't finite.
Tree json_of(double number) {
    if (std::isfinite(number)) return number;
    return {{"number", std::isnan(number) ? "nan" : number > 0 ? "inf" : "-inf"}};
}

Tree json_of(const Value& value);

Tree json_of(const List& list) {
    Tree json = Tree::list();
    for (const auto& value : list) json.push_back(json_of(value));
    return json;
}

Tree json_of(const std::map<std::string, Value>& named) {
    Tree json = Tree::object();
    for (const auto& [name, value] : named) json[name] = json_of(value);
    return json;
}

struct ToJson {
    Tree operator()(bool flag) const { return flag; }
    Tree operator()(double number) const { return json_of(number); }
    Tree operator()(const std::string& text) const { return json_of(text); }
    Tree operator()(const NodeRef& ref) const { return {{"node", ref.name}}; }
    Tree operator()(const Table& table) const {
        return {{"list", json_of(table.list)}, {"named", json_of(table.named)}};
    }
};

Tree json_of(const Value& value) { return std::visit(ToJson{}, value.data); }

Tree json_of(const Node& node) {
    return {{"name", node.name},
            {"kind", node.kind},
            {"entries", json_of(node.entries)},
            {"params", json_of(node.params)},
            {"where", json_of(node.where)}};
}

Tree json_of(const std::vector<ChoiceEntry>& choices) {
    Tree json = Tree::list();
    for (const auto& entry : choices)
        json.push_back({{"node", entry.node}, {"name", entry.name}, {"where", json_of(entry.where)}});
    return json;
}

}  // namespace

std::string to_json(const Graph& graph) {
    Tree nodes = Tree::list();
    for (std::size_t i = 0; i < written_nodes(graph); ++i) nodes.push_back(json_of(graph.nodes[i]));
    Tree json{{"file", json_of(graph.file)}, {"nodes", std::move(nodes)}};
    if (!graph.sectors.empty()) json["shards"] = shards_in(graph);
    return dump(json);
}

std::string to_json(const Hosts& hosts) {
    Tree list = Tree::list();
    for (const auto& host : hosts.hosts)
        list.push_back({{"endpoint", host.endpoint},
                        {"key", host.key},
                        {"replicas", host.replicas},
                        {"places", host.places},
                        {"where", json_of(host.where)}});
    return dump({{"file", json_of(hosts.file)},
                 {"hosts", std::move(list)},
                 {"strategies", json_of(hosts.strategies)},
                 {"layouts", json_of(hosts.layouts)}});
}

std::string to_json(const Plan& plan) {
    Tree places = Tree::list();
    for (const auto& place : plan.places) places.push_back(Tree({place.host, place.index}));
    Tree strategies = Tree::object();
    for (const auto& [node, strategy] : plan.strategies) strategies[std::to_string(node)] = name_of(strategy);
    return dump({{"places", std::move(places)},
                 {"places_of", plan.places_of},
                 {"strategy", name_of(plan.strategy)},
                 {"strategies", std::move(strategies)},
                 {"processes", plan.processes},
                 {"edition", plan.edition}});
}

std::string to_json(const std::vector<Problem>& problems) {
    Tree list = Tree::list();
    for (const auto& problem : problems) list.push_back(Tree({json_of(problem.where), json_of(problem.what)}));
    return dump(list);
}

JsonTree tree_of_text(const std::string& text) { return json_of(text); }

}  // namespace lightnet
