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

const std::string sequence = "eye = keys { [1] = { 0, 0, 5 }, [11] = { 1, 0, 5 } }\n";

Graph with_shutter(const std::string& scene, GraphFrame frame = {3, 10, true}) {
    return parse_graph(sequence + "scene = Scene { " + scene + " }", "graph.lua", {.constants = {}, .frame = frame});
}

std::string text_of(const Graph& graph, const std::string& name) {
    const auto& params = graph.nodes.at(0).params;
    return params.contains(name) ? to_string(params.at(name)) : "";
}

TEST(GraphFrames, KnowThoseBesideThemWhereAShutterIsOpen) {
    const auto later = with_shutter("'mesh.####.obj', camera = { from = eye }, shutter = { 0, 0.5 }");
    EXPECT_THAT(text_of(later, "next"), HasSubstr("mesh.0004.obj"));
    EXPECT_THAT(text_of(later, "next_camera"), HasSubstr("0.3"));
    EXPECT_EQ(text_of(later, "previous") + text_of(later, "previous_camera"), "") << "it is not open then";
    const auto around = with_shutter("'mesh.####.obj', shutter = { -0.25, 0.25 }");
    EXPECT_THAT(text_of(around, "previous"), HasSubstr("mesh.0002.obj"));
    EXPECT_EQ(text_of(around, "next_camera"), "");
    const auto still = with_shutter("'mesh.obj', shutter = { 0, 0.5 }");
    EXPECT_EQ(text_of(still, "next"), "") << "nothing is another there";
    EXPECT_EQ(text_of(with_shutter("'mesh.####.obj'"), "next"), "") << "nobody looks there";
}

TEST(GraphFrames, KnowTheNextOneWhereMotionIsAskedFor) {
    const auto graph = parse_graph("fps = 10\nscene = Scene { 'a.glb' }\nmotion = SurfaceFact { of = 'motion' }",
                                   "graph.lua", {.constants = {}, .frame = {3, 10, true}});
    const auto& next = std::get<Table>(graph.nodes.at(0).params.at("next").data).named;
    EXPECT_DOUBLE_EQ(std::get<double>(next.at("time").data), 0.3);
    EXPECT_FALSE(next.contains("file")) << "it is the same";
    const auto still = parse_graph("scene = Scene { 'a.glb' } motion = SurfaceFact { of = 'motion' }", "graph.lua");
    EXPECT_EQ(std::get<double>(still.nodes.at(0).params.at("time").data), 0) << "as with a shutter";
}

TEST(GraphFrames, TellMistakesOfThoseBesideThem) {
    const std::string broken = "if frame > 1 then frame = nil + 1 end ";
    EXPECT_THAT(mistake(broken + "scene = Scene { 'a.####.obj', shutter = { 0, 1 } }"),
                HasSubstr("in frame 2, which is beside it: "));
    EXPECT_EQ(mistake(broken + "scene = Scene { 'a.####.obj' }"), "");
}

}  // namespace
}  // namespace lightnet::lua_frames_test
