// Names in messages.
#pragma once

#include <string>
#include <string_view>

namespace lightnet {

/// 'text'
inline std::string in_quotes(std::string_view text) { return "'" + std::string(text) + "'"; }

}  // namespace lightnet
