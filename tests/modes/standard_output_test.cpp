// What a verb is asked to print is there, or the exit code tells.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <map>

#include "tests/modes/daemons.hpp"
#include "tools/cli/verb.hpp"

namespace lightnet::standard_output_test {
namespace {

using test::program;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Words = std::vector<std::string>;

struct Ended {
    int code = -1;
    std::string said;
};

// `redirected`: as shells write it.
Ended run(const Words& words, const std::string& redirected) {
    Words shell{"/bin/sh", "-c", "exec \"$0\" \"$@\" " + redirected};
    shell.insert(shell.end(), words.begin(), words.end());
    test::Process process(shell);
    const int code = process.wait();
    return {code, process.output()};
}

void expect_told(const Words& words) {
    std::string line;
    for (const auto& word : words) line += word + " ";
    const auto full = run(words, ">/dev/full");
    EXPECT_EQ(full.code, 1) << line << "\n" << full.said;
    EXPECT_THAT(full.said, HasSubstr(": standard output can't be written: No space left on device")) << line;
    const auto closed = run(words, ">&-");
    EXPECT_EQ(closed.code, 1) << line << "\n" << closed.said;
    EXPECT_THAT(closed.said, HasSubstr(": standard output can't be written: ")) << line;
}

// What prints something, by its verb; none: the verb prints only its help, or takes too long to be tried.
std::map<std::string, Words> printing(const test::Folder& folder, const std::string& daemon) {
    const std::string picture = folder / "picture.exr", graph = test::graph_file("direct.lua");
    return {{"run", {}},
            {"render", {}},
            {"race", {}},
            {"sweep", {}},
            {"remix", {}},
            {"clean", {}},
            {"bench-hosts", {}},
            {"film", {}},
            {"view", {}},
            {"session", {graph, "--json", "--size", "8x8", "-o", folder / "session.exr"}},
            {"predict", {folder / "picture.run.json", "--places", "2"}},
            {"scene", {"info", test::graph_file("cornell_box.pbrt")}},
            {"check", {graph}},
            {"dot", {graph}},
            {"describe", {"PhotonMap"}},
            {"hosts", {daemon}},
            {"key", {"--key", folder / "key"}},
            {"watch", {folder / "picture.run.json"}},
            {"compare", {picture, picture, "--json"}},
            {"explain", {picture, "1,1", "--json"}},
            {"fit", {picture, "--to", picture}},
            {"doctor", {"--cache", folder / "cache"}},
            {"manual", {"run"}}};
}

TEST(StandardOutput, IsMissedByEveryVerb) {
    const test::Folder folder;
    const test::Daemon daemon(folder);
    ASSERT_EQ(
        launch(test::graph_file("direct.lua"), folder, {"--size", "8x8", "--samples", "1", "--threads", "2"}).code, 0);
    const auto known = printing(folder, daemon.endpoint);
    for (const auto& verb : standard_verbs()) {
        expect_told({program("lightnet"), "help", verb.name});
        const auto found = known.find(verb.name);
        ASSERT_NE(found, known.end()) << verb.name << ": say here what it prints";
        if (found->second.empty()) continue;
        Words words{program("lightnet"), verb.name};
        words.insert(words.end(), found->second.begin(), found->second.end());
        EXPECT_EQ(run(words, ">/dev/null").code, 0) << verb.name;
        expect_told(words);
    }
}

TEST(StandardOutput, IsMissedByBothProgramsThemselves) {
    const test::Folder folder;
    for (const std::string name : {"lightnet", "lightnetd"}) {
        expect_told({program(name), "--help"});
        expect_told({program(name), "--version"});
    }
    expect_told({program("lightnetd"), "--print-key", "--key", folder / "key"});
    expect_told({program("lightnetd"), "--print-config"});
    expect_told({program("lightnet"), "run", "--print-config"});
}

TEST(StandardOutput, MayBeClosedByWhoReadsIt) {
    const test::Folder folder;
    const Words words{program("lightnet"), "describe"};
    const auto head = run(words, "| head -n 1");
    EXPECT_EQ(head.code, 0);
    EXPECT_THAT(head.said, Not(HasSubstr("standard output")));
    // as programs in Python are started
    test::Process ignoring(
        {"/bin/sh", "-c", "trap '' PIPE; { \"$0\" describe; echo code $? >&2; } | head -n 1", program("lightnet")});
    EXPECT_EQ(ignoring.wait(), 0);
    EXPECT_THAT(ignoring.output(), AllOf(HasSubstr("code 0"), Not(HasSubstr("standard output"))));
}

TEST(StandardOutput, IsNotNeededByWhatPrintsNothing) {
    const test::Folder folder;
    const auto words = test::launch_words(test::graph_file("direct.lua"), folder / "x.exr",
                                          {"--size", "16x16", "--samples", "1", "--progress", "none"});
    for (const auto* const redirected : {">/dev/full", ">&-", "<&- >&- 2>&-"}) {
        const auto ended = run(words, redirected);
        EXPECT_EQ(ended.code, 0) << redirected << "\n" << ended.said;
        EXPECT_THAT(ended.said, IsEmpty()) << redirected;
    }
}

TEST(StandardOutput, IsNoFileOfARunThatWasStartedWithoutAny) {
    const test::Folder folder;
    const auto render = [&](const std::string& name, const std::string& redirected) {
        const auto words = test::launch_words(
            test::graph_file("cornell.lua"), folder / name,
            {"--size", "32x32", "--samples", "32", "--progress", "json", "--threads", "2", "--checkpoint", "1"});
        EXPECT_EQ(run(words, redirected).code, 0);
        return test::bytes_of(folder / name);
    };
    EXPECT_TRUE(render("all.exr", "2>/dev/null") == render("none.exr", "<&- >&- 2>&-"));
}

TEST(StandardOutput, IsMissedByADaemonThatServesAllTheSame) {
    const test::Folder folder;
    test::Process daemon({"/bin/sh", "-c", "exec \"$0\" --listen 'tcp://127.0.0.1:*' --cache \"$1\" >/dev/full",
                          program("lightnetd"), folder / "cache"});
    EXPECT_TRUE(daemon.wait_for("can't be written to standard output: No space left on device")) << daemon.output();
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
}

}  // namespace
}  // namespace lightnet::standard_output_test
