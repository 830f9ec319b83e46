#include "core/network/graph/check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/network/graph/graph_film.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::check_test {
namespace {

using test::fake_registry;
using test::parse;
using test::problems_of;
using test::sound_graph;
using testing::ElementsAre;
using testing::HasSubstr;

// A renderer and a scene, on one line, for graphs whose fault is elsewhere.
const std::string rest = "scene = Scene { 'box.pbrt' } image = RayTracer { sky, scene = scene, film = { 8, 4 } }";

TEST(Check, FillsInDefaults) {
    const Graph graph = sound_graph("lighting = Ambient { soft = true }");
    EXPECT_EQ(graph.nodes[0].params.at("rays"), Value{4.0});
    EXPECT_EQ(graph.nodes[0].params.at("soft"), Value{true});
    EXPECT_FALSE(graph.nodes[0].params.contains("reach")) << "what is optional stays away";
}

TEST(Check, SuggestsTheKindYouMeant) {
    EXPECT_EQ(problems_of("sky = Ambeint {}\n" + rest),
              "graph.lua:1: Ambeint 'sky': unknown kind (did you mean 'Ambient'?)");
}

TEST(Check, NamesTheKindsWhenNothingIsClose) {
    EXPECT_THAT(problems_of("sky = Volcano {}\n" + rest),
                HasSubstr("Volcano 'sky': unknown kind (there is: Ambient, Cache, Combine, RayTracer, Reuse, Scene)"));
}

TEST(Check, SuggestsTheParamYouMeant) {
    EXPECT_EQ(problems_of("\n\nsky = Ambient { ray = 4 }\n" + rest),
              "graph.lua:3: Ambient 'sky': unknown parameter 'ray' (did you mean 'rays'?)");
}

TEST(Check, SuggestsTheNodeYouMeant) {
    EXPECT_EQ(problems_of("caustics = Ambient {}\nsky = Combine { caustic }\n" + rest),
              "graph.lua:2: Combine 'sky': no node called 'caustic' (did you mean 'caustics'?)");
}

TEST(Check, WantsTheRightTypes) {
    EXPECT_THAT(problems_of("sky = Ambient { rays = '4' }\n" + rest),
                HasSubstr("'rays' must be an integer, not a text"));
    EXPECT_THAT(problems_of("sky = Ambient { rays = 2.5 }\n" + rest), HasSubstr("'rays' must be an integer, not 2.5"));
    EXPECT_THAT(problems_of("sky = Ambient { reach = true }\n" + rest),
                HasSubstr("'reach' must be a number, not a flag"));
    EXPECT_THAT(problems_of("sky = Ambient { soft = 1 }\n" + rest),
                HasSubstr("'soft' must be true or false, not a number"));
    EXPECT_THAT(problems_of("sky = Ambient { paths = 1 }\n" + rest), HasSubstr("'paths' must be a text, not a number"));
    EXPECT_THAT(problems_of("a = Ambient {} sky = Combine { a, weights = 2 }\n" + rest),
                HasSubstr("'weights' must be a table of numbers, not a number"));
    EXPECT_THAT(problems_of("a = Ambient {} sky = Combine { a, weights = { 'x' } }\n" + rest),
                HasSubstr("entry 1 of 'weights' must be a number, not a text"));
}

TEST(Check, WantsNumbersInTheirRange) {
    EXPECT_EQ(problems_of("sky = Ambient { rays = 0 }\n" + rest),
              "graph.lua:1: Ambient 'sky': 'rays' is 0, but must be 1 … 64 samples");
    EXPECT_THAT(problems_of("sky = Ambient { reach = -1 }\n" + rest),
                HasSubstr("'reach' is -1, but must be at least 0 m"));
    EXPECT_THAT(problems_of("sky = Ambient { reach = math.huge }\n" + rest),
                HasSubstr("'reach' must be a finite number"));
    EXPECT_THAT(problems_of("sky = Ambient { reach = 0/0 }\n" + rest), HasSubstr("'reach' must be a finite number"));
}

TEST(Check, SuggestsTheChoiceYouMeant) {
    EXPECT_THAT(problems_of("sky = Ambient { paths = 'caustik' }\n" + rest),
                HasSubstr("'paths' can't be 'caustik' (did you mean 'caustic'?)"));
}

TEST(Check, SaysWhichParamIsMissing) {
    EXPECT_THAT(problems_of("sky = Ambient {}\nimage = RayTracer { sky, film = { 8, 8 } }"),
                HasSubstr("graph.lua:2: RayTracer 'image': parameter 'scene' is missing: what is seen"));
}

TEST(Check, CountsInputs) {
    EXPECT_THAT(problems_of("sky = Combine {}\n" + rest), HasSubstr("Combine 'sky': needs at least 1 input, has 0"));
    EXPECT_THAT(problems_of("a = Ambient {} sky = Ambient { a }\n" + rest), HasSubstr("takes no inputs, has 1"));
    EXPECT_THAT(problems_of("a = Ambient {} sky = Cache { a, a }\n" + rest), HasSubstr("takes at most 1 input, has 2"));
}

TEST(Check, WantsOneWeightForEachInput) {
    EXPECT_THAT(problems_of("a = Ambient {} sky = Combine { a, a, weights = { 1 } }\n" + rest),
                HasSubstr("'weights' must have one number for each of the 2 inputs, not 1"));
    EXPECT_EQ(problems_of("a = Ambient {} sky = Combine { a, a, weights = {} }\n" + rest), "");
}

TEST(Check, WantsNodesAsInputs) {
    EXPECT_THAT(problems_of("sky = Combine { 3 }\n" + rest), HasSubstr("input 1 is a number, but must be a node"));
}

TEST(Check, WantsLightAsInput) {
    EXPECT_THAT(problems_of("sky = Combine { image }\n" + rest),
                HasSubstr("input 1, 'image', gives an image, but light is wanted"));
    EXPECT_THAT(
        problems_of(
            "sky = Ambient {}\nbox = Scene { 'b.pbrt' }\nimage = RayTracer { box, scene = box, film = { 8, 8 } }"),
        HasSubstr("input 1, 'box', gives a scene, but light is wanted (write scene = box)"));
}

TEST(Check, WantsASceneAsScene) {
    EXPECT_THAT(problems_of("sky = Ambient {}\nimage = RayTracer { sky, scene = sky, film = { 8, 8 } }"),
                HasSubstr("'scene' must be a Scene, but 'sky' is of kind Ambient"));
    EXPECT_THAT(problems_of("sky = Ambient {}\nimage = RayTracer { sky, scene = 'box.pbrt', film = { 8, 8 } }"),
                HasSubstr("'scene' must be a Scene, not a text"));
    EXPECT_THAT(
        problems_of(
            "sky = Ambient {} box = Scene { 'b.pbrt' }\nimage = RayTracer { sky, scene = bix, film = { 8, 8 } }"),
        HasSubstr("no scene called 'bix' (did you mean 'box'?)"));
}

TEST(Check, WantsOneFileInAScene) {
    EXPECT_THAT(
        problems_of("sky = Ambient {} scene = Scene {} image = RayTracer { sky, scene = scene, film = { 8, 8 } }"),
        HasSubstr("Scene 'scene': takes the name of one file"));
}

TEST(Check, WantsAFilmWithTwoSides) {
    const std::string start =
        "sky = Ambient {} scene = Scene { 'b.pbrt' } image = RayTracer { sky, scene = scene, film = ";
    EXPECT_THAT(problems_of(start + "{ 8 } }"), HasSubstr("'film' must be a table like { width, height"));
    EXPECT_THAT(problems_of(start + "{ 8, 0 } }"), HasSubstr("'film' has a side of 0, but must be 1 … 16384 pixels"));
    EXPECT_THAT(problems_of(start + "{ 8, 8, fiel = 'x.exr' } }"),
                HasSubstr("'film' has an unknown entry 'fiel' (did you mean 'file'?)"));
    EXPECT_THAT(problems_of(start + "{ 8, 8, file = 3 } }"),
                HasSubstr("'file' of 'film' must be a text, not a number"));
    EXPECT_EQ(problems_of(start + "{ 8, 8, file = 'x.exr' } }"), "");
}

TEST(Check, FindsNamesThatAreTaken) {
    EXPECT_THAT(problems_of("sky = Ambient {}\nsky = Ambient {}\n" + rest),
                HasSubstr("graph.lua:2: Ambient 'sky': the name is taken by the Ambient of line 1"));
}

TEST(Check, WantsNamesThatCanBeWritten) {
    EXPECT_THAT(problems_of("_ENV['my sky'] = Ambient {}\nsky = Ambient {}\n" + rest),
                HasSubstr("a name is made of letters"));
    EXPECT_THAT(problems_of("emission = Ambient {}\nsky = Ambient {}\n" + rest), HasSubstr("the name is reserved"));
}

TEST(Check, PrintsTheWayOfACycle) {
    EXPECT_EQ(problems_of("a = Combine { b }\nb = Combine { c }\nc = Combine { a }\nsky = Ambient {}\n" + rest),
              "graph.lua:1: Combine 'a': asks itself: a → b → c → a");
    EXPECT_THAT(problems_of("sky = Combine { sky }\n" + rest), HasSubstr("asks itself: sky → sky"));
}

TEST(Check, WantsOneRenderer) {
    EXPECT_EQ(problems_of("sky = Ambient {}"), "graph.lua: no renderer: one node must make the picture, a RayTracer");
    EXPECT_THAT(
        problems_of("sky = Ambient {}\n" + rest + "\nother = RayTracer { sky, scene = scene, film = { 8, 8 } }"),
        HasSubstr("graph.lua:3: RayTracer 'other': a second renderer; 'image' makes the picture already"));
}

TEST(Check, TellsAllProblemsAtOnceInTheOrderOfLines) {
    const std::string all = problems_of(
        "sky = Ambient { rays = 0, lays = 1 }\n"
        "sum = Combin { sky }\n"
        "box = Scene { 'b.pbrt' }\n"
        "image = RayTracer { sun, scene = box, film = { 8 }, samples = {} }");
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n') + 1, 6) << all;
    EXPECT_LT(all.find("graph.lua:1"), all.find("graph.lua:2"));
    EXPECT_LT(all.find("graph.lua:2"), all.find("graph.lua:4"));
}

TEST(Check, SaysWhatTheValueIsThatNobodyGives) {
    EXPECT_THAT(problems_of("sky = Ambient { rays = many }\n" + rest), HasSubstr("'rays': nothing is called 'many'"));
}

TEST(Examine, WarnsOfNodesThatThePictureDoesNotNeed) {
    const Examined found = examine(parse("sky = Ambient {}\nidle = Ambient {}\n" + rest), fake_registry());
    EXPECT_THAT(found.problems, testing::IsEmpty());
    EXPECT_THAT(found.warnings, ElementsAre(Problem{{"graph.lua", 2}, "Ambient 'idle': the picture doesn't need it"}));
}

TEST(Examine, WarnsOfNodesWhoseBytesAreOthersEachTime) {
    auto dice = test::ambient();
    dice.name = "Dice";
    dice.reproducible = false;
    const Registry registry({test::ray_tracer(), dice});
    const Examined found = examine(parse("sky = Dice {}\n" + rest), registry);
    EXPECT_THAT(found.problems, testing::IsEmpty());
    ASSERT_EQ(found.warnings.size(), 1u);
    EXPECT_THAT(found.warnings[0].what, HasSubstr("Dice 'sky': draws random numbers that can't be seeded"));
}

TEST(FilmFormat, IsTheOneOfTheRenderer) {
    EXPECT_EQ(film_of(sound_graph("lighting = Ambient {}"), fake_registry()), (GraphFilm{8, 4, ""}));
}

TEST(FilmFormat, HasACropInPixels) {
    const auto text = [](const std::string& crop) {
        return "sky = Ambient {}\nscene = Scene { 'box.pbrt' }\nimage = RayTracer { sky, scene = scene, film = { 8, 4, "
               "crop = " +
               crop + " } }";
    };
    EXPECT_EQ(film_of(check(parse(text("{ 2, 1, 8, 3 }")), fake_registry()), fake_registry()).crop,
              (Window{2, 1, 6, 2}));
    const auto errors = [&](const std::string& crop) { return problems_of(text(crop)); };
    EXPECT_THAT(errors("{ 2, 1, 9, 3 }"),
                HasSubstr("'crop' of 'film' goes from 2 to 9, but must lie within whole pixels 0 … 8"));
    EXPECT_THAT(errors("{ 2, 3, 4, 3 }"), HasSubstr("goes from 3 to 3"));
    EXPECT_THAT(errors("{ 0, 0, 0.5, 1 }"), HasSubstr("goes from 0 to 0.5"));
    EXPECT_THAT(errors("{ 0, 0, 1 }"), HasSubstr("must be { x0, y0, x1, y1 } in pixels"));
}

TEST(SceneFile, LiesBesideTheGraph) {
    Graph graph = sound_graph("lighting = Ambient {}");
    graph.file = "some/where/graph.lua";
    EXPECT_EQ(scene_file(graph, fake_registry()), "some/where/box.pbrt");
}

TEST(Graph, RanksNodesByTheirDistanceFromTheLeaves) {
    const Graph graph = sound_graph("a = Ambient {} b = Cache { a } lighting = Combine { a, b }");
    EXPECT_THAT(ranks_of(graph), ElementsAre(0, 1, 2, 0, 3));
}

}  // namespace
}  // namespace lightnet::check_test
