#include "tools/cli/schema_text.hpp"

#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

#include "core/base/json_tree.hpp"

namespace lightnet {
namespace {

JsonTree json_of_value(const Value& value) {
    return std::visit(
        [](const auto& data) -> JsonTree {
            using Type = std::decay_t<decltype(data)>;
            if constexpr (std::is_same_v<Type, NodeRef>) {
                return data.name;
            } else if constexpr (std::is_same_v<Type, Table>) {
                JsonTree json = data.named.empty() ? JsonTree::list() : JsonTree::object();
                if (data.named.empty())
                    for (const auto& entry : data.list) json.push_back(json_of_value(entry));
                for (const auto& [name, entry] : data.named) json[name] = json_of_value(entry);
                return json;
            } else {
                return data;
            }
        },
        value.data);
}

JsonTree json_of_param(const Param& param) {
    JsonTree json{{"type", to_string(param.type)}, {"help", param.help}};
    if (!param.unit.empty()) json["unit"] = param.unit;
    if (param.initial) json["default"] = json_of_value(*param.initial);
    json["optional"] = param.optional || param.initial.has_value();
    if (std::isfinite(param.least)) json["least"] = param.least;
    if (std::isfinite(param.most)) json["most"] = param.most;
    if (!param.choices.empty()) json["choices"] = param.choices;
    if (param.count) json["count"] = param.count;
    if (param.per_input) json["per_input"] = true;
    for (const auto& field : param.fields) json["fields"][field.name] = json_of_param(field);
    return json;
}

JsonTree json_of_kind(const Kind& kind) {
    JsonTree inputs{{"least", kind.inputs.least}};
    if (kind.inputs.most < std::numeric_limits<std::size_t>::max()) inputs["most"] = kind.inputs.most;
    JsonTree json{{"gives", to_string(kind.role)}, {"help", kind.help}, {"inputs", inputs}};
    if (!kind.plugin.empty()) json["plugin"] = kind.plugin;
    json["params"] = JsonTree::object();
    for (const auto& param : kind.params) json["params"][param.name] = json_of_param(param);
    return json;
}

// As the language server writes types.
std::string lua_type_of(const Param& param) {
    switch (param.type) {
        case ParamType::number:
            return "number";
        case ParamType::integer:
            return "integer";
        case ParamType::flag:
            return "boolean";
        case ParamType::text: {
            if (param.choices.empty()) return "string|function";
            std::string type;
            for (const auto& choice : param.choices) type += (type.empty() ? "\"" : "|\"") + choice + "\"";
            return type;
        }
        case ParamType::numbers:
            return "number[]";
        case ParamType::surrounding:
            return "string|number[]";
        case ParamType::table:
        case ParamType::film:
            return "table";
        case ParamType::scene:
        case ParamType::node:
            return "lightnet.Node";
        case ParamType::nodes:
            return "lightnet.Node[]";
        case ParamType::names:
            return "string|string[]";
        case ParamType::named_lists:
            return "table<string, string|string[]>";
        case ParamType::named_colours:
            return "table<string, number|number[]>";
    }
    return "any";
}

std::string definition_of(const Kind& kind) {
    const std::string params = "lightnet." + kind.name;
    std::string text = "\n---@class (exact) " + params + "\n";
    if (kind.role == Role::scene)
        text += "---@field [1] string the name of its file\n";
    else if (kind.inputs.most > 0)
        text += "---@field [integer] lightnet.Node inputs\n";
    for (const auto& param : kind.params) {
        const bool may_lack = param.optional || param.initial;
        text += "---@field " + param.name + (may_lack ? "? " : " ") + lua_type_of(param) + " " + param.help;
        if (!param.unit.empty()) text += ", in " + param.unit;
        if (param.initial) text += "; default " + to_string(*param.initial);
        text += "\n";
    }
    return text + "\n---" + kind.help + "\n---@param entries " + params + "\n---@return lightnet.Node\nfunction " +
           kind.name + "(entries) end\n";
}

}  // namespace

std::string schema_json(const std::vector<Kind>& kinds) {
    JsonTree json = JsonTree::object();
    for (const auto& kind : kinds) json[kind.name] = json_of_kind(kind);
    return to_text(json, {.indent = 2, .strict = true}) + "\n";
}

std::string lua_definitions(const std::vector<Kind>& kinds) {
    std::string text =
        "---@meta lightnet\n-- What a graph file may use: lightnet describe --meta > lightnet.lua\n\n"
        "---@class lightnet.Node\n";
    for (const auto& kind : kinds) text += definition_of(kind);
    return text;
}

std::string luacheck_settings(const std::vector<Kind>& kinds) {
    std::string names;
    for (const auto& kind : kinds) names += "    \"" + kind.name + "\",\n";
    return "-- For graph and hosts files: lightnet describe --luacheck > .luacheckrc\nstd = \"lua54\"\n"
           "allow_defined_top = true\nread_globals = {\n" +
           names +
           "    \"place\", \"strategy\", \"layout\",\n"
           "    \"hemisphere\", \"dot\", \"cross\", \"length\", \"normalize\", \"sqrt\", \"abs\", \"floor\", \"min\", "
           "\"max\",\n"
           "    \"less\", \"where\", \"vec\",\n}\nunused_args = false\n";
}

}  // namespace lightnet
