#include "core/readers/gltf/json.hpp"

#include <fmt/format.h>

#include <cmath>

namespace lightnet::gltf {

At At::operator[](std::string_view member) const {
    At at = *this;
    at.path_ = path_.empty() ? std::string(member) : fmt::format("{}.{}", path_, member);
    at.json_ = nullptr;
    if (json_ && json_->has(member)) at.json_ = &json_->at(member);
    if (at.json_ && seen_) seen_->insert(at.json_);
    return at;
}

At At::operator[](std::size_t item) const {
    At at = *this;
    at.path_ = fmt::format("{}[{}]", path_, item);
    at.json_ = item < size() ? &json_->list()[item] : nullptr;
    if (at.json_ && seen_ && at.json_->is_object()) seen_->insert(at.json_);
    return at;
}

std::size_t At::size() const {
    const auto* list = json_ ? std::get_if<Json::List>(&json_->data) : nullptr;
    return list ? list->size() : 0;
}

std::vector<std::string> At::names() const {
    std::vector<std::string> result;
    if (json_ && json_->is_object())
        for (const auto& [name, value] : json_->object()) result.push_back(name);
    return result;
}

template <class T>
const T* At::as(const char* name) const {
    if (!json_) return nullptr;
    const T* found = std::get_if<T>(&json_->data);
    if (!found) error(fmt::format("must be {}", name));
    return found;
}

// None: it isn't there, or is something else, which is reported.
std::optional<double> At::any_number() const {
    if (json_)
        if (const auto* whole = std::get_if<std::uint64_t>(&json_->data)) return static_cast<double>(*whole);
    const auto* found = as<double>("a number");
    return found ? std::optional(*found) : std::nullopt;
}

double At::number(double fallback) const {
    const auto found = any_number();
    if (!found) return fallback;
    if (std::fabs(*found) < 3e38) return *found;  // false for what is not finite, too
    error("must be a finite number");
    return fallback;
}

bool At::boolean(bool fallback) const {
    const auto* found = as<bool>("true or false");
    return found ? *found : fallback;
}

std::string At::text(const std::string& fallback) const {
    const auto* found = as<std::string>("a text");
    return found ? *found : fallback;
}

std::optional<std::uint64_t> At::whole() const {
    if (!json_) return std::nullopt;
    const auto* whole = std::get_if<std::uint64_t>(&json_->data);
    const auto* number = std::get_if<double>(&json_->data);
    const double value = whole ? static_cast<double>(*whole) : number ? *number : -1;
    if (value >= 0 && value < 9e15 && value == std::floor(value)) return static_cast<std::uint64_t>(value);
    error("must be a whole number from 0 on");
    return std::nullopt;
}

std::optional<std::size_t> At::index(std::size_t count) const {
    const auto value = whole();
    if (!value) return std::nullopt;
    if (*value < count) return static_cast<std::size_t>(*value);
    error(fmt::format("index {} is out of range: there are {}", *value, count));
    return std::nullopt;
}

void At::read(double* into, std::size_t count) const {
    if (!as<Json::List>("a list")) return;
    if (size() != count) return error(fmt::format("must have {} numbers", count));
    for (std::size_t i = 0; i < count; ++i) into[i] = (*this)[i].number(into[i]);
}

void At::error(const std::string& what) const { report_->error({file_, 0}, fmt::format("{} {}", path_, what)); }

}  // namespace lightnet::gltf
