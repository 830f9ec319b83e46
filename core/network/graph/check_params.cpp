#include "core/network/graph/check_params.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "core/base/in_quotes.hpp"
#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"
#include "core/network/graph/graph_film.hpp"

namespace lightnet {

bool is_name(const std::string& name) {
    const auto letter = [](unsigned char c) { return std::isalpha(c) || c == '_'; };
    return !name.empty() && name.size() <= 64 && letter(static_cast<unsigned char>(name[0])) &&
           std::all_of(name.begin(), name.end(), [&](unsigned char c) { return letter(c) || std::isdigit(c); });
}

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

std::string_view wanted(ParamType type) {
    switch (type) {
        case ParamType::number:
            return "a number";
        case ParamType::integer:
            return "an integer";
        case ParamType::flag:
            return "true or false";
        case ParamType::text:
            return "a text";
        case ParamType::numbers:
            return "a table of numbers";
        case ParamType::table:
            return "a table with names";
        case ParamType::surrounding:
            return "the name of a file or a colour { r, g, b }";
        case ParamType::film:
            return "a table like { width, height, file = \"picture.exr\" }";
        case ParamType::scene:
            return "a Scene";
        case ParamType::node:
            return "a node";
        case ParamType::nodes:
            return "a list of nodes";
        case ParamType::names:
            return "a name or a list of names";
        case ParamType::named_lists:
            return "a table like { key = \"spot*\", fill = { \"panel1\", \"panel2\" } }";
        case ParamType::named_colours:
            return "a table like { key = 0.5, [\"wall*\"] = { 0.6, 0.1, 0.1 } }";
    }
    return "";
}

// What a number must be: "1 … 64 samples", "at least 0 m".
std::string range_text(const Param& param) {
    const std::string unit = param.unit.empty() ? "" : " " + param.unit;
    if (param.most == unlimited) return "at least " + number_text(param.least) + unit;
    if (param.least == -unlimited) return "at most " + number_text(param.most) + unit;
    return number_text(param.least) + " … " + number_text(param.most) + unit;
}

/// One parameter of one node, and what is said of it.
class ParamCheck {
public:
    ParamCheck(const Param& param, const Node& node, const Graph& graph, const Complain& complain)
        : param_(param), node_(node), graph_(graph), complain_(complain) {}

    void operator()(const Value& value) const {
        if (const auto* ref = std::get_if<NodeRef>(&value.data);
            ref && param_.type != ParamType::scene && !graph_.find(ref->name))
            return complain_(in_quotes(param_.name) + ": nothing is called " + in_quotes(ref->name));
        switch (param_.type) {
            case ParamType::number:
            case ParamType::integer:
                number(value, in_quotes(param_.name), param_.type == ParamType::integer);
                break;
            case ParamType::flag:
                as<bool>(value);
                break;
            case ParamType::text:
                text(value);
                break;
            case ParamType::numbers:
                numbers(value);
                break;
            case ParamType::table:
                table(value);
                break;
            case ParamType::surrounding:
                surrounding(value);
                break;
            case ParamType::film:
                film(value);
                break;
            case ParamType::scene:
                scene(value);
                break;
            case ParamType::node:
                as<NodeRef>(value);
                break;
            case ParamType::nodes:
                nodes(value);
                break;
            case ParamType::names:
                if (!are_names(value)) wrong_type(value);
                break;
            case ParamType::named_lists:
                named_lists(value);
                break;
            case ParamType::named_colours:
                named_colours(value);
                break;
        }
    }

private:
    template <class T>
    const T* as(const Value& value) const {
        const T* found = std::get_if<T>(&value.data);
        if (!found) wrong_type(value);
        return found;
    }

    void wrong_type(const Value& value) const {
        complain_(in_quotes(param_.name) + " must be " + std::string(wanted(param_.type)) + ", not " +
                  std::string(type_name(value)));
    }

    void number(const Value& value, const std::string& name, bool integral) const {
        const auto* found = std::get_if<double>(&value.data);
        if (!found) {
            complain_(name + " must be " + (integral ? "an integer" : "a number") + ", not " +
                      std::string(type_name(value)));
        } else if (!std::isfinite(*found)) {
            complain_(name + " must be a finite number, not " + number_text(*found));
        } else if (integral && std::trunc(*found) != *found) {
            complain_(name + " must be an integer, not " + number_text(*found));
        } else if (*found < param_.least || *found > param_.most) {
            complain_(name + " is " + number_text(*found) + ", but must be " + range_text(param_));
        }
    }

    void text(const Value& value) const {
        const auto* found = as<std::string>(value);
        const auto& choices = param_.choices;
        if (!found || choices.empty() || std::find(choices.begin(), choices.end(), *found) != choices.end()) return;
        complain_(in_quotes(param_.name) + " can't be " + in_quotes(*found) + suggest(*found, choices));
    }

    void numbers(const Value& value) const {
        const auto* table = as<Table>(value);
        if (!table) return;
        if (!table->named.empty()) complain_(in_quotes(param_.name) + " must be a table of numbers without keys");
        for (std::size_t i = 0; i < table->list.size(); ++i)
            number(table->list[i], "entry " + std::to_string(i + 1) + " of " + in_quotes(param_.name), false);
        const bool as_default = param_.initial && value == *param_.initial;
        if (param_.count && table->list.size() != param_.count && !as_default)
            complain_(in_quotes(param_.name) + " must have " + std::to_string(param_.count) + " numbers, not " +
                      std::to_string(table->list.size()));
        if (param_.per_input && !table->list.empty() && table->list.size() != node_.entries.size())
            complain_(in_quotes(param_.name) + " must have one number for each of the " +
                      std::to_string(node_.entries.size()) + " inputs, not " + std::to_string(table->list.size()));
    }

    void table(const Value& value) const {
        const auto* given = as<Table>(value);
        if (!given) return;
        if (!given->list.empty()) complain_(in_quotes(param_.name) + " must be " + std::string(wanted(param_.type)));
        const Complain inside = [&](const std::string& what) { complain_(in_quotes(param_.name) + ": " + what); };
        if (param_.fields.empty()) {
            for (const auto& [name, entry] : given->named)
                if (std::holds_alternative<Table>(entry.data) || std::holds_alternative<NodeRef>(entry.data))
                    inside(in_quotes(name) + " must be a number, a text or a flag, not " +
                           std::string(type_name(entry)));
            return;
        }
        std::vector<std::string> names;
        for (const auto& field : param_.fields) names.push_back(field.name);
        for (const auto& [name, entry] : given->named) {
            const auto field = std::find(names.begin(), names.end(), name);
            if (field == names.end())
                inside("unknown entry " + in_quotes(name) + suggest(name, names));
            else
                ParamCheck(param_.fields[static_cast<std::size_t>(field - names.begin())], node_, graph_,
                           inside)(entry);
        }
    }

    void nodes(const Value& value) const {
        const auto* list = as<Table>(value);
        if (!list) return;
        const bool sound = list->named.empty() && std::all_of(list->list.begin(), list->list.end(), [](const auto& e) {
                               return std::holds_alternative<NodeRef>(e.data);
                           });
        if (!sound) complain_(in_quotes(param_.name) + " must be " + std::string(wanted(param_.type)));
    }

    static bool are_names(const Value& value) {
        const auto is_text = [](const Value& one) { return std::holds_alternative<std::string>(one.data); };
        const auto* list = std::get_if<Table>(&value.data);
        return list ? list->named.empty() && std::all_of(list->list.begin(), list->list.end(), is_text)
                    : is_text(value);
    }

    void named_lists(const Value& value) const {
        const auto* given = as<Table>(value);
        if (!given) return;
        if (!given->list.empty()) complain_(in_quotes(param_.name) + " must be " + std::string(wanted(param_.type)));
        for (const auto& [name, entry] : given->named)
            if (!are_names(entry))
                complain_(in_quotes(param_.name) + ": " + in_quotes(name) + " must be " +
                          std::string(wanted(ParamType::names)) + ", not " + std::string(type_name(entry)));
    }

    void named_colours(const Value& value) const {
        const auto* given = as<Table>(value);
        if (!given) return;
        if (!given->list.empty()) complain_(in_quotes(param_.name) + " must be " + std::string(wanted(param_.type)));
        const auto in_range = [this](const Value& one) {
            const auto* part = std::get_if<double>(&one.data);
            return part && std::isfinite(float(*part)) && param_.least <= *part && *part <= param_.most;
        };
        for (const auto& [name, entry] : given->named) {
            const auto* colour = std::get_if<Table>(&entry.data);
            const bool sound = colour ? colour->named.empty() && colour->list.size() == 3 &&
                                            std::all_of(colour->list.begin(), colour->list.end(), in_range)
                                      : in_range(entry);
            if (!sound)
                complain_(in_quotes(param_.name) + ": " + in_quotes(name) +
                          " must be a number or { red, green, blue }, " + range_text(param_));
        }
    }

    void surrounding(const Value& value) const {
        if (std::holds_alternative<std::string>(value.data)) return;
        const auto* colour = as<Table>(value);
        if (!colour) return;
        const bool sound = colour->named.empty() && colour->list.size() == 3 &&
                           std::all_of(colour->list.begin(), colour->list.end(), [](const Value& entry) {
                               const auto* part = std::get_if<double>(&entry.data);
                               return part && std::isfinite(*part) && *part >= 0;
                           });
        if (!sound)
            complain_(in_quotes(param_.name) + " must be a colour of three numbers, 0 or more, or the name of a file");
    }

    void film(const Value& value) const {
        const auto* table = as<Table>(value);
        if (!table) return;
        if (table->list.size() != 2) complain_(in_quotes(param_.name) + " must be " + std::string(wanted(param_.type)));
        for (const auto& side : table->list) {
            const auto* pixels = std::get_if<double>(&side.data);
            if (!pixels || std::trunc(*pixels) != *pixels || *pixels < 1 || *pixels > longest_side)
                complain_(in_quotes(param_.name) + " has a side of " + to_string(side) + ", but must be 1 … " +
                          std::to_string(longest_side) + " pixels");
        }
        for (const auto& [name, entry] : table->named) {
            if (name == "crop")
                crop(entry, table->list);
            else if (name == "gains")
                gains(entry);
            else if (name == "half" || name == "parts" || name == "clean" || name == "compression")
                storage(name, entry);
            else if (name != "file")
                complain_(in_quotes(param_.name) + " has an unknown entry " + in_quotes(name) +
                          suggest(name, {"file", "crop", "gains", "half", "parts", "compression", "clean"}));
            else if (!std::holds_alternative<std::string>(entry.data))
                complain_("'file' of " + in_quotes(param_.name) + " must be a text, not " +
                          std::string(type_name(entry)));
        }
    }

    void storage(const std::string& name, const Value& value) const {
        if (name != "compression") {
            if (!std::holds_alternative<bool>(value.data))
                complain_(in_quotes(name) + " of " + in_quotes(param_.name) + " must be true or false, not " +
                          std::string(type_name(value)));
            return;
        }
        const auto& known = lossless_compressions();
        const auto* wanted = std::get_if<std::string>(&value.data);
        if (wanted && std::find(known.begin(), known.end(), *wanted) != known.end()) return;
        const std::vector<std::string> lossy{"pxr24", "b44", "b44a", "dwaa", "dwab"};
        const bool loses = wanted && std::find(lossy.begin(), lossy.end(), *wanted) != lossy.end();
        complain_("'compression' of " + in_quotes(param_.name) + " must be one of " + joined(known) + ", not " +
                  to_string(value) + (loses ? ": it is lossy, and layers would not add up any more" : ""));
    }

    // Edges in pixels of the whole image, the last column and row excluded. Sides that are wrong were said.
    void gains(const Value& value) const {
        const auto number = [](const Value& one) {
            const auto* found = std::get_if<double>(&one.data);
            return found && std::isfinite(float(*found)) && *found >= 0;
        };
        const auto* given = std::get_if<Table>(&value.data);
        if (!given || !given->list.empty())
            return complain_("'gains' of " + in_quotes(param_.name) + " must be a table like { direct = 0.5 }");
        for (const auto& [layer, gain] : given->named) {
            const auto* colour = std::get_if<Table>(&gain.data);
            const bool sound = colour ? colour->named.empty() && colour->list.size() == 3 &&
                                            std::all_of(colour->list.begin(), colour->list.end(), number)
                                      : number(gain);
            if (!sound)
                complain_("the gain of " + in_quotes(layer) + " must be a number or { red, green, blue }, 0 or more");
        }
    }

    void crop(const Value& value, const List& sides) const {
        const auto* given = std::get_if<Table>(&value.data);
        const auto edge = [&](std::size_t i) {
            const auto* number = std::get_if<double>(&given->list[i].data);
            return number && std::trunc(*number) == *number ? *number : -1;
        };
        const auto side = [&](std::size_t i) {
            const auto* number = i < sides.size() ? std::get_if<double>(&sides[i].data) : nullptr;
            return number ? *number : unlimited;
        };
        if (!given || given->list.size() != 4 || !given->named.empty())
            return complain_("'crop' of " + in_quotes(param_.name) + " must be { x0, y0, x1, y1 } in pixels");
        for (std::size_t axis : {0u, 1u})
            if (!(0 <= edge(axis) && edge(axis) < edge(axis + 2) && edge(axis + 2) <= side(axis)))
                complain_("'crop' of " + in_quotes(param_.name) + " goes from " + to_string(given->list[axis]) +
                          " to " + to_string(given->list[axis + 2]) + ", but must lie within whole pixels 0 … " +
                          number_text(side(axis)));
    }

    void scene(const Value& value) const {
        const auto* ref = std::get_if<NodeRef>(&value.data);
        if (!ref) return wrong_type(value);
        const auto found = graph_.find(ref->name);
        if (!found) {
            std::vector<std::string> scenes;
            for (const auto& node : graph_.nodes)
                if (node.kind == "Scene") scenes.push_back(node.name);
            complain_("no scene called " + in_quotes(ref->name) + suggest(ref->name, scenes));
        } else if (const auto& kind = graph_.nodes[*found].kind; kind != "Scene") {
            complain_(in_quotes(param_.name) + " must be a Scene, but " + in_quotes(ref->name) + " is of kind " + kind);
        }
    }

    const Param& param_;
    const Node& node_;
    const Graph& graph_;
    const Complain& complain_;
};

}  // namespace

std::string suggest(const std::string& word, const std::vector<std::string>& known) {
    if (auto guess = did_you_mean(word, known); !guess.empty()) return guess;
    return known.empty() ? "" : " (there is: " + joined(known) + ")";
}

void check_params(Node& node, const Kind& kind, const Graph& graph, const Complain& complain_of) {
    bool sound = true;
    const Complain complain = [&](const std::string& what) { complain_of(what), sound = false; };
    std::vector<std::string> names;
    for (const auto& param : kind.params) names.push_back(param.name);
    for (const auto& [name, value] : node.params) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        const auto gone = kind.gone.find(name);
        if (gone != kind.gone.end())
            complain("there is no parameter " + in_quotes(name) + " any more: " + gone->second);
        else
            complain("unknown parameter " + in_quotes(name) + suggest(name, names));
    }
    for (const auto& param : kind.params) {
        const auto given = node.params.find(param.name);
        if (given != node.params.end())
            ParamCheck(param, node, graph, complain)(given->second);
        else if (param.initial)
            node.params.emplace(param.name, *param.initial);
        else if (!param.optional)
            complain("parameter " + in_quotes(param.name) + " is missing: " + param.help);
    }
    if (sound && kind.mistakes)
        for (const auto& mistake : kind.mistakes(node, nullptr)) complain(mistake);
}

}  // namespace lightnet
