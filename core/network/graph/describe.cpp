#include "core/network/graph/describe.hpp"

#include "core/network/graph/light_paths.hpp"

#include <algorithm>
#include <limits>

namespace lightnet {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

std::string padded(std::string text, std::size_t width) {
    text.resize(std::max(text.size(), width), ' ');
    return text;
}

std::string inputs_text(const Kind& kind) {
    if (kind.role == Role::scene) return "the name of one file";
    const std::size_t least = kind.inputs.least, most = kind.inputs.most;
    if (most == 0) return "none";
    if (least == most) return std::to_string(least) + " that " + (least == 1 ? "gives" : "give") + " light";
    if (most == std::numeric_limits<std::size_t>::max()) return std::to_string(least) + " or more that give light";
    return std::to_string(least) + " … " + std::to_string(most) + " that give light";
}

std::string limits_text(const Param& param) {
    if (param.type == ParamType::node) return "one that keeps " + param.choices.at(0);
    if (!param.choices.empty()) {
        std::string text;
        for (const auto& choice : param.choices) text += (text.empty() ? "" : " | ") + to_string(Value{choice});
        return text;
    }
    if (param.type == ParamType::film)
        return "{ width, height, crop = { x0, y0, x1, y1 }, gains = { … }, half, compression, file = \"picture.exr\" "
               "}, "
               "in pixels";
    if (param.count) return std::to_string(param.count) + " of them";
    if (param.least == -no_limit && param.most == no_limit) return "";
    if (param.most == no_limit) return "at least " + number_text(param.least);
    if (param.least == -no_limit) return "at most " + number_text(param.most);
    return number_text(param.least) + " … " + number_text(param.most);
}

std::string default_text(const Param& param) {
    if (param.initial) return "default " + to_string(*param.initial);
    return param.optional ? "optional" : "must be given";
}

Node node_with_defaults(const Kind& kind) {
    Node node{"", kind.name, {}, {}, {}};
    for (const auto& param : kind.params)
        if (param.initial) node.params.emplace(param.name, *param.initial);
    return node;
}

std::string facts_text(const Param& param) {
    std::string facts{to_string(param.type)};
    for (const auto& fact : {param.unit.empty() ? "" : "in " + param.unit, default_text(param), limits_text(param),
                             std::string(param.per_input ? "one for each input" : "")})
        if (!fact.empty()) facts += ", " + fact;
    return facts;
}

std::string param_text(const Param& param, std::size_t width) {
    const std::string margin = "  " + padded("", width) + "  ";
    std::string text = "  " + padded(param.name, width) + "  " + facts_text(param) + "\n" + margin + param.help + "\n";
    std::size_t inner = 0;
    for (const auto& field : param.fields) inner = std::max(inner, field.name.size());
    for (const auto& field : param.fields)
        text += margin + padded(field.name, inner) + "  " + field.help + ": " + facts_text(field) + "\n";
    return text;
}

}  // namespace

std::string describe(const Registry& registry) {
    std::size_t width = 0;
    for (const auto& kind : registry.kinds()) width = std::max(width, kind.name.size());
    std::string text;
    for (const auto& kind : registry.kinds())
        text +=
            padded(kind.name, width) + "  " + padded(std::string(to_string(kind.role)), 5) + "  " + kind.help + "\n";
    return text;
}

std::string describe(const Kind& kind) {
    std::string text = kind.name + ": " + kind.help + "\n";
    text += "gives: " + std::string(to_string(kind.role)) + "\n";
    text += "inputs: " + inputs_text(kind) + "\n";
    if (kind.light.linear) text += "linear: the layers of its inputs pass through\n";
    const Node node = node_with_defaults(kind);
    if (const auto paths = paths_text(node, kind); !paths.empty()) text += "light paths: " + paths + "\n";
    if (kind.role != Role::scene) text += "reads of the scene: " + to_string(reads_of(kind, node)) + "\n";
    if (kind.run.landmarks) text += "layouts: replicated, sharded\n";
    if (kind.params.empty()) return text + "parameters: none\n";
    text += "parameters:\n";
    std::size_t width = 0;
    for (const auto& param : kind.params) width = std::max(width, param.name.size());
    for (const auto& param : kind.params) text += param_text(param, width);
    return text;
}

}  // namespace lightnet
