// Frames as graphs see them: frame, frames, fps, time, and values by keys.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lua/load_graph.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::lua_frames_test {
namespace {

using testing::HasSubstr;

const Value& param(const Graph& graph, const std::string& name) { return graph.nodes.at(0).params.at(name); }

double number(const std::string& expression, GraphFrame frame = {}, std::map<std::string, std::string> constants = {}) {
    const auto graph = parse_graph("scene = Scene { x = " + expression + " }", "graph.lua",
                                   {.constants = std::move(constants), .frame = frame});
    return std::get<double>(param(graph, "x").data);
}

std::string mistake(const std::string& text, std::map<std::string, std::string> constants = {}) {
    return test::error_of([&] { parse_graph(text, "graph.lua", {.constants = std::move(constants), .frame = {}}); });
}

TEST(GraphFrames, AreNumbersOfTheGraph) {
    const GraphFrame frame{13, 240, true};
    EXPECT_EQ(number("frame", frame), 13);
    EXPECT_EQ(number("frames", frame), 240);
    EXPECT_EQ(number("fps", frame), 24);
    EXPECT_EQ(number("time", frame), 0.5) << "the first frame is at 0 s";
    EXPECT_EQ(number("frame + time"), 1) << "a still is the first of one";
    EXPECT_EQ(number("tonumber(string.format('%d', frame))", frame), 13) << "whole";
}

TEST(GraphFrames, FollowTheRateOfTheFileAndOfTheCommandLine) {
    const auto at = [](const std::string& lines, std::map<std::string, std::string> constants) {
        return std::get<double>(param(parse_graph(lines + " scene = Scene { x = time }", "graph.lua",
                                                  {.constants = std::move(constants), .frame = {11, 20, true}}),
                                      "x")
                                    .data);
    };
    EXPECT_EQ(at("fps = 10", {}), 1);
    EXPECT_EQ(at("fps = 10", {{"fps", "20"}}), 0.5);
    EXPECT_EQ(at("", {{"fps", "5"}}), 2);
    EXPECT_EQ(at("frame = 1 fps = 10", {}), 1) << "what is asked for counts, whatever the file gives as its usual";
    EXPECT_EQ(at("time = 7 fps = 3", {}), 7);
    EXPECT_THAT(mistake("fps = 0 scene = Scene {}"),
                HasSubstr("graph.lua:1: 'fps', frames per second, must be above 0"));
    EXPECT_THAT(mistake("scene = Scene {}", {{"fps", "x"}}), HasSubstr("-D fps=x: it is a number"));
}

TEST(GraphFrames, PlaceScenesInTimeWhereTheyAreAskedFor) {
    const auto scene = [](const std::string& more, GraphFrame frame) {
        return parse_graph("scene = Scene { 'mesh.####.obj'" + more + " }", "graph.lua", {.frame = frame}).nodes.at(0);
    };
    EXPECT_EQ(std::get<double>(scene("", {25, 30, true}).params.at("time").data), 1);
    EXPECT_EQ(std::get<double>(scene(", time = 7", {25, 30, true}).params.at("time").data), 7);
    EXPECT_FALSE(scene("", {}).params.contains("time")) << "a still stands as its file has it";
    EXPECT_EQ(std::get<std::string>(scene("", {25, 30, true}).entries.at(0).data), "mesh.0025.obj");
}

TEST(Keys, LieOnStraightLinesBetweenWhichTheyStandStill) {
    const std::string keys = "keys { [1] = 10, [5] = 30, [6] = 0 }";
    EXPECT_EQ(number(keys, {1}), 10);
    EXPECT_EQ(number(keys, {2}), 15);
    EXPECT_EQ(number(keys, {5}), 30);
    EXPECT_EQ(number(keys, {0}), 10);
    EXPECT_EQ(number(keys, {9}), 0);
    EXPECT_EQ(number("keys({ [0] = 1, [2] = 3 }, 0.5)"), 1.5) << "by any number, as by time";
    EXPECT_EQ(number("keys({ 4, 8 }, 1.25)"), 5) << "a list has keys 1, 2 …";
    EXPECT_EQ(number("keys { [1] = { 0, 4 }, [3] = { 2, 8 } }[2]", {2}), 6);
}

TEST(Keys, AreSmoothOrHeldWhereThatIsAskedFor) {
    // Hermite's cubic through 0, 1, 4, 9 at 0 … 3 with slopes of Catmull & Rom: x² within, as those of x² are exact.
    const std::string squares = "keys({ [0] = 0, [1] = 1, [2] = 4, [3] = 9, smooth = true }, ";
    EXPECT_DOUBLE_EQ(number(squares + "1.5)"), 2.25);
    EXPECT_DOUBLE_EQ(number(squares + "1.25)"), 1.5625);
    EXPECT_DOUBLE_EQ(number(squares + "2)"), 4);
    EXPECT_EQ(number("keys({ [0] = 3, [2] = 5, hold = true }, 1.9)"), 3);
    const auto graph = parse_graph("scene = Scene { x = keys({ [0] = 'day', [2] = 'night' }, 1.9) }", "graph.lua");
    EXPECT_EQ(std::get<std::string>(param(graph, "x").data), "day") << "what is no number is held";
}

TEST(Keys, SayWhatIsWrong) {
    EXPECT_THAT(mistake("x = keys(3)"), HasSubstr("graph.lua:1: keys takes a table of values by frame"));
    EXPECT_THAT(mistake("x = keys {}"), HasSubstr("keys takes a table"));
    EXPECT_THAT(mistake("x = keys { [1] = 2, smoth = true }"), HasSubstr("not by 'smoth'"));
    EXPECT_THAT(mistake("x = keys({ [1] = { 1, 2 }, [3] = { 1 } }, 2)"), HasSubstr("as many numbers"));
    EXPECT_THAT(mistake("x = keys({ 1, 2 }, 'now')"), HasSubstr("where to look is a number"));
}

}  // namespace
}  // namespace lightnet::lua_frames_test
