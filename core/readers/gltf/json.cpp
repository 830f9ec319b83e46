#include "core/readers/gltf/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"

namespace lightnet::gltf {
namespace {

constexpr std::size_t deepest = 64, most_values = 20'000'000;

/// Builds the tree, and stops where it becomes too large: a library's own tree would recurse or grow first.
class Builder final : public nlohmann::json_sax<nlohmann::json> {
public:
    bool null() override { return put(Json::Kind::null) != nullptr; }
    bool boolean(bool value) override { return put_number(Json::Kind::boolean, value ? 1 : 0); }
    bool number_integer(number_integer_t value) override { return put_number(Json::Kind::number, double(value)); }
    bool number_unsigned(number_unsigned_t value) override { return put_number(Json::Kind::number, double(value)); }
    bool number_float(number_float_t value, const string_t&) override { return put_number(Json::Kind::number, value); }
    bool string(string_t& value) override {
        Json* json = put(Json::Kind::text);
        if (json) json->text = std::move(value);
        return json != nullptr;
    }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(Json::Kind::object); }
    bool start_array(std::size_t) override { return open(Json::Kind::list); }
    bool key(string_t& value) override {
        key_ = std::move(value);
        return true;
    }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception&) override {
        problem = fmt::format("not sound JSON at byte {}", position);
        return false;
    }

    Json root;
    std::string problem;

private:
    Json* put(Json::Kind kind) {
        if (++values_ > most_values) {
            problem = "there are too many values in the JSON";
            return nullptr;
        }
        Json* json = &root;
        if (!open_.empty()) {
            Json& parent = *open_.back();
            json = parent.kind == Json::Kind::list ? &parent.items.emplace_back() : &(parent.members[key_] = {});
        }
        json->kind = kind;
        return json;
    }
    bool put_number(Json::Kind kind, double value) {
        Json* json = put(kind);
        if (json) json->number = value;
        return json != nullptr;
    }
    bool open(Json::Kind kind) {
        if (open_.size() >= deepest) {
            problem = "the JSON is nested too deeply";
            return false;
        }
        Json* json = put(kind);
        if (json) open_.push_back(json);
        return json != nullptr;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    std::vector<Json*> open_;  // stays valid: only the innermost grows
    std::string key_;
    std::size_t values_ = 0;
};

}  // namespace

Json parse_json(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    Builder builder;
    bool good = false;
    try {
        good = nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
    } catch (const nlohmann::json::exception&) {
        builder.problem = "not sound JSON";
    }
    if (!good) throw Error(builder.problem.empty() ? "not sound JSON" : builder.problem);
    return std::move(builder.root);
}

At At::operator[](std::string_view member) const {
    At at = *this;
    at.path_ = path_.empty() ? std::string(member) : fmt::format("{}.{}", path_, member);
    at.json_ = nullptr;
    if (json_ && json_->kind == Json::Kind::object)
        if (const auto found = json_->members.find(member); found != json_->members.end()) at.json_ = &found->second;
    return at;
}

At At::operator[](std::size_t item) const {
    At at = *this;
    at.path_ = fmt::format("{}[{}]", path_, item);
    at.json_ = item < size() ? &json_->items[item] : nullptr;
    return at;
}

std::size_t At::size() const { return json_ && json_->kind == Json::Kind::list ? json_->items.size() : 0; }

std::vector<std::string> At::names() const {
    std::vector<std::string> result;
    if (json_)
        for (const auto& [name, value] : json_->members) result.push_back(name);
    return result;
}

bool At::is(Json::Kind kind, const char* name) const {
    if (!json_) return false;
    if (json_->kind == kind) return true;
    error(fmt::format("must be {}", name));
    return false;
}

double At::number(double fallback) const {
    if (!is(Json::Kind::number, "a number")) return fallback;
    if (std::fabs(json_->number) < 3e38) return json_->number;  // false for what is not finite, too
    error("must be a finite number");
    return fallback;
}

bool At::boolean(bool fallback) const {
    return is(Json::Kind::boolean, "true or false") ? json_->number != 0 : fallback;
}

std::string At::text(const std::string& fallback) const {
    return is(Json::Kind::text, "a text") ? json_->text : fallback;
}

std::optional<std::uint64_t> At::whole() const {
    if (!json_) return std::nullopt;
    if (json_->kind == Json::Kind::number && json_->number >= 0 && json_->number < 9e15 &&
        json_->number == std::floor(json_->number))
        return static_cast<std::uint64_t>(json_->number);
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
    if (!is(Json::Kind::list, "a list")) return;
    if (size() != count) return error(fmt::format("must have {} numbers", count));
    for (std::size_t i = 0; i < count; ++i) into[i] = (*this)[i].number(into[i]);
}

void At::error(const std::string& what) const { report_->error({file_, 0}, fmt::format("{} {}", path_, what)); }

}  // namespace lightnet::gltf
