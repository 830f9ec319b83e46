// The user's settings: of options that a command line leaves open, the environment decides, then the
// file of settings, then what is built in.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lua/settings.hpp"
#include "tools/words/program_text.hpp"

namespace lightnet {

/// A value that an option has, and who says so.
struct Settled {
    std::string option;  // "--threads"
    std::string value;
    std::string source;  // "command line", "LIGHTNET_THREADS", "config.lua:3", "built in"
    friend bool operator==(const Settled&, const Settled&) = default;
};

/// A value. What it gives is words of a command line, which is then taken apart as any other.
struct Settings {
    std::string prefix;                                                           // "LIGHTNET_"
    std::vector<SettingLine> lines = {};                                          // of the file
    std::function<std::optional<std::string>(const std::string&)> variable = {};  // of the environment

    /// For all options of `verb`, by `words`, what stands behind its name.
    std::vector<Settled> settled(const VerbText& verb, const std::vector<std::string>& words) const;
    /// The words that say what `words` leave open.
    std::vector<std::string> missing(const VerbText& verb, const std::vector<std::string>& words) const;
};

/// $LIGHTNET_CONFIG, else config.lua below ~/.config/lightnet; "": there is no home.
std::string settings_file();

/// Of this user: the environment, and the file if it is there. Of its tables, `lightnetd` is for the daemon alone,
/// which takes nothing else of it. Throws UserError that names all lines that no program knows. Before threads are
/// started.
Settings settings_of_launcher();
Settings settings_of_daemon();

/// One line for each: name, value, source.
std::string settings_table(const std::vector<Settled>& all);

}  // namespace lightnet
