// Text from files, for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace lightnet {

/// The text, with what would command a terminal, and what is no UTF-8, as \xNN. Ends of lines and tabs stay where
/// `lines` is set; else they are written out, too.
std::string printable(std::string_view text, bool lines = false);

/// Names of files are bytes, and old ones are no UTF-8.
bool is_utf8(std::string_view text);

/// The text as it is, where it is UTF-8; else printable().
std::string in_utf8(const std::string& text);

}  // namespace lightnet
