// Reads the files that Lua code is in.
#pragma once

#include <string>

namespace lightnet::lua {

/// The text of the file that the user named. Throws Error.
std::string read_text(const std::string& file);

/// All that comes from standard input. Throws Error.
std::string read_standard_input();

/// The text of `path`, if it is, by its real path, a plain file in the real folder `folder` or below. Throws Error.
std::string read_text_inside(const std::string& folder, const std::string& path);

}  // namespace lightnet::lua
