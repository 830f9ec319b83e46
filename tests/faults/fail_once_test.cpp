// Everything fails once: one call of the system's after the other, of each kind, while programs run (fail_once.cpp).
// What comes of it is what would have come of it anyway, or one of the promised exit codes with a sentence; never a
// signal or a hang, and nothing is left behind. Which calls: a few of each kind; with LIGHTNET_LARGE, all (ctest -L
// slow).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/prctl.h>

#include <cstring>
#include <functional>
#include <optional>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Whose calls can't fail without an end that nobody can help.
const std::string spared =
    "libzmq:"        // asserts that its own calls succeed, and aborts; what it will need is asked for beforehand
    "libtbbmalloc:"  // tries for ever where its first mapping fails
    "ld-linux";      // what libraries do while they are loaded, before there is a main() that could say anything

/// What is run, in a folder of its own; "@" in words is that folder.
struct Case {
    std::string name;
    Words words;
    bool makes_a_picture = false, asks_a_daemon = false;
};
std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name; }

Words rendering(const Words& more) {
    Words words{
        program("lightnet"), "run",    graph_file("cornell.lua"), "--size", "16x16", "--samples", "2", "-o", "@/p.exr",
        "--cache",           "@/cache"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

const std::vector<Case>& cases() {
    static const std::vector<Case> all{
        {"threads", rendering({"--threads", "2"}), true},
        {"worker", rendering({"--local-workers", "1", "--wait", "8"}), true},
        {"daemon", rendering({"--hosts", "@/hosts.lua", "--wait", "8"}), true, true},
        {"check", {program("lightnet"), "check", graph_file("cornell.lua")}},
        {"describe", {program("lightnet"), "describe", "PhotonMap"}},
        {"dot", {program("lightnet"), "dot", graph_file("cornell.lua")}},
        {"scene", {program("lightnet"), "scene", "info", graph_file("cornell_box.pbrt")}},
        {"compare", {program("lightnet"), "compare", "@/old.exr", "@/old.exr"}},
        {"explain", {program("lightnet"), "explain", "@/old.exr", "3,3"}},
        {"remix", {program("lightnet"), "remix", "@/old.exr", "-o", "@/p.exr"}},
        {"key", {program("lightnet"), "key", "--key", "@/key"}},
    };
    return all;
}

/// Kinds of calls; of memory, from how many bytes on.
struct Kind {
    std::string name;
    std::size_t least = 0;
};
const std::vector<Kind> kinds{{"memory", 1024}, {"map"},    {"write"},   {"sync"},       {"rename"},
                              {"open"},         {"thread"}, {"process"}, {"descriptor"}, {"read"}};

/// The number of the next call that fails: 1, 2, 3, 4, 6, 9, 13 …
std::size_t next(std::size_t at) {
#ifdef LIGHTNET_LARGE
    return at + 1;
#else
    return at + std::max<std::size_t>(1, at / 2);
#endif
}

std::vector<int> children() {
    std::ifstream in("/proc/self/task/" + std::to_string(getpid()) + "/children");
    std::vector<int> all;
    for (int child = 0; in >> child;) all.push_back(child);
    return all;
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    return names;
}

class FailOnce : public ::testing::TestWithParam<Case> {
protected:
    static void SetUpTestSuite() {
        ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // what a program leaves behind comes to us
        shelf = new Folder;
        const auto made =
            launch(graph_file("cornell.lua"), *shelf, {"--size", "16x16", "--samples", "2", "--threads", "1"});
        ASSERT_EQ(made.code, 0) << made.said;
        picture = new std::string(made.picture);
    }
    static void TearDownTestSuite() {
        delete picture;
        delete shelf;
    }

    // The program runs once, with the `at`-th call of the kind failing; 0: none. False: there is no such call any more.
    bool survives(const Kind& kind, std::size_t at) {
        const Folder folder;
        SCOPED_TRACE("call " + std::to_string(at) + " of " + kind.name);
        fs::create_directory(folder / "tmp");
        for (const auto* name : {"old.exr", "p.exr"}) folder.write(name, *picture + (name[0] == 'p' ? "old" : ""));
        fs::copy_file(*shelf / "picture.run.json", folder / "old.run.json");
        folder.write("note", std::string(1 << 16, '\0'));
        std::optional<Daemon> daemon;
        if (GetParam().asks_a_daemon) {
            daemon.emplace(*shelf);
            folder.write("hosts.lua", "place '" + daemon->endpoint + "' {}\n");
        }
        const auto others = children();
        Process run(words_of(folder, kind, at));
        const int code = run.wait(slowdown * std::chrono::seconds(60));
        const std::string note = bytes_of(folder / "note");
        if (at == 0) {
            EXPECT_EQ(code, 0) << "nothing has failed\n" << run.output();
        }
        const std::string told =
            note.substr(2 * sizeof(std::size_t), note.find('\0', 2 * sizeof(std::size_t)) - 2 * sizeof(std::size_t));
        if (told.empty()) return false;
        judge(folder, code, run.output());
        EXPECT_EQ(children(), others) << "it left processes behind";
        if (daemon) {
            EXPECT_LT(daemon->process->wait(std::chrono::milliseconds(1)), 0) << daemon->process->output();
        }
        if (HasFailure()) ADD_FAILURE() << "ended with " << code << "\n" << run.output() << "\ncalled by" << told;
        return true;
    }

private:
    static Words words_of(const Folder& folder, const Kind& kind, std::size_t at) {
        Words words{"/usr/bin/env",
                    "LD_PRELOAD=" LIGHTNET_FAIL_ONCE,
                    "LIGHTNET_FAIL=" + kind.name,
                    "LIGHTNET_FAIL_AT=" + std::to_string(at),
                    "LIGHTNET_FAIL_LEAST=" + std::to_string(kind.least),
                    "LIGHTNET_FAIL_NOTE=" + folder.file("note"),
                    "LIGHTNET_FAIL_SPARES=" + spared,
                    "TMPDIR=" + folder.file("tmp"),
                    "LIGHTNET_CONFIG=" + folder.file("none.lua")};
        for (std::string word : GetParam().words) {
            if (word.starts_with("@")) word = folder.path().string() + word.substr(1);
            words.push_back(std::move(word));
        }
        return words;
    }

    static void judge(const Folder& folder, int code, const std::string& said) {
        EXPECT_THAT(code, testing::AnyOf(0, 1, 2, 3, 4)) << (code < 0 ? "it hangs" : "it was ended by a signal");
        EXPECT_TRUE(code == 0 || !said.empty()) << "it fails without a word";
        const auto now = bytes_of(folder / "p.exr");
        if (GetParam().makes_a_picture) {
            EXPECT_TRUE(now == *picture || (code != 0 && now == *picture + "old")) << "the picture is neither";
        }
        for (const auto& name : names_in(folder.path()))
            EXPECT_TRUE(name[0] != '.' && name.find(".part") == std::string::npos) << "left behind: " << name;
        for (const auto& name : names_in(folder / "tmp"))
            EXPECT_NE(said.find(name), std::string::npos) << "left behind without a word: " << name;
    }

    static inline Folder* shelf = nullptr;
    static inline std::string* picture = nullptr;
};

TEST_P(FailOnce, AndItIsTheSameOrAPromisedCode) {
    survives(kinds.front(), 0);  // or what comes of failures would say nothing
    ASSERT_FALSE(HasFailure());
    std::size_t tried = 0;
    for (const Kind& kind : kinds)
        for (std::size_t at = 1; survives(kind, at) && !HasFailure(); at = next(at)) ++tried;
    EXPECT_GT(tried, kinds.size()) << "hardly anything failed: the library is not loaded";
    RecordProperty("failed_calls", static_cast<int>(tried));
}

INSTANTIATE_TEST_SUITE_P(Each, FailOnce, testing::ValuesIn(cases()), [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace lightnet::test
