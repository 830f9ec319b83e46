// Graph files, read for a process that has threads.
#include "lua/graph_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "tests/support/folder.hpp"

namespace lightnet::graph_reader_test {
namespace {

using testing::HasSubstr;

class GraphReaderTest : public ::testing::Test {
protected:
    void write(const std::string& text) { std::ofstream(folder / "g.lua") << text; }
    std::string file() const { return folder / "g.lua"; }

    test::Folder folder;
    GraphReader reader;
};

TEST_F(GraphReaderTest, ReadsAsAnybodyDoes) {
    write("rays = 4\nlight = DirectLighting { samples = rays * frame }\n");
    const LuaOptions options{.constants = {{"rays", "8"}}, .frame = {3, 5, true}};
    std::thread beside([&] { EXPECT_EQ(reader.read(file(), options).graph, read_graph(file(), options).graph); });
    beside.join();
    EXPECT_EQ(reader.read(file(), options).graph.nodes[0].params.at("samples"), Value{24.0});
}

TEST_F(GraphReaderTest, SeesAFileThatHasChanged) {
    for (int i = 0; i < 20; ++i) {
        write("light = DirectLighting { samples = " + std::to_string(i) + " }\n");
        EXPECT_EQ(reader.read(file(), {}).graph.nodes[0].params.at("samples"), Value{double(i)});
    }
}

TEST_F(GraphReaderTest, SeesFilesThatOthersAskFor) {
    const auto of_other = [&](const std::string& samples) {
        std::ofstream(folder / "other.lua") << "return " + samples + "\n";
        return reader.read(file(), {}).graph.nodes[0].params.at("samples");
    };
    write("local ask = require\nlight = DirectLighting { samples = ask 'other' }\n");
    EXPECT_EQ(of_other("2"), Value{2.0});
    EXPECT_EQ(of_other("3"), Value{3.0});
    write("local there, other = pcall(require, 'third')\nlight = DirectLighting { samples = there and other or 1 }\n");
    EXPECT_EQ(of_other("4"), Value{1.0});
    std::ofstream(folder / "third.lua") << "return 5\n";
    EXPECT_EQ(of_other("4"), Value{5.0});
}

// Ends the processes that this one has started.
void end_children() {
    std::ifstream children("/proc/thread-self/children");
    for (pid_t child = 0; children >> child;) ::kill(child, SIGKILL);
}

TEST_F(GraphReaderTest, EvaluatesNothingAgainThatIsAsItWas) {
    write("rays = 2\nlight = DirectLighting { samples = rays }\n");
    const auto samples = [&](const LuaOptions& options) {
        return reader.read(file(), options).graph.nodes[0].params.at("samples");
    };
    EXPECT_EQ(samples({}), Value{2.0});
    EXPECT_EQ(samples({.constants = {{"rays", "8"}}}), Value{8.0});
    end_children();
    EXPECT_EQ(samples({.constants = {{"rays", "8"}}}), Value{8.0}) << "it was there";
    EXPECT_THROW(samples({}), UserError) << "it has to be evaluated, and nobody is left who could";
}

TEST_F(GraphReaderTest, TellsMistakesWithTheirLines) {
    write("\nlocal light = DirectLighting { samples = 2 }\n");
    const auto problems = reader.read(file(), {}).problems;
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].where, (SourceLine{file(), 2}));
    write("= 3\n");
    try {
        reader.read(file(), {});
        FAIL();
    } catch (const UserError& error) {
        EXPECT_EQ(error.problems().at(0).where.line, 1);
    }
    write("while true do end\n");
    EXPECT_THROW(reader.read(file(), {.cpu_seconds = 0.1}), UserError);
    write("light = DirectLighting {}\n");
    EXPECT_EQ(reader.read(file(), {}).graph.nodes.size(), 1u) << "it goes on";
}

}  // namespace
}  // namespace lightnet::graph_reader_test
