// Answers of processes that evaluate a user's file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/json.hpp"

namespace lightnet::lua {

/// The value's JSON ("" when the file didn't come to its end), what is wrong, and whether all of it came from the one
/// file.
struct Answer {
    std::string value;
    std::vector<Problem> problems;
    bool alone = false;
};

/// As one text. JSON has no line break in it, so one keeps the two apart; the last is a letter in front.
inline std::string pack(const Answer& answer) {
    return (answer.alone ? "1" : "0") + to_json(answer.problems) + "\n" + answer.value;
}
/// Reads it back. Throws Error on anything else.
inline Answer unpack(std::string_view text) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos || end == 0) throw Error("malformed answer");
    return {std::string(text.substr(end + 1)), problems_from_json(text.substr(1, end - 1)), text.front() == '1'};
}

}  // namespace lightnet::lua
