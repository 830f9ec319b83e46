#include "tools/request/graph_edits.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/suggestion.hpp"

namespace lightnet {
namespace {

const SourceLine by_edit{"edit", 0};

bool is_null(const Json& json) { return std::holds_alternative<std::monostate>(json.data); }

// As a graph file would have it: lists and objects are tables.
Value value_of(const Json& json) {
    if (const auto* flag = std::get_if<bool>(&json.data)) return {*flag};
    if (const auto* text = std::get_if<std::string>(&json.data)) return {*text};
    Table table;
    if (json.is_object()) {
        for (const auto& [name, value] : json.object()) table.named.emplace(name, value_of(value));
        return {std::move(table)};
    }
    if (!std::holds_alternative<Json::List>(json.data)) return {json.number()};
    for (const auto& value : json.list()) table.list.push_back(value_of(value));
    return {std::move(table)};
}

std::optional<Value> value_or_none(const Json& json) {
    if (is_null(json)) return std::nullopt;
    return value_of(json);
}

// As one would type it behind -D.
std::string text_of(const std::string& name, const Json& json) {
    const Value value = value_of(json);
    if (const auto* text = std::get_if<std::string>(&value.data)) return *text;
    if (std::holds_alternative<Table>(value.data)) throw Error("constant '" + name + "' must be a number or a text");
    return to_string(value);
}

void take_member(const std::string& name, const Json& value, Edit& edit) {
    if (name == "end") edit.end = value.flag();
    if (name == "camera") edit.camera = value_or_none(value);
    if (name == "scene") edit.scene = is_null(value) ? "" : value.text();
    if (name == "set")
        for (const auto& [param, set] : value.object()) edit.params[param] = value_or_none(set);
    if (name == "constants")
        for (const auto& [constant, set] : value.object())
            edit.constants[constant] = is_null(set) ? std::nullopt : std::optional(text_of(constant, set));
}

template <class Changes, class Values>
void merge(const Changes& changes, Values& values) {
    for (const auto& [name, value] : changes)
        if (value)
            values.insert_or_assign(name, *value);
        else
            values.erase(name);
}

std::vector<std::string> names_of(const Graph& graph) {
    std::vector<std::string> names;
    for (const auto& node : graph.nodes) names.push_back(node.name);
    return names;
}

void set_param(const std::string& path, const Value& value, Graph& graph, std::vector<Problem>& problems) {
    const auto dot = path.find('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == path.size()) {
        problems.push_back({by_edit, "'set' names a parameter as node.parameter, not " + in_quotes(path)});
        return;
    }
    const auto name = path.substr(0, dot);
    const auto node = graph.find(name);
    if (!node) {
        problems.push_back({by_edit, "there is no node " + in_quotes(name) + did_you_mean(name, names_of(graph))});
        return;
    }
    graph.nodes[*node].params[path.substr(dot + 1)] = value;
}

}  // namespace

std::string id_of(std::string_view line) try {
    const Json json = parse_json(line);
    return json.is_object() && json.has("id") ? to_text(JsonTree(json.at("id"))) : "";
} catch (const JsonError&) {
    return "";
}

Edit edit_of(std::string_view line) {
    const std::vector<std::string> known{"id", "end", "set", "camera", "scene", "constants"};
    const Json json = parse_json(line);
    Edit edit;
    for (const auto& [name, value] : json.object()) {
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw Error("an edit has no member " + in_quotes(name) + did_you_mean(name, known));
        try {
            take_member(name, value, edit);
        } catch (const JsonError& error) {
            throw Error(in_quotes(name) + ": " + error.what());
        }
    }
    return edit;
}

void take(const Edit& edit, GraphEdits& edits) {
    merge(edit.constants, edits.constants);
    merge(edit.params, edits.params);
    if (edit.camera) edits.camera = *edit.camera;
    if (edit.scene) edits.scene = *edit.scene;
}

void apply(const GraphEdits& edits, const Registry& registry, Graph& graph, std::vector<Problem>& problems) {
    for (auto& node : graph.nodes) {
        const Kind* kind = registry.find(node.kind);
        if (!kind || kind->role != Role::scene) continue;
        if (edits.camera) node.params["camera"] = *edits.camera;
        if (!edits.scene.empty()) node.entries = {Value{std::filesystem::absolute(edits.scene).string()}};
    }
    for (const auto& [path, value] : edits.params) set_param(path, value, graph, problems);
}

}  // namespace lightnet
