// Words for shells elsewhere.
#pragma once

#include <string>

namespace lightnet {

/// `word` for a shell, whatever is in it.
inline std::string as_shell_word(const std::string& word) {
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

}  // namespace lightnet
