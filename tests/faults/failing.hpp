// One call of the system's after the other fails (fail_once.cpp): which, and how a program is told.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {

/// Whose calls can't fail without an end that nobody can help.
inline const std::string spared =
    "libzmq:"        // asserts that its own calls succeed, and aborts; what it will need is asked for beforehand
    "libtbbmalloc:"  // tries for ever where its first mapping fails
    "ld-linux";      // what libraries do while they are loaded, before there is a main() that could say anything

/// Kinds of calls; of memory, from how many bytes on.
struct FailingKind {
    std::string name;
    std::size_t least = 0;
};
inline const std::vector<FailingKind> failing_kinds{{"memory", 1024}, {"map"},  {"write"},  {"sync"},
                                                    {"rename"},       {"open"}, {"thread"}, {"process"},
                                                    {"descriptor"},   {"read"}};

/// The number of the next call that fails: each with LIGHTNET_LARGE, else 1, 2, 3, 4, 6, 9, 13 …
inline std::size_t next_failing(std::size_t at) {
#ifdef LIGHTNET_LARGE
    return at + 1;
#else
    return at + std::max<std::size_t>(1, at / 2);
#endif
}

/// The first words of a program whose `at`-th call of a kind fails, in processes of that name ("": of any). It notes
/// what failed in "note", and leaves what is temporary in "tmp".
inline std::vector<std::string> failing_words(const Folder& folder, const FailingKind& kind, std::size_t at,
                                              const std::string& in = "") {
    std::filesystem::create_directory(folder / "tmp");
    folder.write("note", std::string(1 << 16, '\0'));
    return {"/usr/bin/env",
            "LD_PRELOAD=" LIGHTNET_FAIL_ONCE,
            "LIGHTNET_FAIL=" + kind.name,
            "LIGHTNET_FAIL_AT=" + std::to_string(at),
            "LIGHTNET_FAIL_LEAST=" + std::to_string(kind.least),
            "LIGHTNET_FAIL_NOTE=" + folder.file("note"),
            "LIGHTNET_FAIL_SPARES=" + spared,
            "LIGHTNET_FAIL_IN=" + in,
            "TMPDIR=" + folder.file("tmp"),
            "LIGHTNET_CONFIG=" + folder.file("none.lua")};
}

/// What failed, and by whom it was called; "": there was no such call.
inline std::string what_failed(const Folder& folder) {
    const std::string note = bytes_of(folder / "note");
    const std::size_t before = 2 * sizeof(std::size_t);
    return note.substr(before, note.find('\0', before) - before);
}

/// Names of the library's classes, which are no words for people; "": there is none in what was said.
inline std::string names_of_the_library(const std::string& said) {
    for (const std::string name : {"std::", "basic_", "filesystem error"})
        if (said.find(name) != std::string::npos) return name;
    return "";
}

/// What lies there that should not, as a complaint: files that were being written, and what is temporary and was not
/// `said`.
inline std::string left_behind(const Folder& folder, const std::string& said) {
    std::string complaint;
    const auto look = [&](const std::filesystem::path& where, const auto& is_right) {
        if (!std::filesystem::exists(where)) return;
        for (const auto& entry : std::filesystem::directory_iterator(where))
            if (const auto name = entry.path().filename().string(); !is_right(name))
                complaint += "left behind: " + entry.path().string() + "\n";
    };
    const auto whole = [](const std::string& name) {
        return name[0] != '.' && name.find(".part") == std::string::npos;
    };
    look(folder.path(), whole);
    look(folder / "cache", whole);
    look(folder / "tmp", [&](const std::string& name) { return said.find(name) != std::string::npos; });
    return complaint;
}

}  // namespace lightnet::test
