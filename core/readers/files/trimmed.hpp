// Text without what stands around it.
#pragma once

#include <string_view>

namespace lightnet {

/// Without the characters of `around` at its beginning and end.
inline std::string_view trimmed(std::string_view text, std::string_view around) {
    const auto first = text.find_first_not_of(around);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(around) - first + 1);
}

/// Without the mark of UTF-8 that some editors write first.
inline std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

}  // namespace lightnet
