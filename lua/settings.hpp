// Reads the file of settings, in Lua 5.4: `name = value`, for all verbs, or `verb = { name = value }`.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {

/// A line of it.
struct SettingLine {
    std::string verb;  // "": for all
    std::string name, value;
    SourceLine where;
    friend bool operator==(const SettingLine&, const SettingLine&) = default;
};

/// Forks, so call it before threads are started. In the order of names. Throws UserError when there is any problem.
std::vector<SettingLine> load_settings(const std::string& file);

}  // namespace lightnet
