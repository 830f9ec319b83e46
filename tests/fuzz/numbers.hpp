// Numbers in texts, set to extremes: flipped bits hardly ever make one.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace lightnet::fuzz {

inline constexpr std::array extreme_numbers{
    "0",    "-0",   "1e38",  "-1e38", "3e38",  "1e39",       "1e19",       "-1e19",       "2e18",
    "1e15", "1e16", "1e-45", "1e-38", "1e-20", "1e300",      "-1e300",     "nan",         "inf",
    "-inf", "1",    "-1",    "255",   "65536", "2147483647", "2147483648", "-2147483648", "4294967295",
    "1e9",  "1e-9", "0.5",   "1e10",  "1e-10", "16777217",   "1e17",       "1e-15",       "18446744073709551615"};

/// Puts one of them in the place of the number that follows `at`, if there is any.
inline void make_extreme(std::string& text, std::size_t at, std::size_t which) {
    const auto is_of_number = [](char c) {
        return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e';
    };
    const auto begin = text.find_first_of("0123456789", at);
    if (begin == std::string::npos) return;
    auto from = begin, end = begin;
    while (from > 0 && (text[from - 1] == '-' || text[from - 1] == '.')) --from;
    while (end < text.size() && is_of_number(text[end])) ++end;
    text.replace(from, end - from, extreme_numbers[which % extreme_numbers.size()]);
}

}  // namespace lightnet::fuzz
