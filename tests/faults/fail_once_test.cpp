// Everything fails once: one call of the system's after the other, of each kind, while programs run (fail_once.cpp).
// What comes of it is what would have come of it anyway, or one of the promised exit codes with a sentence; never a
// signal or a hang, and nothing is left behind. Which calls: a few of each kind; with LIGHTNET_LARGE, all (ctest -L
// slow).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/prctl.h>
#include <sys/wait.h>

#include <cstdlib>
#include <functional>
#include <optional>
#include <thread>

#include "tests/faults/failing.hpp"

namespace lightnet::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// What is run, in a folder of its own; "@" in words is that folder.
struct Case {
    std::string name;
    Words words;
    bool makes_a_picture = false, asks_a_daemon = false, starts_by_slurm = false;
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
        {"ssh", rendering({"--ssh", "left", "--ssh-command", "@/ssh", "--listen", "tcp://127.0.0.1:*", "--wait", "8"}),
         true},
        {"slurm", rendering({"--slurm", "1", "--listen", "tcp://127.0.0.1:*", "--wait", "8"}), true, false, true},
        {"check", {program("lightnet"), "check", graph_file("cornell.lua")}},
        {"describe", {program("lightnet"), "describe", "PhotonMap"}},
        {"dot", {program("lightnet"), "dot", graph_file("cornell.lua")}},
        {"scene", {program("lightnet"), "scene", "info", graph_file("cornell_box.pbrt")}},
        {"compare", {program("lightnet"), "compare", "@/old.exr", "@/old.exr"}},
        {"explain", {program("lightnet"), "explain", "@/old.exr", "3,3"}},
        {"remix", {program("lightnet"), "remix", "@/old.exr", "-o", "@/p.exr"}},
        {"key", {program("lightnet"), "key", "--key", "@/key"}},
        {"watch", {program("lightnet"), "watch", "@/old.run.json"}},
        {"fit", {program("lightnet"), "fit", "@/old.exr", "--to", "@/old.exr", "-o", "@/p.exr"}},
        {"hosts", {program("lightnet"), "hosts", "@/hosts.lua"}, false, true},
        {"doctor", {program("lightnet"), "doctor", "--hosts", "@/hosts.lua", "--cache", "@/cache"}, false, true},
    };
    return all;
}

std::vector<int> children() {
    std::ifstream in("/proc/self/task/" + std::to_string(getpid()) + "/children");
    std::vector<int> all;
    for (int child = 0; in >> child;) all.push_back(child);
    return all;
}

// Those whose end the system has not told yet are given a while for it.
std::vector<int> children_after(const std::vector<int>& before) {
    const auto end = std::chrono::steady_clock::now() + slowdown * std::chrono::seconds(10);
    auto now = children();
    for (; now != before && std::chrono::steady_clock::now() < end; now = children()) {
        for (const int child : now)
            if (std::find(before.begin(), before.end(), child) == before.end()) ::waitpid(child, nullptr, WNOHANG);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return now;
}

// Stand for ssh and for Slurm: do here what they are told.
void write_stand_ins(const Folder& folder) {
    const auto script = [&](const char* name, const std::string& text) {
        fs::permissions(folder.write(name, "#!/bin/sh\n" + text), fs::perms::owner_all);
    };
    script("ssh", "for last; do :; done\nexec sh -c \"$last\"\n");
    script("sbatch", "cat >" + folder.file("job") +
                         "\nexport SLURM_ARRAY_JOB_ID=7 SLURM_ARRAY_TASK_ID=1 SLURM_CPUS_ON_NODE=1\nsh " +
                         folder.file("job") + " >/dev/null 2>&1 &\necho $! >" + folder.file("process") + "\necho 7\n");
    script("scancel", "kill $(cat " + folder.file("process") + ")\n");
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
    bool survives(const FailingKind& kind, std::size_t at) {
        const Folder folder;
        SCOPED_TRACE("call " + std::to_string(at) + " of " + kind.name);
        write_stand_ins(folder);
        for (const auto* name : {"old.exr", "p.exr"}) folder.write(name, *picture + (name[0] == 'p' ? "old" : ""));
        fs::copy_file(*shelf / "picture.run.json", folder / "old.run.json");
        std::optional<Daemon> daemon;
        if (GetParam().asks_a_daemon) {
            daemon.emplace(*shelf);
            folder.write("hosts.lua", "place '" + daemon->endpoint + "' {}\n");
        }
        const auto others = children();
        Process run(words_of(folder, kind, at));
        const int code = run.wait(slowdown * std::chrono::seconds(60));
        if (at == 0) {
            EXPECT_EQ(code, 0) << "nothing has failed\n" << run.output();
        }
        const std::string told = what_failed(folder);
        if (told.empty()) return false;
        // What can't be cancelled leaves by itself, in a minute.
        if (GetParam().starts_by_slurm) Process({"/bin/sh", folder.file("scancel")}).wait();
        EXPECT_EQ(children_after(others), others) << "it left processes behind";
        judge(folder, code, run.output());
        if (daemon) {
            EXPECT_LT(daemon->process->wait(std::chrono::milliseconds(1)), 0) << daemon->process->output();
        }
        if (HasFailure()) ADD_FAILURE() << "ended with " << code << "\n" << run.output() << "\ncalled by" << told;
        return true;
    }

private:
    static Words words_of(const Folder& folder, const FailingKind& kind, std::size_t at) {
        // Of the programs that stand for Slurm none fails: what they leave is nobody's.
        Words words = failing_words(folder, kind, at, GetParam().starts_by_slurm ? "lightnet" : "");
        words.insert(words.begin() + 1,
                     {"HOME=" + folder.file("home"), "PATH=" + folder.path().string() + ":" + std::getenv("PATH")});
        for (std::string word : GetParam().words) {
            if (word.starts_with("@")) word = folder.file(word.substr(2));
            words.push_back(std::move(word));
        }
        return words;
    }

    static void judge(const Folder& folder, int code, const std::string& said) {
        EXPECT_THAT(code, testing::AnyOf(0, 1, 2, 3, 4)) << (code < 0 ? "it hangs" : "it was ended by a signal");
        EXPECT_TRUE(code == 0 || !said.empty()) << "it fails without a word";
        EXPECT_EQ(names_of_the_library(said), "") << "that is no sentence";
        const auto now = bytes_of(folder / "p.exr");
        if (GetParam().makes_a_picture) {
            EXPECT_TRUE(now == *picture || (code != 0 && now == *picture + "old")) << "the picture is neither";
        }
        EXPECT_EQ(left_behind(folder, said), "");
    }

    static inline Folder* shelf = nullptr;
    static inline std::string* picture = nullptr;
};

TEST_P(FailOnce, AndItIsTheSameOrAPromisedCode) {
    survives(failing_kinds.front(), 0);  // or what comes of failures would say nothing
    ASSERT_FALSE(HasFailure());
    std::size_t tried = 0;
    for (const FailingKind& kind : failing_kinds)
        for (std::size_t at = 1; survives(kind, at) && !HasFailure(); at = next_failing(at)) ++tried;
    EXPECT_GT(tried, failing_kinds.size()) << "hardly anything failed: the library is not loaded";
    RecordProperty("failed_calls", static_cast<int>(tried));
}

INSTANTIATE_TEST_SUITE_P(Each, FailOnce, testing::ValuesIn(cases()), [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace lightnet::test
