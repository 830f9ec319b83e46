#include "core/network/graph/path_layers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/graph/check.hpp"
#include "core/network/graph/path_expression.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::path_layers_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// ---- expressions ----

bool has(const std::string& expression, const std::string& word, Collisions collisions = Collisions::rough) {
    return PathExpression(expression).of("", collisions).contains(word);
}

TEST(PathExpression, GoesFromTheEyeToTheLight) {
    EXPECT_TRUE(has("CDS+L", "LSDE")) << "a caustic";
    EXPECT_TRUE(has("CDS+L", "LSSDE"));
    EXPECT_FALSE(has("CDS+L", "LDSE")) << "a mirror's picture of something lit";
    EXPECT_TRUE(has("CSDL", "LDSE"));
    EXPECT_TRUE(has("C <.D> <L.>", "LDE"));
    EXPECT_TRUE(has("C[DS]*O", "OSDE"));
    EXPECT_FALSE(has("C[DS]*O", "BSDE"));
    EXPECT_TRUE(has("C.{1,2}B", "BDDE"));
    EXPECT_FALSE(has("C.{1,2}B", "BDDDE"));
    EXPECT_TRUE(has("(CD|CS)L", "LSE"));
    EXPECT_TRUE(has("CDD?L", "LDDE"));
}

TEST(PathExpression, KnowsLampsByTheirGroup) {
    const PathExpression key("CD<L.'key'>|CDDO'fill'");
    EXPECT_THAT(key.groups(), ElementsAre("key", "fill"));
    EXPECT_TRUE(key.of("key", Collisions::rough).contains("LDE"));
    EXPECT_FALSE(key.of("key", Collisions::rough).contains("LDDE"));
    EXPECT_TRUE(key.of("fill", Collisions::rough).contains("ODDE"));
    EXPECT_FALSE(key.of("fill", Collisions::rough).contains("ODE"));
    EXPECT_FALSE(key.of("rest", Collisions::rough).contains("LDE"));
}

TEST(PathExpression, TakesACollisionForRoughUnlessOneIsNamed) {
    EXPECT_TRUE(has("CDL", "LVE"));
    EXPECT_TRUE(has("CDL", "LDE"));
    EXPECT_FALSE(has("CSL", "LVE"));
    EXPECT_FALSE(has("CDL", "LVE", Collisions::apart));
    EXPECT_TRUE(has("CDL", "LDE", Collisions::apart));
    EXPECT_TRUE(has("C.L", "LVE", Collisions::apart));
    EXPECT_FALSE(PathExpression("CD.L").names_collisions());
}

TEST(PathExpression, KnowsCollisionsInMedia) {
    for (const char* text : {"CVL", "C<V.>L", "C[VD]L", "C V{1,2} L"}) {
        EXPECT_TRUE(PathExpression(text).names_collisions()) << text;
        EXPECT_TRUE(has(text, "LVE", Collisions::apart)) << text;
    }
    EXPECT_FALSE(has("CVL", "LDE", Collisions::apart));
    EXPECT_TRUE(has("CVDL", "LDVE", Collisions::apart)) << "light that a wall sends into the fog";
    EXPECT_FALSE(has("CVDL", "LVDE", Collisions::apart));
}

std::string mistake_in(const std::string& expression) {
    return test::error_of([&] { PathExpression read(expression); });
}

TEST(PathExpression, SaysWhatCantBeTold) {
    EXPECT_THAT(mistake_in("C<RD>L"), HasSubstr("place 3: operators do not tell reflection from transmission"));
    EXPECT_THAT(mistake_in("CGL"), HasSubstr("place 2: operators do not tell glossy from diffuse"));
    EXPECT_THAT(mistake_in("C<.G>L"), HasSubstr("glossy"));
    EXPECT_THAT(mistake_in("C<V>L"), HasSubstr("place 4: a collision in a medium is written V or <V.>"));
    EXPECT_THAT(mistake_in("C[^D]L"), HasSubstr("name what is"));
    for (const char* text :
         {"C(DL", "CD)L", "C<.D", "C<L.'key>", "CD{2L", "CD{3,1}L", "CD{x}L", "CxL", "C*{", "<", "["})
        EXPECT_THAT(mistake_in(text), HasSubstr("is no light path expression")) << text;
    EXPECT_THAT(mistake_in(std::string(2000, 'D')), HasSubstr("too long"));
    EXPECT_THAT(mistake_in(std::string(100, '(')), HasSubstr("nested"));
}

// ---- layers ----

const Registry& nodes() {
    static const Registry registry(standard_nodes());
    return registry;
}

// Direct and indirect light, and a renderer with these layers. `of_operators`: what all of them are told.
Examined examined(const std::string& layers, const std::string& of_operators = "") {
    return examine(test::parse("scene = Scene { 'box.pbrt', groups = { key = 'spot' } }\n"
                               "direct = DirectLighting { " +
                               of_operators +
                               " }\n"
                               "bounce = PathTracing { " +
                               of_operators +
                               " }\n"
                               "light = Combine { direct, bounce }\n"
                               "image = RayTracer { light, scene = scene, film = { 8, 4 }, layers = { " +
                               layers + " }, " + of_operators + " }"),
                   nodes());
}

Layers layers_with(const std::string& layers, const std::string& of_operators = "") {
    const auto sound = examined(layers, of_operators);
    for (const auto& problem : sound.problems) ADD_FAILURE() << problem.what;
    return layers_of(sound.graph, nodes());
}

std::string wrong_with(const std::string& layers, const std::string& of_operators = "") {
    std::string all;
    for (const auto& problem : examined(layers, of_operators).problems) all += problem.what + "\n";
    return all;
}

TEST(PathLayers, AreNamedByExpressionsInsteadOfByOperators) {
    EXPECT_THAT(layers_with("").film, ElementsAre("emission", "direct", "bounce"));
    EXPECT_THAT(layers_with("lit = 'CS*DL', indirect = 'CS*D.+L'").film, ElementsAre("emission", "lit", "indirect"));
    EXPECT_THAT(layers_with("lit = 'CS*DL'").film, ElementsAre("emission", "lit", "bounce"))
        << "the rest keeps its own";
}

TEST(PathLayers, PutTogetherWhatAnExpressionTakesOfSeveralOperators) {
    const auto graph = examined("surfaces = 'CS*D.*L'").graph;
    const auto layers = layers_of(graph, nodes());
    EXPECT_THAT(layers.film, ElementsAre("emission", "surfaces"));
    EXPECT_THAT(layers.of_colour, ElementsAre(0, 1, 1));
    EXPECT_THAT(layers_made_of(*graph.find("light"), layers, graph, nodes()), ElementsAre(1));
    EXPECT_THAT(layers_made_of(*graph.find("direct"), layers, graph, nodes()), IsEmpty()) << "it holds others' as well";
    EXPECT_THAT(layers_with("all = 'C.*L'").film, ElementsAre("all"));
    EXPECT_THAT(layers_with("one = { 'CS*DL', 'CS*D.+L' }").film, ElementsAre("emission", "one"));
}

TEST(PathLayers, KeepGroupsApartUntilAnExpressionNamesOne) {
    EXPECT_THAT(layers_with("lit = 'CS*DL'", "groups = true").film,
                ElementsAre("emission.key", "emission.rest", "lit.key", "lit.rest", "bounce.key", "bounce.rest"));
    const auto layers = layers_with("spot = \"C.*L'key'\"", "groups = true");
    EXPECT_THAT(layers.film, ElementsAre("spot", "emission.rest", "direct.rest", "bounce.rest"));
    EXPECT_THAT(layers.of_colour, ElementsAre(0, 1, 0, 2, 0, 3));
}

TEST(PathLayers, SayWhatTheGraphDoesNotKeepApart) {
    EXPECT_THAT(
        wrong_with("caustics = 'CS*DS+L'"),
        HasSubstr("RayTracer 'image': 'layers': 'caustics': takes LSDE of 'bounce', but not LDDE: no operator"));
    EXPECT_THAT(wrong_with("lit = 'CDL'"), HasSubstr("takes LDE of 'direct', but not LDSE"));
    EXPECT_THAT(wrong_with("lit = 'CDL'"), HasSubstr("Write S* behind C"));
    EXPECT_THAT(wrong_with("lit = \"CS*DL'key'\""),
                HasSubstr("takes LDE of 'direct', but not LDE: it does not keep groups of lamps apart"));
    EXPECT_THAT(wrong_with("a = 'CS*DL', b = 'CS*D.*L'"), HasSubstr("'b': LDE of 'direct' is in 'a' already"));
    EXPECT_THAT(wrong_with("none = 'CD'"), HasSubstr("'none': no operator of the graph counts such light"));
    EXPECT_THAT(wrong_with("lit = 'CS*D*'"), HasSubstr("no operator"));
    EXPECT_THAT(wrong_with("a = { \"C.*L'key'\", \"C.*L'rest'\" }", "groups = true"),
                HasSubstr("takes the emission of several groups"));
}

TEST(PathLayers, TellLampsFromTheBackgroundWhereAnOperatorDoesNot) {
    const auto wrong = wrong_with("lamps = 'CS*DO'");
    EXPECT_THAT(wrong,
                HasSubstr("takes LDE of 'direct', but not LDE: it does not keep lamps apart from the background"));
}

// What a fog scatters, and what surfaces do.
const char* const in_fog = "where = 'media'";

Examined examined_in_fog(const std::string& layers, const std::string& where_fog = in_fog) {
    return examine(test::parse("scene = Scene { 'box.pbrt', fog = { density = 0.1 } }\n"
                               "direct = DirectLighting {} lit = Select { direct, where = 'surfaces' }\n"
                               "around = DirectLighting {} lit_fog = Select { around, " +
                               where_fog +
                               " }\n"
                               "bounce = PathTracing {}\n"
                               "light = Combine { lit, lit_fog, bounce }\n"
                               "image = RayTracer { light, scene = scene, film = { 8, 4 }, layers = { " +
                               layers + " } }"),
                   nodes());
}

std::string wrong_in_fog(const std::string& layers) {
    std::string all;
    for (const auto& problem : examined_in_fog(layers).problems) all += problem.what + "\n";
    return all;
}

TEST(PathLayers, KeepWhatMediaScatterApart) {
    const auto found = examined_in_fog("once = 'CS*VL', first = 'CS*DL'");
    for (const auto& problem : found.problems) ADD_FAILURE() << problem.what;
    EXPECT_THAT(found.warnings, IsEmpty()) << "no light is counted twice";
    EXPECT_THAT(found.notes, IsEmpty()) << "or left out";
    const auto layers = layers_of(found.graph, nodes());
    EXPECT_THAT(layers.film, ElementsAre("emission", "first", "once", "bounce"));
    EXPECT_THAT(layers.of_colour, ElementsAre(0, 1, 2, 3));
    const auto except = examined_in_fog("once = 'CS*VL'", "where = 'surfaces', except = true");
    EXPECT_THAT(except.warnings, IsEmpty());
    EXPECT_THAT(layers_of(except.graph, nodes()).film, ElementsAre("emission", "direct", "once", "bounce"));
}

TEST(PathLayers, MeanFogAsWellBySayingRoughWhereNoneNamesIt) {
    const auto found = examined_in_fog("once = 'CS*DL'");
    for (const auto& problem : found.problems) ADD_FAILURE() << problem.what;
    EXPECT_THAT(layers_of(found.graph, nodes()).film, ElementsAre("emission", "once", "bounce"));
}

// Gathering asks about the next corner, so the one before it may be told apart, too.
TEST(PathLayers, KnowWhatFogSendsToWalls) {
    const auto found = examine(test::parse("scene = Scene { 'box.pbrt', fog = { density = 0.1 } }\n"
                                           "direct = DirectLighting {} in_fog = Select { direct, where = 'media' }\n"
                                           "gather = FinalGather { in_fog }\n"
                                           "on_walls = Select { gather, where = 'surfaces' }\n"
                                           "image = RayTracer { on_walls, scene = scene, film = { 8, 4 }, "
                                           "layers = { glow = 'CS*DS*VL' } }"),
                               nodes());
    for (const auto& problem : found.problems) ADD_FAILURE() << problem.what;
    EXPECT_THAT(layers_of(found.graph, nodes()).film, ElementsAre("emission", "glow"));
}

TEST(PathLayers, SayWhoseSurfacesAndMediaAreNotApart) {
    EXPECT_THAT(wrong_in_fog("a = 'CS*V.+L'"), HasSubstr("of 'bounce', but not L"));
    EXPECT_THAT(wrong_in_fog("a = 'CS*V.+L'"), HasSubstr("Select { …, where = \"media\" } keeps them apart"));
    EXPECT_THAT(wrong_in_fog("a = 'CS*VL', b = 'CS*[DV]L'"), HasSubstr("'b': LVE of 'around' is in 'a' already"));
    const auto twice = examined_in_fog("a = 'CS*[DV]L'", "where = 'surfaces'");
    ASSERT_EQ(twice.warnings.size(), 1u);
    EXPECT_THAT(twice.warnings[0].what, HasSubstr("LDE is counted by 'direct' and 'around'"));
    ASSERT_EQ(twice.notes.size(), 1u);
    EXPECT_THAT(twice.notes[0].what, HasSubstr("no node counts LVE"));
}

// To know whether the 31st surface before the eye scattered, an automaton must remember all 31: 2^31 states.
TEST(PathLayers, AreRefusedWhereTellingThemApartTakesTooLong) {
    EXPECT_THAT(wrong_with("many = 'C.{15}.{15}D.*L'"), HasSubstr("take too long to tell apart"));
    EXPECT_THAT(mistake_in("C(.{9}){9}L"), HasSubstr("too long with its repetitions"));
    EXPECT_THAT(mistake_in("C.{999}L"), HasSubstr("too long with its repetitions"));
    EXPECT_THAT(mistake_in("C((((D+)+)+)+)+)+)+)+L"), HasSubstr("no light path expression"));
}

TEST(PathLayers, SayWhatIsWrongWithNamesAndExpressions) {
    EXPECT_THAT(wrong_with("lit = \"CS*DL'kez'\""), HasSubstr("the scene has no group 'kez' (did you mean 'key'?)"));
    EXPECT_THAT(wrong_with("direct = 'CS*DL'"), HasSubstr("'direct': is the name of a node"));
    EXPECT_THAT(wrong_with("key = 'CS*DL'"), HasSubstr("'key': is the name of a group"));
    EXPECT_THAT(wrong_with("['a b'] = 'CS*DL'"), HasSubstr("letters, digits and _"));
    const auto both = wrong_with("a = 'C<RD>L', b = 'CGL'");
    EXPECT_THAT(both, HasSubstr("reflection"));
    EXPECT_THAT(both, HasSubstr("glossy"));
    EXPECT_THAT(wrong_with("lit = 5"), HasSubstr("names"));
}

}  // namespace
}  // namespace lightnet::path_layers_test
