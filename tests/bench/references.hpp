// Where scenes and reference pictures lie: a few small ones in references/, beside these files; others in a folder that
// is no part of the project, if it is there: LIGHTNET_SHARED names it, or it lies beside the project.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace lightnet::bench {

/// A file below the folder beside the project; none: it is not there.
inline std::optional<std::filesystem::path> shared_file(const std::string& name) {
    const char* named = std::getenv("LIGHTNET_SHARED");
    const std::filesystem::path folder = named ? named : LIGHTNET_SHARED_FOLDER;
    if (folder.empty() || !std::filesystem::exists(folder / name)) return std::nullopt;
    return folder / name;
}

/// A scene that has a reference picture, or such a picture.
inline std::optional<std::filesystem::path> reference_file(const std::string& name) {
    const auto shipped = std::filesystem::path(LIGHTNET_SOURCE_DIR "/tests/bench/references") / name;
    return std::filesystem::exists(shipped) ? shipped : shared_file("reference/" + name);
}

/// Why a row that wants one was not run.
inline std::string is_not_here(const std::string& name) {
    return name + " is not here: LIGHTNET_SHARED names the folder that has it";
}

}  // namespace lightnet::bench
