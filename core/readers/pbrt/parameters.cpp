#include "core/readers/pbrt/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

struct TypeInfo {
    std::string_view name;
    Type type;
    std::size_t width;
};

constexpr std::array<TypeInfo, 13> types{{{"float", Type::number, 1},
                                          {"integer", Type::integer, 1},
                                          {"point2", Type::point2, 2},
                                          {"vector2", Type::vector2, 2},
                                          {"point3", Type::point3, 3},
                                          {"vector3", Type::vector3, 3},
                                          {"normal", Type::normal, 3},
                                          {"rgb", Type::rgb, 3},
                                          {"spectrum", Type::spectrum, 1},
                                          {"blackbody", Type::blackbody, 1},
                                          {"bool", Type::boolean, 1},
                                          {"string", Type::text, 1},
                                          {"texture", Type::texture, 1}}};

const TypeInfo& info(Type type) {
    return *std::find_if(types.begin(), types.end(), [&](const TypeInfo& t) { return t.type == type; });
}

}  // namespace

std::string_view name_of(Type type) { return info(type).name; }
std::size_t width_of(Type type) { return info(type).width; }

std::optional<Type> type_named(std::string_view word) {
    if (word == "point") return Type::point3;
    if (word == "vector") return Type::vector3;
    if (word == "normal3") return Type::normal;
    if (word == "color") return Type::rgb;
    for (const auto& t : types)
        if (t.name == word) return t.type;
    return std::nullopt;
}

const std::vector<std::string>& type_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const auto& t : types) list.emplace_back(t.name);
        return list;
    }();
    return names;
}

Parameters::Parameters(std::string owner, SourceLine where, Report& report)
    : owner_(std::move(owner)), where_(std::move(where)), report_(&report) {}

void Parameters::add(Parameter parameter) {
    constexpr std::size_t most_parameters = 256;
    const auto same = [&](const auto& p) { return p->name == parameter.name; };
    const auto earlier = std::find_if(parameters_.begin(), parameters_.end(), same);
    if (earlier != parameters_.end()) {
        report_->warn(parameter.where,
                      fmt::format("{}: parameter '{}' is given twice: the last one holds", owner_, parameter.name));
        *earlier = std::make_shared<const Parameter>(std::move(parameter));
    } else if (parameters_.size() == most_parameters) {
        report_->error(parameter.where, owner_ + ": too many parameters");
    } else {
        parameters_.push_back(std::make_shared<const Parameter>(std::move(parameter)));
        own_ = parameters_.size();
    }
}

void Parameters::inherit(const std::vector<std::shared_ptr<const Parameter>>& defaults) {
    for (const auto& parameter : defaults) {
        const auto same = [&](const auto& p) { return p->name == parameter->name; };
        if (std::none_of(parameters_.begin(), parameters_.end(), same)) parameters_.push_back(parameter);
    }
}

void Parameters::set_colour_space(ColourSpace space) {
    for (std::size_t i = 0; i < own_; ++i) {
        if (parameters_[i]->type != Type::rgb) continue;
        Parameter copy = *parameters_[i];
        copy.space = space;
        parameters_[i] = std::make_shared<const Parameter>(std::move(copy));
    }
}

const Parameter* Parameters::find(std::string_view name) {
    asked_.emplace(name);
    const auto same = [&](const auto& p) { return p->name == name; };
    const auto found = std::find_if(parameters_.begin(), parameters_.end(), same);
    return found == parameters_.end() ? nullptr : found->get();
}

const Parameter* Parameters::find(std::string_view name, Type type) {
    const Parameter* found = find(name);
    if (!found || found->type == type) return found;
    if (lenient_) {
        warn_type(*found, name_of(type));
        return nullptr;
    }
    report_->error(found->where, fmt::format("{}: parameter '{}' is of type {}, but must be {}", owner_, name,
                                             name_of(found->type), name_of(type)));
    return nullptr;
}

void Parameters::warn_type(const Parameter& parameter, std::string_view wanted) const {
    report_->warn(parameter.where, fmt::format("{}: parameter '{}' is of type {}, not {}, and has no effect (as in "
                                               "pbrt-v3)",
                                               owner_, parameter.name, name_of(parameter.type), wanted));
}

template <class Value>
const Value* Parameters::single(std::string_view name, Type type, const std::vector<Value> Parameter::*values) {
    const Parameter* found = find(name, type);
    if (!found) return nullptr;
    if ((found->*values).size() == 1) return &(found->*values)[0];
    report_->error(found->where, fmt::format("{}: parameter '{}' has {} values, but must have one", owner_, name,
                                             (found->*values).size()));
    return nullptr;
}

std::optional<float> Parameters::maybe_number(std::string_view name) {
    const float* value = single(name, Type::number, &Parameter::numbers);
    return value ? std::optional(*value) : std::nullopt;
}

float Parameters::number(std::string_view name, float fallback) { return maybe_number(name).value_or(fallback); }

int Parameters::integer(std::string_view name, int fallback) {
    const std::int32_t* value = single(name, Type::integer, &Parameter::integers);
    return value ? *value : fallback;
}

bool Parameters::boolean(std::string_view name, bool fallback) {
    const Parameter* found = find(name, Type::boolean);
    if (!found) return fallback;
    if (found->booleans.size() == 1) return found->booleans[0];
    report_->error(found->where, fmt::format("{}: parameter '{}' must be one true or false", owner_, name));
    return fallback;
}

std::string Parameters::text(std::string_view name, const std::string& fallback) {
    const std::string* value = single(name, Type::text, &Parameter::texts);
    return value ? *value : fallback;
}

std::string Parameters::file(std::string_view name) {
    const std::string* value = single(name, Type::text, &Parameter::paths);
    return value ? *value : "";
}

std::vector<Vec3> Parameters::triples(std::string_view name, Type type) {
    std::vector<Vec3> result;
    const Parameter* found = find(name, type);
    if (!found) return result;
    const auto& n = found->numbers;
    result.reserve(n.size() / 3);
    for (std::size_t i = 0; i + 2 < n.size(); i += 3) result.push_back({n[i], n[i + 1], n[i + 2]});
    return result;
}

std::vector<Vec2> Parameters::pairs(std::string_view name, Type type) {
    std::vector<Vec2> result;
    const Parameter* found = find(name);
    if (!(found && lenient_ && found->type == Type::number)) found = find(name, type);
    if (!found) return result;
    const auto& n = found->numbers;
    result.reserve(n.size() / 2);
    for (std::size_t i = 0; i + 1 < n.size(); i += 2) result.push_back({n[i], n[i + 1]});
    return result;
}

void Parameters::ignore(std::initializer_list<std::string_view> names) {
    for (const auto name : names) asked_.emplace(name);
}

void Parameters::ignore_all() {
    for (const auto& p : parameters_) asked_.insert(p->name);
}

void Parameters::warn_unused() const {
    const std::vector<std::string> known(asked_.begin(), asked_.end());
    for (std::size_t i = 0; i < own_; ++i) {
        const auto& p = *parameters_[i];
        if (asked_.contains(p.name)) continue;
        report_->warn(p.where, fmt::format("{}: parameter '{}' is unknown here and has no effect{}", owner_, p.name,
                                           did_you_mean(p.name, known)));
    }
}

void Parameters::error(const std::string& what) const { report_->error(where_, owner_ + ": " + what); }
void Parameters::warn(const std::string& what) const { report_->warn(where_, owner_ + ": " + what); }

}  // namespace lightnet::pbrt
