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

}  // namespace lightnet
