#include "core/network/graph/light_paths.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/graph/describe.hpp"
#include "core/network/graph/dot.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::light_paths_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Kind light(const char* name, std::vector<std::string> paths) {
    Kind kind{.name = name, .help = "some light"};
    kind.paths = [paths](const Node&) { return paths; };
    return kind;
}

Registry kinds() {
    Kind cache = test::cache(), part = test::cache(), clamp = test::cache(), image = test::ray_tracer();
    cache.onward = "D";
    part.name = "Part";
    part.linear = part.partial = true;
    clamp.name = "Clamp";
    clamp.onward = "";
    image.paths = [](const Node&) { return std::vector<std::string>{"LS*E"}; };
    image.onward = "S*E";
    return Registry({image, cache, part, clamp, test::combine(), test::ambient(), light("Direct", {"LD"}),
                     light("Paths", {"L(S|D)+D"}), light("Caustic", {"LS+D"}), light("Openness", {})});
}

const std::string rest =
    "\nscene = Scene { 'box.pbrt' }\nimage = RayTracer { lighting, scene = scene, film = { 8, 4 } }\n";

std::vector<std::string> said(const std::vector<Problem>& problems) {
    std::vector<std::string> texts;
    for (const auto& problem : problems) texts.push_back(problem.what);
    return texts;
}

std::vector<std::string> doubles(const std::string& text) {
    return said(examine(test::parse(text + rest), kinds()).warnings);
}

std::vector<std::string> missing(const std::string& text) {
    return said(examine(test::parse(text + rest), kinds()).notes);
}

TEST(LightPaths, OfDirectAndIndirectLightAreAllThereAndOnce) {
    const std::string text = "d = Direct {} p = Paths {} lighting = Combine { d, p }";
    EXPECT_THAT(doubles(text), IsEmpty());
    EXPECT_THAT(missing(text), IsEmpty());
}

TEST(LightPaths, ThatTwoNodesCountAreNamed) {
    EXPECT_THAT(
        doubles("d = Direct {} caustics = Caustic {} paths = Paths {} lighting = Combine { d, caustics, paths }"),
        ElementsAre("Paths 'paths': LSDE is counted by 'caustics' and 'paths'"));
}

TEST(LightPaths, ThatLeadToThePictureTwiceAreNamed) {
    EXPECT_THAT(doubles("a = Direct {} b = Combine { a, a } lighting = Combine { b }"),
                ElementsAre(HasSubstr("Direct 'a': light is counted more than once")));
}

TEST(LightPaths, ThatNobodyCountsAreNoted) {
    EXPECT_THAT(missing("lighting = Direct {}"), ElementsAre("RayTracer 'image': no node counts LDDE"));
    EXPECT_THAT(missing("lighting = Paths {}"), ElementsAre("RayTracer 'image': no node counts LDE"));
}

// Figure 5 of the paper: a cache of diffuse light over direct light and caustics.
TEST(LightPaths, GoOnWhereLightIsGathered) {
    const std::string text =
        "d = Direct {} c = Caustic {} first = Combine { d, c } bounce = Cache { first } lighting = Combine { first, "
        "bounce }";
    EXPECT_THAT(doubles(text), IsEmpty());
    EXPECT_THAT(missing(text), ElementsAre("RayTracer 'image': no node counts LDDDE"));
    EXPECT_THAT(doubles("d = Direct {} p = Paths {} b = Cache { d } lighting = Combine { d, p, b }"),
                ElementsAre("Direct 'd': LDDE is counted by 'p' and 'b' of 'd'"));
}

TEST(LightPaths, OfSharesThatAreMeantAreNoMistake) {
    EXPECT_THAT(doubles("a = Direct {} b = Direct {} h = Part { a } lighting = Combine { h, b }"), IsEmpty());
    EXPECT_THAT(doubles("a = Direct {} b = Direct {} lighting = Combine { a, b, weights = { 0.5, 1 } }"), IsEmpty());
    EXPECT_THAT(doubles("a = Direct {} b = Direct {} lighting = Combine { a, b, weights = { 1, 1 } }"),
                ElementsAre("Direct 'b': LDE is counted by 'a' and 'b'"));
}

TEST(LightPaths, PassThroughWhatChangesOnlyTheirStrength) {
    EXPECT_THAT(doubles("a = Direct {} c = Clamp { a } lighting = Combine { a, c }"),
                ElementsAre(HasSubstr("more than once")));
}

TEST(LightPaths, AreNotMissedWhereAKindStatesNone) {
    EXPECT_THAT(missing("a = Ambient {} d = Direct {} lighting = Combine { a, d }"), IsEmpty());
    EXPECT_THAT(missing("lighting = Openness {}"), IsEmpty()) << "a picture of something else than light";
}

TEST(LightPaths, DoNotGrowWithTheWaysThatLeadToThem) {
    std::string text = "a0 = Direct {} ";
    for (int i = 0; i < 60; ++i)
        text += "a" + std::to_string(i + 1) + " = Combine { a" + std::to_string(i) + ", a" + std::to_string(i) + " } ";
    EXPECT_THAT(doubles(text + "lighting = Combine { a60 }"), ElementsAre(HasSubstr("more than once")));
}

TEST(LightPaths, AreDescribedAndDrawn) {
    const Registry registry = kinds();
    EXPECT_THAT(describe(*registry.find("Paths")), HasSubstr("light paths: L(S|D)+D\n"));
    EXPECT_THAT(describe(*registry.find("Cache")), HasSubstr("light paths: … D\n"));
    const Graph graph = check(test::parse("lighting = Direct {}" + rest), registry);
    EXPECT_THAT(to_dot(graph, registry), HasSubstr("label=\"lighting\\nDirect\\nLD\""));
}

}  // namespace
}  // namespace lightnet::light_paths_test
