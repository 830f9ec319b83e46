// JSON that goes out: a tree of plain values, and its text.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace lightnet {

struct Json;
struct JsonMember;

/// A value that is made piece by piece, or all at once in braces: {{"name", "a"}, {"at", {1, 2}}} is an object, as each
/// part of it is a text and a value; {1, 2} is a list. What stands in braces is moved, not copied. No thread rules.
class JsonTree {
public:
    JsonTree(std::nullptr_t = nullptr);
    template <class Number>
    requires std::is_arithmetic_v<Number> JsonTree(Number number) : JsonTree(Plain(Wide<Number>{number})) {}
    JsonTree(const char* text);
    JsonTree(std::string_view text);
    JsonTree(std::string text);
    JsonTree(std::initializer_list<JsonTree> parts);
    /// What was read.
    explicit JsonTree(const Json& json);
    template <class T>
    JsonTree(const std::vector<T>& entries) : JsonTree(list()) {
        for (const auto& entry : entries) push_back(entry);
    }
    template <class T>
    JsonTree(const std::map<std::string, T>& members) : JsonTree(object()) {
        for (const auto& [name, value] : members) add(name, value);
    }
    JsonTree(const JsonTree& other);
    JsonTree(JsonTree&& other) noexcept;
    JsonTree& operator=(const JsonTree& other);
    JsonTree& operator=(JsonTree&& other) noexcept;
    ~JsonTree();

    /// Without entries, and without members.
    static JsonTree list();
    static JsonTree object();

    /// Puts it at the end of the list; null becomes a list first.
    JsonTree& push_back(JsonTree entry);
    /// The member of that name, which is null where there was none; null becomes an object first.
    JsonTree& operator[](std::string_view name);
    /// Replaces each text in it, but the names of members.
    void change_texts(std::string (*change)(const std::string&));

private:
    friend class JsonWriter;
    using Plain = std::variant<bool, std::int64_t, std::uint64_t, double>;
    template <class Number>
    using Whole = std::conditional_t<std::is_signed_v<Number>, std::int64_t, std::uint64_t>;
    template <class Number>
    using Wide = std::conditional_t<std::same_as<Number, bool>, bool,
                                    std::conditional_t<std::floating_point<Number>, double, Whole<Number>>>;
    using List = std::vector<JsonTree>;
    using Object = std::vector<JsonMember>;  // in the order in which they were added
    explicit JsonTree(Plain value);
    void add(const std::string& name, JsonTree value);  // where there is none of that name
    bool is_pair() const;

    // What stands in braces is constant to C++, and nobody else's.
    mutable std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, List, Object> data_;
};

/// How a tree becomes text. What is no number is written as null.
struct JsonStyle {
    int indent = -1;       // spaces for each level; -1: all in one line
    bool by_name = false;  // members sorted by their names: the same values are the same text
    bool ascii = false;    // what is not ASCII goes by its number
    bool strict = false;   // throws Error where a text is not UTF-8; else its bytes become U+FFFD
};
std::string to_text(const JsonTree& tree, const JsonStyle& style = {});
/// In one line, sorted by names.
std::string sorted_text(const JsonTree& tree);

}  // namespace lightnet
