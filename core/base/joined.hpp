// Lists in messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lightnet {

/// "a, b, c"
inline std::string joined(const std::vector<std::string>& words, std::string_view between = ", ") {
    std::string text;
    for (const auto& word : words) {
        if (&word != &words.front()) text += between;
        text += word;
    }
    return text;
}

}  // namespace lightnet
