// What daemons and launchers say while they work, for programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/this_machine.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/support/schema.hpp"

namespace lightnet::test {
namespace {

using testing::HasSubstr;
using Tree = nlohmann::json;

class JsonLog : public ::testing::Test {
protected:
    std::vector<std::string> words(const std::vector<std::string>& more) {
        const auto hosts = folder.write("lab.lua", "place '" + daemon.endpoint + "' {}\n");
        std::vector<std::string> all{"--hosts", hosts, "--size", "64x64", "--progress", "json"};
        all.insert(all.end(), more.begin(), more.end());
        return launch_words(graph_file("cornell.lua"), folder / "x.exr", all);
    }
    // What was said so far, entry by entry.
    static std::vector<Tree> entries(const std::string& said) {
        std::vector<Tree> all;
        std::istringstream lines(said);
        for (std::string line; std::getline(lines, line);)
            if (line.starts_with('{')) all.push_back(Tree::parse(line));
        return all;
    }
    static Tree entry_with(const std::string& said, const std::string& text) {
        for (const auto& entry : entries(said))
            if (entry.value("text", "").find(text) != std::string::npos) return entry;
        ADD_FAILURE() << "nobody says '" << text << "' in " << said;
        return Tree::object();
    }

    Folder folder;
    Daemon daemon{folder, 1, "tcp://127.0.0.1:*", {"--name", "onyx", "--log-format", "json"}};
};

TEST_F(JsonLog, NamesTheRunAsItsLauncherAndItsReportDo) {
    Process run(words({"--samples", "4"}));
    ASSERT_EQ(run.wait(), 0) << run.output();
    ASSERT_TRUE(daemon.process->wait_for("the run has ended")) << daemon.process->output();
    const auto began = entry_with(daemon.process->output(), "serves a run");
    EXPECT_EQ(began["host"], "onyx");
    EXPECT_EQ(began["program"], "lightnetd");
    EXPECT_EQ(began["level"], "info");
    EXPECT_EQ(began["run"], entry_with(daemon.process->output(), "the run has ended")["run"]);
    EXPECT_EQ(began["run"], Tree::parse(bytes_of(folder / "x.run.json"))["settings"]["run"]);
    const auto wrote = entry_with(run.output(), "wrote");
    EXPECT_EQ(wrote["run"], began["run"]);
    EXPECT_EQ(wrote["host"], machine_name());
    EXPECT_EQ(wrote["level"], "info");
    EXPECT_LT(began["time"].get<std::string>(), wrote["time"].get<std::string>()) << "both are UTC";
}

TEST_F(JsonLog, WarnsOfARunThatIsGivenUp) {
    Process run(words({"--samples", "1000000"}));
    ASSERT_TRUE(run.wait_for("\"progress\"")) << run.output();
    run.signal(SIGKILL);
    ASSERT_TRUE(daemon.process->wait_for("is given up")) << daemon.process->output();
    EXPECT_EQ(entry_with(daemon.process->output(), "is given up")["level"], "warning");
}

TEST_F(JsonLog, IsAsItsSchemaSays) {
    if (!schemas_can_be_checked()) GTEST_SKIP() << "Python's jsonschema (Debian: python3-jsonschema) is not here";
    Process run(words({"--samples", "4"}));
    ASSERT_EQ(run.wait(), 0) << run.output();
    ASSERT_TRUE(daemon.process->wait_for("the run has ended")) << daemon.process->output();
    const auto written = [&](const std::string& name, const std::string& said) {
        std::string lines;
        for (const auto& entry : entries(said)) lines += entry.dump() + "\n";
        return folder.write(name, lines);
    };
    EXPECT_GE(entries(daemon.process->output()).size(), 2u);
    EXPECT_EQ(complaints_of_schema("log", written("log.txt", daemon.process->output()), true), "");
    EXPECT_EQ(complaints_of_schema("progress", written("progress.txt", run.output()), true), "");
}

TEST(LogFormat, IsTextOrJson) {
    Process wrong({program("lightnetd"), "--log-format", "xml"});
    EXPECT_EQ(wrong.wait(), 2);
    EXPECT_THAT(wrong.output(), HasSubstr("must be text or json, not 'xml'"));
}

}  // namespace
}  // namespace lightnet::test
