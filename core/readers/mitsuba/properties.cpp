#include "core/readers/mitsuba/properties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "core/base/suggestion.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/files/trimmed.hpp"

namespace lightnet::mitsuba {
namespace {

constexpr std::string_view between = " \t\r\n,";

}  // namespace

const Node* Context::resolved(const Node& node) const {
    if (node.tag != "ref") return &node;
    const auto known = document.ids.find(node.id);
    if (known != document.ids.end()) return known->second;
    std::vector<std::string> names;
    for (const auto& [id, target] : document.ids) names.push_back(id);
    error(node, fmt::format("there is no element with the id '{}'{}", node.id, did_you_mean(node.id, names)));
    return nullptr;
}

std::string Context::path(const std::string& name, const Node& node) const {
    return path_of(assets, document, node.where.file, name);
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

std::optional<double> number(std::string_view text, const Node& node, const Context& context) {
    auto digits = trimmed(text, between);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool tiny = problem == std::errc::result_out_of_range && digits.find("e-") != digits.npos;
    const bool sound = problem == std::errc{} && std::isfinite(value) && std::fabs(value) < 3e38;
    if ((sound || tiny) && end == digits.data() + digits.size()) return tiny ? 0 : value;
    context.error(node, fmt::format("a finite number expected, not '{}'", trimmed(text, between).substr(0, 32)));
    return std::nullopt;
}

std::optional<std::vector<double>> numbers(std::string_view text, const Node& node, const Context& context) {
    std::vector<double> values;
    for (text = trimmed(text, between); !text.empty(); text = trimmed(text, between)) {
        const auto end = std::min(text.find_first_of(between), text.size());
        const auto value = number(text.substr(0, end), node, context);
        if (!value) return std::nullopt;
        values.push_back(*value);
        text.remove_prefix(end);
    }
    return values;
}

std::optional<Vec3> triple(const Node& node, const Context& context, float missing) {
    Vec3 result{missing, missing, missing};
    if (node.has("value")) {
        const auto values = numbers(node.attribute("value"), node, context);
        if (!values) return std::nullopt;
        if (values->size() == 1) return Vec3{float((*values)[0]), float((*values)[0]), float((*values)[0])};
        if (values->size() == 3) return Vec3{float((*values)[0]), float((*values)[1]), float((*values)[2])};
        context.error(node, fmt::format("one or three numbers expected, not {}", values->size()));
        return std::nullopt;
    }
    constexpr std::string_view axes[] = {"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i) {
        if (!node.has(axes[i])) continue;
        const auto value = number(node.attribute(axes[i]), node, context);
        if (!value) return std::nullopt;
        result[i] = static_cast<float>(*value);
    }
    return result;
}

Properties::~Properties() {
    if (all_) return;
    static const std::set<std::string, std::less<>> objects{"medium", "subsurface"};
    for (const auto& child : node_.children) {
        if (asked_.contains(child.get())) continue;
        if (objects.contains(child->tag))
            context_.warn(*child,
                          fmt::format("<{}> is left out of {}: the picture shows nothing of it", child->tag, owner()));
        else if (child->tag == "ref" || child->tag == "bsdf" || child->tag == "texture" || child->name.empty())
            context_.warn(*child,
                          fmt::format("<{}{}> is left out of {}: the picture shows nothing of it", child->tag,
                                      child->name.empty() ? "" : fmt::format(" name=\"{}\"", child->name), owner()));
        else
            context_.warn(*child, fmt::format("parameter '{}' of {} is left out: the picture shows nothing of it",
                                              child->name, owner()));
    }
}

std::string Properties::owner() const { return fmt::format("{} '{}'", node_.tag, node_.type); }

const Node* Properties::find(std::string_view name) {
    const Node* last = nullptr;
    bool twice = false;
    for (const auto& child : node_.children) {
        if (child->name != name) continue;
        twice = asked_.insert(child.get()).second && last;
        last = child.get();
    }
    if (twice)
        context_.warn(*last, fmt::format("parameter '{}' of {} is given twice: the last one holds", name, owner()));
    return last;
}

float Properties::number(std::string_view name, float fallback) {
    const Node* given = find(name);
    if (!given) return fallback;
    if (given->tag == "texture" || given->tag == "ref") {
        context_.warn(*given,
                      fmt::format("the texture of '{}' of {} is left out: {} is taken", name, owner(), fallback));
        return fallback;
    }
    return static_cast<float>(mitsuba::number(given->attribute("value"), *given, context_).value_or(double(fallback)));
}

int Properties::integer(std::string_view name, int fallback) {
    const double value = double(number(name, static_cast<float>(fallback)));
    return static_cast<int>(std::clamp(value, -2e9, 2e9));
}

bool Properties::boolean(std::string_view name, bool fallback) {
    const Node* given = find(name);
    if (!given) return fallback;
    const auto word = trimmed(given->attribute("value"), between);
    if (same_but_for_case(word, "true") || word == "1") return true;
    if (same_but_for_case(word, "false") || word == "0") return false;
    context_.error(*given, fmt::format("'true' or 'false' expected, not '{}'", word.substr(0, 32)));
    return fallback;
}

std::string Properties::text(std::string_view name, const std::string& fallback) {
    const Node* given = find(name);
    return given ? std::string(given->attribute("value")) : fallback;
}

Vec3 Properties::point(std::string_view name, Vec3 fallback) {
    const Node* given = find(name);
    return given ? triple(*given, context_, 0).value_or(fallback) : fallback;
}

std::vector<const Node*> Properties::objects(std::string_view tag) {
    std::vector<const Node*> found;
    for (const auto& child : node_.children) {
        if (child->tag != tag && child->tag != "ref") continue;
        const Node* object = context_.resolved(*child);
        if (!object) asked_.insert(child.get());  // said already
        if (!object || object->tag != tag) continue;
        asked_.insert(child.get());
        found.push_back(object);
    }
    return found;
}

void Properties::ignore(std::initializer_list<std::string_view> names) {
    for (const auto name : names) find(name);
}

}  // namespace lightnet::mitsuba
