// Graph files, read for a process that has threads.
#include "lua/graph_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
