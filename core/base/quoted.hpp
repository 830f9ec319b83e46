// Names in messages.
#pragma once

#include <string>
#include <string_view>

namespace lightnet {

/// 'text'. An overload for each kind of text, or std::quoted() would fit better where it is included.
inline std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }
inline std::string quoted(const std::string& text) { return quoted(std::string_view(text)); }
inline std::string quoted(const char* text) { return quoted(std::string_view(text)); }

}  // namespace lightnet
