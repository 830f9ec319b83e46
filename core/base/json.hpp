// JSON that comes from elsewhere: read as a stream, within limits, into a tree of plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {

/// A text is no JSON, goes beyond its limits, or says something else than what is asked for.
class JsonError : public Error {
public:
    explicit JsonError(const std::string& what) : Error("malformed JSON", what) {}
};

/// How much a text may hold. What is beyond is refused before it takes time or memory.
struct JsonLimits {
    std::size_t bytes = std::size_t{16} << 20;
    std::size_t values = 1'000'000;  // numbers, texts, lists and objects; each takes some 60 bytes
    std::size_t depth = 32;          // of lists and objects in each other
};

/// A value. What asks for one type throws JsonError when it is another.
struct Json {
    using List = std::vector<Json>;
    using Object = std::map<std::string, Json, std::less<>>;

    std::variant<std::monostate, bool, double, std::uint64_t, std::string, List, Object> data;  // whole numbers from 0
                                                                                                // on keep all bits
    bool is_object() const { return std::holds_alternative<Object>(data); }
    bool flag() const;
    double number() const;
    const std::string& text() const;
    const List& list() const;
    /// A list of exactly so many.
    const List& list(std::size_t size) const;
    const Object& object() const;
    /// An object of exactly so many members.
    const Object& object(std::size_t size) const;
    bool has(std::string_view member) const;
    const Json& at(std::string_view member) const;
    /// A number from 0 on that fits the type.
    template <class Integer>
    Integer whole() const {
        static_assert(std::is_integral_v<Integer>);
        return static_cast<Integer>(whole_up_to(static_cast<std::uint64_t>(std::numeric_limits<Integer>::max())));
    }

private:
    std::uint64_t whole_up_to(std::uint64_t most) const;
};

/// Throws JsonError when the text is no JSON or goes beyond the limits.
Json parse_json(std::string_view text, const JsonLimits& limits = {});

}  // namespace lightnet
