#include "core/network/graph/path_set.hpp"

#include <gtest/gtest.h>

#include "tests/support/parse.hpp"

namespace lightnet::path_set_test {
namespace {

PathSet set(const char* text) { return PathSet::parse(text); }

TEST(PathSet, ReadsHeckbertsNotation) {
    const PathSet all = set("L(S|D)*E");
    for (const char* path : {"LE", "LDE", "LSSDE", "LDDDDDDDDSE"}) EXPECT_TRUE(all.contains(path)) << path;
    for (const char* path : {"L", "DE", "LDES", ""}) EXPECT_FALSE(all.contains(path)) << path;
}

TEST(PathSet, CountsRepetitions) {
    const PathSet some = set("LD{2,3}S?D+");
    for (const char* path : {"LDDD", "LDDSD", "LDDDSDDD", "LDDDDDD"}) EXPECT_TRUE(some.contains(path)) << path;
    for (const char* path : {"LDD", "LDSD", "LDDSSD", "LDDDS"}) EXPECT_FALSE(some.contains(path)) << path;
    EXPECT_TRUE(set("LD{2}").contains("LDD"));
    EXPECT_FALSE(set("LD{2}").contains("LDDD"));
}

TEST(PathSet, TakesManyRepetitionsForAny) { EXPECT_TRUE(set("LD{0,1000}").contains("L" + std::string(40, 'D'))); }

TEST(PathSet, KnowsLampsFromTheEnvironment) {
    EXPECT_TRUE(PathSet::common(set("LD"), set("BD")));
    EXPECT_TRUE(PathSet::common(set("LD"), set("OD")));
    EXPECT_FALSE(PathSet::common(set("OD"), set("BD")));
    EXPECT_FALSE(PathSet::missing(set("LD"), set("OD").with(set("BD"))));
}

TEST(PathSet, TellsMediaFromSurfaces) {
    EXPECT_TRUE(set("L(D|V)E").contains("LVE"));
    EXPECT_FALSE(set("L(S|D)*E").contains("LVE"));
    EXPECT_EQ(PathSet::missing(set("L(D|V)E"), set("LDE")), "LVE");
    EXPECT_FALSE(PathSet::missing(set("L(S|D|V)E"), set("L.E")));
    EXPECT_FALSE(PathSet::missing(set("L.E"), set("L(S|D|V)E")));
}

TEST(PathSet, IsRestrictedToWordsThatEndInSomeLetters) {
    const PathSet some = set("L(S|D|V)+(D|V)|B");
    for (const char* path : {"LSV", "LDV", "LVVV"}) EXPECT_TRUE(some.ending_in("V").contains(path)) << path;
    for (const char* path : {"LSD", "LVD", "B", "LV", ""}) EXPECT_FALSE(some.ending_in("V").contains(path)) << path;
    EXPECT_TRUE(some.ending_in("OBSD").contains("LVD"));
    EXPECT_TRUE(some.ending_in("OBSD").contains("B"));
    EXPECT_FALSE(some.ending_in("OBSD").contains("LDV"));
    EXPECT_TRUE(set("LD(S*)").ending_in("D").contains("LD")) << "nothing has to follow";
    EXPECT_FALSE(set("LDS*").ending_in("D").contains("LDS"));
    EXPECT_TRUE(PathSet().ending_in("D").empty());
    EXPECT_TRUE(set("LD").ending_in("V").empty());
}

TEST(PathSet, FindsAShortestWordThatTwoHave) {
    EXPECT_EQ(PathSet::common(set("L(S|D)*DE"), set("LS+DE")), "LSDE");
    EXPECT_EQ(PathSet::common(set("LDE"), set("LDD+E")), std::nullopt);
}

TEST(PathSet, FindsAShortestWordThatOneLacks) {
    EXPECT_EQ(PathSet::missing(set("L(S|D)*E"), set("LS*E|LDS*E")), "LDDE");
    EXPECT_EQ(PathSet::missing(set("L(S|D)*E"), set("L(D|S)*E")), std::nullopt);
    EXPECT_EQ(PathSet::missing(set("LD"), PathSet()), "LD");
}

TEST(PathSet, ContinuesPaths) {
    EXPECT_TRUE(set("LD|LSD").then(set("D")).contains("LSDD"));
    EXPECT_TRUE(PathSet().then(set("D")).empty());
    EXPECT_FALSE(set("").empty()) << "the word without letters is a word";
}

TEST(PathSet, RefusesWhatIsNoExpression) {
    for (const char* text : {"(", "LX", "L)", "*", "L{2", "L{3,2}", "L{a}", "l"})
        EXPECT_NE(test::error_of([&] { set(text); }), "") << text;
}

}  // namespace
}  // namespace lightnet::path_set_test
