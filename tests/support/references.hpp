// Where scenes and reference pictures lie: a few small ones in tests/bench/references; others in a folder that is no
// part of the project, if it is there: LIGHTNET_SHARED names it, or it lies beside the project.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#ifndef LIGHTNET_SHARED_FOLDER
#define LIGHTNET_SHARED_FOLDER ""
#endif

namespace lightnet::test {

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

/// Why what wants one was not run.
inline std::string is_not_here(const std::string& name) {
    return name + " is not here: LIGHTNET_SHARED names the folder that has it";
}

/// Those of `all` whose `file` is here. Tests are made of these alone: what can't be played does not pretend to be one.
template <class T, class FileOf>
std::vector<T> that_are_here(std::vector<T> all, FileOf file_of) {
    std::erase_if(all, [&](const T& one) { return !file_of(one); });
    return all;
}

}  // namespace lightnet::test
