// Answers of processes that evaluate a user's file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/json.hpp"

namespace lightnet::lua {

/// The value's JSON ("" when the file didn't come to its end), and what is wrong.
struct Answer {
    std::string value;
    std::vector<Problem> problems;
};

/// As one text. JSON has no line break in it, so one keeps the two apart.
inline std::string pack(const Answer& answer) { return to_json(answer.problems) + "\n" + answer.value; }
/// Reads it back. Throws Error on anything else.
inline Answer unpack(std::string_view text) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) throw Error("malformed answer");
    return {std::string(text.substr(end + 1)), problems_from_json(text.substr(0, end))};
}

}  // namespace lightnet::lua
