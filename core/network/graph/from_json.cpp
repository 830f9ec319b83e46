// Reads what json.cpp writes, by exact shape: what has more or fewer members than it should is not ours.
#include <charconv>
#include <limits>

#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/json.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"

namespace lightnet {
namespace {

constexpr JsonLimits plan_limits{.values = 2'000'000};  // each node times the places that hold it

[[noreturn]] void malformed(const std::string& what) { throw Error("malformed JSON", what); }

SourceLine where_of(const Json& json) {
    const auto& place = json.list(2);
    return {text_from_json(place[0]), place[1].whole<int>()};
}

// JSON has no name for what isn't finite.
double odd_number_of(const std::string& name) {
    if (name == "nan") return std::numeric_limits<double>::quiet_NaN();
    if (name == "inf") return std::numeric_limits<double>::infinity();
    if (name == "-inf") return -std::numeric_limits<double>::infinity();
    malformed("'" + name + "' is no number");
}

Value value_of(const Json& json);

List list_of(const Json& json) {
    List list;
    for (const auto& value : json.list()) list.push_back(value_of(value));
    return list;
}

std::map<std::string, Value> named_of(const Json& json) {
    std::map<std::string, Value> named;
    for (const auto& [name, value] : json.object()) named.emplace(name, value_of(value));
    return named;
}

Value value_of(const Json& json) {
    if (std::holds_alternative<bool>(json.data)) return {json.flag()};
    if (std::holds_alternative<std::string>(json.data)) return {json.text()};
    if (!json.is_object()) return {json.number()};
    if (json.has("bytes")) return {text_from_json(json)};
    const bool node = json.has("node"), number = json.has("number");
    json.object(node || number ? 1 : 2);
    if (node) return {NodeRef{json.at("node").text()}};
    if (number) return {odd_number_of(json.at("number").text())};
    return {Table{list_of(json.at("list")), named_of(json.at("named"))}};
}

Node node_of(const Json& json) {
    json.object(5);
    return {json.at("name").text(), json.at("kind").text(), list_of(json.at("entries")), named_of(json.at("params")),
            where_of(json.at("where"))};
}

HostEntry host_of(const Json& json) {
    json.object(5);
    HostEntry host{json.at("endpoint").text(),
                   {},
                   json.at("places").whole<int>(),
                   where_of(json.at("where")),
                   json.at("key").text()};
    for (const auto& [name, count] : json.at("replicas").object()) host.replicas.emplace(name, count.whole<int>());
    return host;
}

Strategy strategy_of(const Json& json) {
    const auto strategy = strategy_called(json.text());
    if (!strategy) malformed("'" + json.text() + "' is no strategy");
    return *strategy;
}

void take_strategies(const Json& json, Plan& plan) {
    for (const auto& [node, strategy] : json.object()) {
        std::uint32_t index = 0;
        const auto [end, fault] = std::from_chars(node.data(), node.data() + node.size(), index);
        if (fault != std::errc{} || end != node.data() + node.size()) malformed("'" + node + "' is no node");
        plan.strategies[index] = strategy_of(strategy);
    }
}

ChoiceEntry choice_of(const Json& json) {
    json.object(3);
    return {json.at("node").text(), json.at("name").text(), where_of(json.at("where"))};
}

int digit_of(char c) {
    if ('0' <= c && c <= '9') return c - '0';
    if ('a' <= c && c <= 'f') return c - 'a' + 10;
    malformed("bytes are written by digits of base 16");
}

}  // namespace

std::string text_from_json(const Json& json) {
    if (!json.is_object()) return json.text();
    json.object(1);
    const auto& digits = json.at("bytes").text();
    if (digits.size() % 2) malformed("half of a byte");
    std::string bytes;
    for (std::size_t i = 0; i < digits.size(); i += 2)
        bytes += static_cast<char>(digit_of(digits[i]) * 16 + digit_of(digits[i + 1]));
    return bytes;
}

Graph graph_from_json(const Json& json) {
    const bool has_shards = json.has("shards");
    json.object(has_shards ? 3 : 2);
    Graph graph{text_from_json(json.at("file")), {}};
    for (const auto& node : json.at("nodes").list()) {
        if (graph.nodes.size() >= most_nodes) malformed("a graph has at most " + std::to_string(most_nodes) + " nodes");
        graph.nodes.push_back(node_of(node));
    }
    if (!has_shards) return graph;
    std::map<std::string, std::uint32_t> shards;
    for (const auto& [name, count] : json.at("shards").object()) shards.emplace(name, count.whole<std::uint32_t>());
    return sharded(std::move(graph), shards);
}

Graph graph_from_json(std::string_view text) { return graph_from_json(parse_json(text)); }

Hosts hosts_from_json(std::string_view text) {
    const Json json = parse_json(text);
    json.object(4);
    Hosts hosts{text_from_json(json.at("file")), {}};
    for (const auto& host : json.at("hosts").list()) hosts.hosts.push_back(host_of(host));
    for (const auto& entry : json.at("strategies").list()) hosts.strategies.push_back(choice_of(entry));
    for (const auto& entry : json.at("layouts").list()) hosts.layouts.push_back(choice_of(entry));
    return hosts;
}

Plan plan_from_json(std::string_view text) {
    const Json json = parse_json(text, plan_limits);
    json.object(6);
    Plan plan;
    for (const auto& place : json.at("places").list()) {
        const auto& at = place.list(2);
        plan.places.push_back({at[0].text(), at[1].whole<std::uint32_t>()});
    }
    for (const auto& places : json.at("places_of").list()) {
        auto& held = plan.places_of.emplace_back();
        for (const auto& place : places.list()) {
            held.push_back(place.whole<std::uint32_t>());
            if (held.back() >= plan.places.size()) malformed("a node is held by a place that isn't there");
        }
    }
    plan.strategy = strategy_of(json.at("strategy"));
    take_strategies(json.at("strategies"), plan);
    for (const auto& [host, process] : json.at("processes").object())
        plan.processes[host] = process.whole<std::uint64_t>();
    plan.edition = json.at("edition").whole<std::uint32_t>();
    return plan;
}

std::vector<Problem> problems_from_json(std::string_view text) {
    const Json json = parse_json(text);
    std::vector<Problem> problems;
    for (const auto& entry : json.list()) {
        const auto& problem = entry.list(2);
        problems.push_back({where_of(problem[0]), text_from_json(problem[1])});
    }
    return problems;
}

}  // namespace lightnet
