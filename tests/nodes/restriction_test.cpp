// Nodes that change the light of others, or are a part of direct light.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/graph/check_params.hpp"
#include "core/network/graph/graph.hpp"
#include "tests/support/parse.hpp"
#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::restriction_test {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A floor called "floor", a shining ball over it, and a sky.
SceneData floor_and_ball() {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0.5f));
    data.materials.back().name = "floor";
    data.shapes.back().name = "ground";
    add(data, ball({0, 2, 0}, 0.5f), diffuse(data, 0.5f)).emission = AreaEmission{{3, 3, 3}, false};
    data.materials.back().name = "ball";
    data.shapes.back().name = "bulb.01";
    data.environments.push_back({{2, 2, 2}});
    return data;
}

Query on_floor(float u, float v) { return {.geometry = 0, .primitive = 0, .u = u, .v = v, .outgoing = {0, 1, 0}}; }
Query on_ball() { return {.geometry = 1, .outgoing = {0, 0, 1}}; }

class Restrictions : public testing::Test {
protected:
    std::vector<Rgb> ask(const LightOp& op, const std::vector<Query>& questions) {
        std::vector<Rgb> answers(questions.size());
        op.light(questions, answers);
        return answers;
    }
    const LightOp& over_openness(const std::string& kind, const Rig::Params& params) {
        rig_.add("AmbientOcclusion", "openness");
        return rig_.add(kind, "it", {"openness"}, params);
    }
    std::vector<Rgb> openness(const std::vector<Query>& questions) {
        return ask(rig_.add("AmbientOcclusion", "openness"), questions);
    }

    Scene scene_{floor_and_ball()};
    Rig rig_{scene_};
    const std::vector<Query> places_{on_floor(0.1f, 0.1f), on_ball(), on_floor(0.4f, 0.3f)};
};

Value table(std::initializer_list<double> numbers) {
    Table list;
    for (const double number : numbers) list.list.push_back(Value{number});
    return Value{list};
}

// All that check() says of a node, and of it with its scene.
std::vector<std::string> mistakes_of(const std::string& name, std::map<std::string, Value> params,
                                     const SceneData& scene) {
    const Registry registry(standard_nodes());
    const Kind& kind = *registry.find(name);
    Graph graph;
    Node& node = graph.nodes.emplace_back(Node{"node", name, {}, std::move(params), {}});
    std::vector<std::string> said;
    check_params(node, kind, graph, [&](const std::string& what) { said.push_back(what); });
    if (said.empty() && kind.mistakes) said = kind.mistakes(node, &scene);
    return said;
}

TEST_F(Restrictions, ScaleMultipliesByANumberAndAColour) {
    const auto plain = openness(places_);
    const auto scaled = ask(over_openness("Scale", {{"factor", Value{2.0}}, {"colour", table({1, 0.5, 0})}}), places_);
    for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(scaled[i], (plain[i] * Rgb{2, 1, 0}));
}

TEST_F(Restrictions, SelectAsksOnSurfacesOfOneMaterial) {
    const auto plain = openness(places_);
    const auto floor = ask(over_openness("Select", {{"material", Value{"floor"}}}), places_);
    EXPECT_EQ(floor, (std::vector<Rgb>{plain[0], {}, plain[2]}));
    const auto rest =
        ask(rig_.add("Select", "rest", {"openness"}, {{"material", Value{"floor"}}, {"except", Value{true}}}), places_);
    EXPECT_EQ(rest, (std::vector<Rgb>{{}, plain[1], {}}));
}

TEST_F(Restrictions, SelectAsksOnShapesAndObjectsOfOneName) {
    const auto plain = openness(places_);
    EXPECT_EQ(ask(over_openness("Select", {{"object", Value{"bulb.*"}}}), places_),
              (std::vector<Rgb>{{}, plain[1], {}}));
    const auto both = ask(
        rig_.add("Select", "both", {"openness"}, {{"object", Value{"ground"}}, {"material", Value{"ball"}}}), places_);
    EXPECT_EQ(both, std::vector<Rgb>(3)) << "what it names must all be so";
}

// Two instances of one object, and one of another, of the same shape.
TEST(Select, KnowsInstancesByTheirObjects) {
    SceneData data;
    add(data, ball({0, 0, 0}, 0.5f), diffuse(data, 0.5f));
    data.objects = {{"lamp", {0}}, {"vase", {0}}};
    Matrix far;
    far.m[0][3] = 3;
    data.instances = {{0, {}}, {1, far, "antique"}, {0, far * far}};
    const Scene scene(std::move(data));
    Rig rig(scene);
    rig.add("AmbientOcclusion", "openness");
    const auto& vases = rig.add("Select", "it", {"openness"}, {{"object", Value{"vase"}}});
    std::vector<Query> questions(3, Query{.geometry = 0, .outgoing = {0, 0, 1}});
    for (std::uint32_t i = 0; i < 3; ++i) questions[i].instance = i;
    std::vector<Rgb> answers(3);
    vases.light(questions, answers);
    EXPECT_EQ(answers, (std::vector<Rgb>{{}, {1, 1, 1}, {}}));
    const auto& antiques = rig.add("Select", "other", {"openness"}, {{"object", Value{"antique"}}});
    answers.assign(3, {});
    antiques.light(questions, answers);
    EXPECT_EQ(answers, (std::vector<Rgb>{{}, {1, 1, 1}, {}})) << "by the name of what stands there";
}

TEST_F(Restrictions, SelectAsksInsideABox) {
    const auto plain = openness(places_);
    EXPECT_EQ(ask(over_openness("Select", {{"box", table({-1, 1, -1, 1, 3, 1})}}), places_),
              (std::vector<Rgb>{{}, plain[1], {}}));
}

TEST_F(Restrictions, SelectSaysWhatIsWrongWithItsChoice) {
    const SceneData scene = floor_and_ball();
    EXPECT_THAT(mistakes_of("Select", {}, scene), ElementsAre(HasSubstr("selects nothing")));
    EXPECT_THAT(mistakes_of("Select", {{"material", Value{"flor"}}}, scene),
                ElementsAre("no shape has a material called 'flor' (did you mean 'floor'?)"));
    EXPECT_THAT(mistakes_of("Select", {{"object", Value{"table"}}}, scene),
                ElementsAre("there is no object or shape called 'table' (there is: bulb.01, ground)"));
    EXPECT_THAT(mistakes_of("Select", {{"object", Value{"gr*"}}}, scene), IsEmpty());
    EXPECT_THAT(mistakes_of("Select", {{"box", table({1, 2})}}, scene), ElementsAre(HasSubstr("must have 6")));
    EXPECT_THAT(mistakes_of("Select", {{"box", table({0, 0, 1, 1, 1, 0})}}, scene),
                ElementsAre("'box' ends before it begins along z"));
    EXPECT_THAT(mistakes_of("Select", {{"material", Value{"floor"}}}, scene), IsEmpty());
    EXPECT_THAT(mistakes_of("Scale", {{"colour", table({1, 2})}}, scene), ElementsAre(HasSubstr("must have 3")));
    EXPECT_THAT(mistakes_of("Scale", {{"colour", table({})}}, scene), IsEmpty());
}

TEST_F(Restrictions, ClampDarkensWhatIsTooBrightAndKeepsItsHue) {
    const auto plain = ask(rig_.add("Emission", "shine"), {on_ball()});
    ASSERT_EQ(plain[0], (Rgb{3, 3, 3}));
    rig_.add("Scale", "red", {"shine"}, {{"colour", table({2, 1, 0})}});
    EXPECT_EQ(ask(rig_.add("Clamp", "less", {"red"}, {{"most", Value{1.5}}}), {on_ball()})[0], (Rgb{1.5f, 0.75f, 0}));
    EXPECT_EQ(ask(rig_.add("Clamp", "enough", {"red"}, {{"most", Value{7.0}}}), {on_ball()})[0], (Rgb{6, 3, 0}));
}

class Broken final : public LightOp {
public:
    void light(std::span<const Query>, std::span<Rgb> answers) const override {
        std::fill(answers.begin(), answers.end(), Rgb{std::numeric_limits<float>::quiet_NaN(), 1, 1});
    }
};

TEST_F(Restrictions, ClampTakesWhatIsNoNumberForBlack) {
    const Broken broken;
    test::CallPort port(broken);
    const auto kinds = standard_nodes();
    const auto kind = std::find_if(kinds.begin(), kinds.end(), [](const Kind& k) { return k.name == "Clamp"; });
    const Node node{"it", "Clamp", {}, {{"most", Value{1.0}}}, {}};
    const auto clamp = kind->make_light(NodeContext(node, Inputs({{"broken", &port, {0}}}, 1), scene_, 1));
    EXPECT_EQ(ask(*clamp, {on_floor(0, 0)})[0], Rgb{});
}

TEST_F(Restrictions, EmissionIsThatOfTheSurface) {
    const auto& op = rig_.add("Emission", "shine");
    EXPECT_EQ(ask(op, {on_floor(0, 0), on_ball()}), (std::vector<Rgb>{{}, {3, 3, 3}}));
}

// Far from the ball the floor sees nothing but the sky: albedo × radiance.
TEST_F(Restrictions, EnvironmentBringsTheSkyAndNoLamp) {
    std::vector<Query> questions(1024, on_floor(0.02f, 0.02f));
    for (std::uint32_t i = 0; i < questions.size(); ++i) questions[i].sample = i;
    const auto sky = ask(rig_.add("Environment", "sky"), questions);
    const auto all = ask(rig_.add("DirectLighting", "all"), questions);
    double from_sky = 0, from_all = 0;
    for (std::size_t i = 0; i < questions.size(); ++i) from_sky += sky[i].g, from_all += all[i].g;
    const double n = double(questions.size());
    EXPECT_LE(from_sky / n, 1 + 1e-6);
    EXPECT_NEAR(from_sky / n, 1, 0.01) << "the ball hides little";
    EXPECT_GT(from_all, from_sky) << "direct light has the lamp as well";
}

}  // namespace
}  // namespace lightnet::restriction_test
