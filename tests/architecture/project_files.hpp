// The files of the project, for the rules of the house.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/architecture/rules.hpp"

namespace lightnet::house {

inline std::filesystem::path root() { return LIGHTNET_SOURCE_DIR; }

/// `path` is from the root.
inline SourceFile read(const std::filesystem::path& path) {
    std::ifstream stream(root() / path, std::ios::binary);
    return {path, {std::istreambuf_iterator<char>(stream), {}}};
}

inline std::vector<SourceFile> files_of(const std::string& room) {
    std::vector<SourceFile> files;
    if (!std::filesystem::exists(root() / room)) return files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root() / room)) {
        const auto kind = entry.path().extension();
        if (!entry.is_regular_file() || (kind != ".cpp" && kind != ".hpp" && kind != ".lua" && kind != ".cmake"))
            continue;
        files.push_back(read(entry.path().lexically_relative(root())));
    }
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
    return files;
}

inline std::vector<SourceFile> all_files() {
    std::vector<SourceFile> files;
    for (const char* room : {"core", "nodes", "transport", "lua", "graphs", "tools", "tests"})
        std::ranges::move(files_of(room), std::back_inserter(files));
    return files;
}

}  // namespace lightnet::house
