#include "core/graph/json.hpp"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <limits>

#include "core/graph/graph.hpp"
#include "core/graph/hosts.hpp"
#include "core/graph/layout.hpp"
#include "core/graph/plan.hpp"

// Everything is written by hand and read by exact shape: what has more or fewer keys than it should is not ours.
namespace lightnet {
namespace {

using Json = nlohmann::json;  // its objects are sorted by key, hence the text canonical

constexpr std::size_t most_bytes = std::size_t{16} << 20;
constexpr int most_depth = 32;

[[noreturn]] void malformed(const std::string& what) { throw Error("malformed JSON", what); }

Json parse(std::string_view text) {
    if (text.size() > most_bytes) malformed("more than 16 MiB");
    const auto guard = [](int depth, Json::parse_event_t, Json&) {
        if (depth > most_depth) malformed("nested too deeply");
        return true;
    };
    try {
        return Json::parse(text, guard);
    } catch (const Json::exception& error) {
        malformed(error.what());
    }
}

std::string dump(const Json& json) {
    try {
        return json.dump();
    } catch (const Json::exception&) {
        throw Error("a text in it is not UTF-8");
    }
}

const Json& member(const Json& object, const char* key) {
    const auto at = object.find(key);
    if (at == object.end()) malformed(std::string("no '") + key + "'");
    return *at;
}

const Json& object_of(const Json& json, std::size_t keys) {
    if (!json.is_object() || json.size() != keys) malformed("an object with other keys was expected");
    return json;
}

const Json& array_of(const Json& json) {
    if (!json.is_array()) malformed("an array was expected");
    return json;
}

const std::string& text_of(const Json& json) {
    if (!json.is_string()) malformed("a text was expected");
    return json.get_ref<const std::string&>();
}

template <class Integer>
Integer integer_of(const Json& json) {
    if (!json.is_number_integer()) malformed("an integer was expected");
    if (!json.is_number_unsigned() ||
        json.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<Integer>::max()))
        malformed("an integer is out of range");
    return json.get<Integer>();
}

Json json_of(const SourceLine& where) { return Json::array({where.file, where.line}); }

SourceLine where_of(const Json& json) {
    if (array_of(json).size() != 2) malformed("a file and a line were expected");
    return {text_of(json[0]), integer_of<int>(json[1])};
}

// JSON has no name for what isn't finite.
Json json_of(double number) {
    if (std::isfinite(number)) return number;
    return {{"number", std::isnan(number) ? "nan" : number > 0 ? "inf" : "-inf"}};
}

double odd_number_of(const std::string& name) {
    if (name == "nan") return std::numeric_limits<double>::quiet_NaN();
    if (name == "inf") return std::numeric_limits<double>::infinity();
    if (name == "-inf") return -std::numeric_limits<double>::infinity();
    malformed("'" + name + "' is no number");
}

Json json_of(const Value& value);

Json json_of(const List& list) {
    Json json = Json::array();
    for (const auto& value : list) json.push_back(json_of(value));
    return json;
}

Json json_of(const std::map<std::string, Value>& named) {
    Json json = Json::object();
    for (const auto& [name, value] : named) json[name] = json_of(value);
    return json;
}

struct ToJson {
    Json operator()(bool flag) const { return flag; }
    Json operator()(double number) const { return json_of(number); }
    Json operator()(const std::string& text) const { return text; }
    Json operator()(const NodeRef& ref) const { return {{"node", ref.name}}; }
    Json operator()(const Table& table) const {
        return {{"list", json_of(table.list)}, {"named", json_of(table.named)}};
    }
};

Json json_of(const Value& value) { return std::visit(ToJson{}, value.data); }

Value value_of(const Json& json);

List list_of(const Json& json) {
    List list;
    for (const auto& value : array_of(json)) list.push_back(value_of(value));
    return list;
}

std::map<std::string, Value> named_of(const Json& json) {
    if (!json.is_object()) malformed("an object was expected");
    std::map<std::string, Value> named;
    for (const auto& [name, value] : json.items()) named.emplace(name, value_of(value));
    return named;
}

Value value_of(const Json& json) {
    if (json.is_boolean()) return {json.get<bool>()};
    if (json.is_number()) return {json.get<double>()};
    if (json.is_string()) return {text_of(json)};
    if (!json.is_object()) malformed("a value was expected");
    if (json.contains("node")) return {NodeRef{text_of(member(object_of(json, 1), "node"))}};
    if (json.contains("number")) return {odd_number_of(text_of(member(object_of(json, 1), "number")))};
    object_of(json, 2);
    return {Table{list_of(member(json, "list")), named_of(member(json, "named"))}};
}

Json json_of(const Node& node) {
    return {{"name", node.name},
            {"kind", node.kind},
            {"entries", json_of(node.entries)},
            {"params", json_of(node.params)},
            {"where", json_of(node.where)}};
}

Node node_of(const Json& json) {
    object_of(json, 5);
    return {text_of(member(json, "name")), text_of(member(json, "kind")), list_of(member(json, "entries")),
            named_of(member(json, "params")), where_of(member(json, "where"))};
}

HostEntry host_of(const Json& json) {
    object_of(json, 4);
    HostEntry host{text_of(member(json, "endpoint")),
                   {},
                   integer_of<int>(member(json, "places")),
                   where_of(member(json, "where"))};
    const auto& replicas = member(json, "replicas");
    if (!replicas.is_object()) malformed("an object was expected");
    for (const auto& [name, count] : replicas.items()) host.replicas.emplace(name, integer_of<int>(count));
    return host;
}

Strategy strategy_of(const Json& json) {
    const auto strategy = strategy_called(text_of(json));
    if (!strategy) malformed("'" + text_of(json) + "' is no strategy");
    return *strategy;
}

void take_strategies(const Json& json, Plan& plan) {
    if (!json.is_object()) malformed("an object was expected");
    for (const auto& [node, strategy] : json.items()) {
        std::uint32_t index = 0;
        const auto [end, fault] = std::from_chars(node.data(), node.data() + node.size(), index);
        if (fault != std::errc{} || end != node.data() + node.size()) malformed("'" + node + "' is no node");
        plan.strategies[index] = strategy_of(strategy);
    }
}

Json json_of(const std::vector<ChoiceEntry>& choices) {
    Json json = Json::array();
    for (const auto& entry : choices)
        json.push_back({{"node", entry.node}, {"name", entry.name}, {"where", json_of(entry.where)}});
    return json;
}

ChoiceEntry choice_of(const Json& json) {
    object_of(json, 3);
    return {text_of(member(json, "node")), text_of(member(json, "name")), where_of(member(json, "where"))};
}

}  // namespace

std::string to_json(const Graph& graph) {
    Json nodes = Json::array();
    for (std::size_t i = 0; i < written_nodes(graph); ++i) nodes.push_back(json_of(graph.nodes[i]));
    Json json{{"file", graph.file}, {"nodes", std::move(nodes)}};
    if (!graph.sectors.empty()) json["shards"] = shards_in(graph);
    return dump(json);
}

Graph graph_from_json(std::string_view text) {
    const Json json = parse(text);
    const bool has_shards = json.is_object() && json.contains("shards");
    object_of(json, has_shards ? 3 : 2);
    Graph graph{text_of(member(json, "file")), {}};
    for (const auto& node : array_of(member(json, "nodes"))) graph.nodes.push_back(node_of(node));
    if (!has_shards) return graph;
    std::map<std::string, std::uint32_t> shards;
    const auto& counts = member(json, "shards");
    if (!counts.is_object()) malformed("an object was expected");
    for (const auto& [name, count] : counts.items()) shards.emplace(name, integer_of<std::uint32_t>(count));
    return sharded(std::move(graph), shards);
}

std::string to_json(const Hosts& hosts) {
    Json list = Json::array();
    for (const auto& host : hosts.hosts)
        list.push_back({{"endpoint", host.endpoint},
                        {"replicas", host.replicas},
                        {"places", host.places},
                        {"where", json_of(host.where)}});
    return dump({{"file", hosts.file},
                 {"hosts", std::move(list)},
                 {"strategies", json_of(hosts.strategies)},
                 {"layouts", json_of(hosts.layouts)}});
}

Hosts hosts_from_json(std::string_view text) {
    const Json json = parse(text);
    object_of(json, 4);
    Hosts hosts{text_of(member(json, "file")), {}};
    for (const auto& host : array_of(member(json, "hosts"))) hosts.hosts.push_back(host_of(host));
    for (const auto& entry : array_of(member(json, "strategies"))) hosts.strategies.push_back(choice_of(entry));
    for (const auto& entry : array_of(member(json, "layouts"))) hosts.layouts.push_back(choice_of(entry));
    return hosts;
}

std::string to_json(const Plan& plan) {
    Json places = Json::array();
    for (const auto& place : plan.places) places.push_back(Json::array({place.host, place.index}));
    Json strategies = Json::object();
    for (const auto& [node, strategy] : plan.strategies) strategies[std::to_string(node)] = name_of(strategy);
    return dump({{"places", std::move(places)},
                 {"places_of", plan.places_of},
                 {"strategy", name_of(plan.strategy)},
                 {"strategies", std::move(strategies)},
                 {"processes", plan.processes}});
}

Plan plan_from_json(std::string_view text) {
    const Json json = parse(text);
    object_of(json, 5);
    Plan plan;
    for (const auto& place : array_of(member(json, "places"))) {
        if (array_of(place).size() != 2) malformed("a host and an index were expected");
        plan.places.push_back({text_of(place[0]), integer_of<std::uint32_t>(place[1])});
    }
    for (const auto& places : array_of(member(json, "places_of"))) {
        auto& held = plan.places_of.emplace_back();
        for (const auto& place : array_of(places)) {
            held.push_back(integer_of<std::uint32_t>(place));
            if (held.back() >= plan.places.size()) malformed("a node is held by a place that isn't there");
        }
    }
    plan.strategy = strategy_of(member(json, "strategy"));
    take_strategies(member(json, "strategies"), plan);
    const Json& processes = member(json, "processes");
    object_of(processes, processes.size());
    for (const auto& [host, process] : processes.items()) plan.processes[host] = integer_of<std::uint64_t>(process);
    return plan;
}

std::string to_json(const std::vector<Problem>& problems) {
    Json list = Json::array();
    for (const auto& problem : problems) list.push_back(Json::array({json_of(problem.where), problem.what}));
    return list.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<Problem> problems_from_json(std::string_view text) {
    const Json json = parse(text);
    std::vector<Problem> problems;
    for (const auto& problem : array_of(json)) {
        if (array_of(problem).size() != 2) malformed("a line and a text were expected");
        problems.push_back({where_of(problem[0]), text_of(problem[1])});
    }
    return problems;
}

bool is_utf8(std::string_view text) {
    try {
        static_cast<void>(Json(text).dump());
        return true;
    } catch (const Json::exception&) {
        return false;
    }
}

}  // namespace lightnet
