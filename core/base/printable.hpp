// Text from files, for a terminal and for messages.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace lightnet {

/// The text, with what would command a terminal, and what is no UTF-8, as \xNN. Ends of lines and tabs stay where
/// `lines` is set; else they are written out, too.
std::string printable(std::string_view text, bool lines = false);

/// 'text', as messages show what a user wrote.
inline std::string quoted(std::string text) { return "'" + std::move(text) + "'"; }

}  // namespace lightnet
