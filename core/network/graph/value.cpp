#include "core/network/graph/value.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace lightnet {
namespace {

struct ToText {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(double number) const { return number_text(number); }
    std::string operator()(const std::string& text) const { return '"' + text + '"'; }
    std::string operator()(const NodeRef& ref) const { return ref.name; }
    std::string operator()(const Table& table) const {
        std::string inside;
        const auto put = [&](const std::string& entry) { inside += (inside.empty() ? "" : ", ") + entry; };
        for (const auto& value : table.list) put(to_string(value));
        for (const auto& [name, value] : table.named) put(name + " = " + to_string(value));
        return inside.empty() ? "{}" : "{ " + inside + " }";
    }
};

struct TypeName {
    std::string_view operator()(bool) const { return "a flag"; }
    std::string_view operator()(double) const { return "a number"; }
    std::string_view operator()(const std::string&) const { return "a text"; }
    std::string_view operator()(const NodeRef&) const { return "a node"; }
    std::string_view operator()(const Table&) const { return "a table"; }
};

}  // namespace

std::string number_text(double number) {
    std::array<char, 64> text{};
    constexpr double longest_integer = 1e15;  // beyond it digits would be claimed that a double hasn't
    const bool integral = std::trunc(number) == number && std::abs(number) < longest_integer;
    const auto end = integral ? std::to_chars(text.begin(), text.end(), static_cast<long long>(number))
                              : std::to_chars(text.begin(), text.end(), number);
    return {text.data(), end.ptr};
}

std::string to_string(const Value& value) { return std::visit(ToText{}, value.data); }

std::string_view type_name(const Value& value) { return std::visit(TypeName{}, value.data); }

}  // namespace lightnet
