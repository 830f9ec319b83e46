#include "core/base/json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

namespace lightnet {
namespace {

[[noreturn]] void malformed(const std::string& what) { throw JsonError(what); }

template <class T>
const T& as(const Json& json, const char* wanted) {
    const T* found = std::get_if<T>(&json.data);
    if (!found) malformed(fmt::format("{} was expected", wanted));
    return *found;
}

/// Builds the tree, and stops where it becomes too large: a library's own tree would recurse or grow first, or look
/// through all siblings at each value.
class Builder final : public nlohmann::json_sax<nlohmann::json> {
public:
    explicit Builder(const JsonLimits& limits) : limits_(limits) {}

    bool null() override { return put({}) != nullptr; }
    bool boolean(bool value) override { return put({value}) != nullptr; }
    bool number_integer(number_integer_t value) override { return put({double(value)}) != nullptr; }
    bool number_unsigned(number_unsigned_t value) override { return put({std::uint64_t{value}}) != nullptr; }
    bool number_float(number_float_t value, const string_t&) override { return put({value}) != nullptr; }
    bool string(string_t& value) override { return put({std::move(value)}) != nullptr; }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open({Json::Object{}}); }
    bool start_array(std::size_t) override { return open({Json::List{}}); }
    bool key(string_t& value) override {
        key_ = std::move(value);
        return true;
    }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception&) override {
        problem = fmt::format("not sound at byte {}", position);
        return false;
    }

    Json root;
    std::string problem;

private:
    Json* put(Json value) {
        if (++values_ > limits_.values) {
            problem = fmt::format("more than {} values", limits_.values);
            return nullptr;
        }
        if (open_.empty()) return &(root = std::move(value));
        if (auto* list = std::get_if<Json::List>(&open_.back()->data)) return &list->emplace_back(std::move(value));
        return &(std::get<Json::Object>(open_.back()->data)[std::move(key_)] = std::move(value));
    }
    bool open(Json value) {
        if (open_.size() >= limits_.depth) {
            problem = "nested too deeply";
            return false;
        }
        Json* json = put(std::move(value));
        if (json) open_.push_back(json);
        return json != nullptr;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    const JsonLimits& limits_;
    std::vector<Json*> open_;  // stays valid: only the innermost grows
    std::string key_;
    std::size_t values_ = 0;
};

}  // namespace

bool Json::flag() const { return as<bool>(*this, "true or false"); }
const std::string& Json::text() const { return as<std::string>(*this, "a text"); }
const Json::List& Json::list() const { return as<List>(*this, "a list"); }
const Json::Object& Json::object() const { return as<Object>(*this, "an object"); }

double Json::number() const {
    if (const auto* whole = std::get_if<std::uint64_t>(&data)) return static_cast<double>(*whole);
    return as<double>(*this, "a number");
}

const Json::List& Json::list(std::size_t size) const {
    const List& items = list();
    if (items.size() != size)
        malformed(fmt::format("a list of {} was expected, and one of {} is there", size, items.size()));
    return items;
}

const Json::Object& Json::object(std::size_t size) const {
    const Object& members = object();
    if (members.size() != size) malformed("an object with other members was expected");
    return members;
}

bool Json::has(std::string_view member) const {
    const auto* members = std::get_if<Object>(&data);
    return members && members->find(member) != members->end();
}

const Json& Json::at(std::string_view member) const {
    const Object& members = object();
    const auto found = members.find(member);
    if (found == members.end()) malformed(fmt::format("no '{}'", member));
    return found->second;
}

std::uint64_t Json::whole_up_to(std::uint64_t most) const {
    const auto& value = as<std::uint64_t>(*this, "a whole number from 0 on");
    if (value > most) malformed(fmt::format("{} is more than {}", value, most));
    return value;
}

// DECISIONS: json-as-events
Json parse_json(std::string_view text, const JsonLimits& limits) {
    if (text.size() > limits.bytes) malformed(fmt::format("more than {} MiB", limits.bytes >> 20));
    Builder builder(limits);
    bool good = false;
    try {
        good = nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
    } catch (const nlohmann::json::exception&) {
        builder.problem = "not sound";
    }
    if (!good) malformed(builder.problem.empty() ? "not sound" : builder.problem);
    return std::move(builder.root);
}

}  // namespace lightnet
