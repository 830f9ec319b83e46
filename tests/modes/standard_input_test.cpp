// Graphs that come from standard input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/modes/daemons.hpp"

namespace lightnet::standard_input_test {
namespace {

using test::graph_file;
using test::program;
using testing::HasSubstr;
using testing::StartsWith;

class StandardInput : public ::testing::Test {
protected:
    struct Ended {
        int code = -1;
        std::string said;
    };
    // In the test's folder, with the file for standard input.
    Ended run(const std::string& words, const std::string& file) const {
        test::Process process({"/bin/sh", "-c",
                               "cd '" + folder.path().string() + "' && exec '" + program("lightnet") + "' " + words +
                                   " < '" + file + "'"});
        const int code = process.wait();
        return {code, process.output()};
    }
    const test::Folder folder;
};

TEST_F(StandardInput, GivesAGraphWhoseFilesLieInTheCurrentFolder) {
    folder.write("cornell_box.pbrt", test::bytes_of(graph_file("cornell_box.pbrt")));
    const auto file = folder.write("elsewhere/graph.lua", test::bytes_of(graph_file("direct.lua")));
    const std::string small = " --size 16x12 --samples 2 --threads 1 --forget";
    const auto ended = run("run -" + small + " -o input.exr", file);
    ASSERT_EQ(ended.code, 0) << ended.said;
    ASSERT_EQ(run("run '" + graph_file("direct.lua") + "'" + small + " -o file.exr", "/dev/null").code, 0);
    EXPECT_TRUE(test::bytes_of(folder / "input.exr") == test::bytes_of(folder / "file.exr"));
}

TEST_F(StandardInput, IsReadOnceForAllFrames) {
    folder.write("cornell_box.pbrt", test::bytes_of(graph_file("cornell_box.pbrt")));
    const auto file =
        folder.write("graph.lua",
                     "direct = DirectLighting {}\nscene = Scene { 'cornell_box.pbrt', exposure = frame }\n"
                     "image = RayTracer { direct, scene = scene, samples = 1, film = { 8, 8 } }");
    const auto ended = run("run - --frames 1-2 --threads 1 --forget", file);
    ASSERT_EQ(ended.code, 0) << ended.said;
    EXPECT_FALSE(test::bytes_of(folder / "stdin.0001.exr") == test::bytes_of(folder / "stdin.0002.exr"));
}

TEST_F(StandardInput, IsNamedWhereItIsWrong) {
    const auto file = folder.write("graph.lua", "sky = AmbientOclusion {}\n\nx = = 3");
    for (const std::string verb : {"run", "check", "dot"}) {
        const auto ended = run(verb + " -", file);
        EXPECT_EQ(ended.code, 2);
        EXPECT_THAT(ended.said, StartsWith("<stdin>:3: ")) << verb;
    }
}

TEST_F(StandardInput, IsAskedForByADashAlone) {
    const auto ended = run("check ./-", "/dev/null");
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.said, HasSubstr("./-: No such file"));
}

}  // namespace
}  // namespace lightnet::standard_input_test
