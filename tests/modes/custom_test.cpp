// Operators that a graph file has as functions: what they compute, and what they can't.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/modes/daemons.hpp"
#include "tests/support/pixels_in.hpp"

namespace lightnet::custom_test {
namespace {

using test::Launch;
using testing::HasSubstr;
using testing::Not;

class CustomTest : public testing::Test {
protected:
    CustomTest() { std::filesystem::copy_file(test::graph_file("cornell_box.pbrt"), folder / "box.pbrt"); }

    // Renders `nodes` by the node `it`.
    Launch render(const std::string& nodes, const std::vector<std::string>& more = {"--threads", "1"}) {
        std::ofstream(folder / "g.lua") << nodes
                                        << "\nscene = Scene { 'box.pbrt' }\nimage = RayTracer { it, scene = scene, "
                                           "samples = 2, film = { 24, 24, file = 'g.exr' } }\n";
        std::vector<std::string> words{"--progress", "plain"};
        words.insert(words.end(), more.begin(), more.end());
        return test::launch(folder / "g.lua", folder, words);
    }
    std::string why_not(const std::string& function, const std::string& before = "") {
        const Launch launch = render(before + "it = Custom {\n" + function + "\n}");
        EXPECT_NE(launch.code, 0) << function;
        return launch.said;
    }
    test::Folder folder;
};

constexpr const char* occlusion = R"(rays = 8
it = Custom {
    light = function(q, ask)
        local open = 0
        for i = 1, rays do
            open = q:open(hemisphere(q.n, q:random(i, rays)), 300) + open
        end
        return open / rays
    end
})";

TEST_F(CustomTest, GivesTheBitsOfTheSameOperatorInCpp) {
    const Launch lua = render(occlusion), cpp = render("it = AmbientOcclusion { samples = 8, distance = 300 }");
    ASSERT_EQ(lua.code, 0) << lua.said;
    EXPECT_TRUE(test::pixels_in(lua.picture) == test::pixels_in(cpp.picture));
}

TEST_F(CustomTest, TakesConstantsOfItsFileAlong) {
    const Launch one = render(occlusion, {"--threads", "1", "-D", "rays=3"});
    const Launch two = render("it = AmbientOcclusion { samples = 3, distance = 300 }");
    ASSERT_EQ(one.code, 0) << one.said;
    EXPECT_TRUE(test::pixels_in(one.picture) == test::pixels_in(two.picture));
    const Launch table = render(
        "local weights = { near = 0.5, list = { 1, 2 } }\nlocal name = 'a\\nb'\n"
        "it = Custom { light = function(q) return q.n.y * 0 + weights.near * weights.list[2] * #name / 3 end }");
    EXPECT_EQ(table.code, 0) << table.said;
}

TEST_F(CustomTest, AsksItsInputsInEveryMode) {
    const std::string nodes = R"(
direct = DirectLighting {}
it = Custom { direct,
    light = function(q, ask)
        local bounced = ask(1, hemisphere(q.n, q:random()))
        return ask(1) + q.albedo * bounced
    end
})";
    const Launch serial = render(nodes), threads = render(nodes, {"--threads", "3"}),
                 hosts = render(nodes, {"--local-workers", "2"});
    ASSERT_EQ(serial.code, 0) << serial.said;
    EXPECT_TRUE(threads.picture == serial.picture);
    EXPECT_TRUE(hosts.picture == serial.picture) << hosts.said;
    const Launch without = render("it = DirectLighting {}");
    EXPECT_FALSE(test::pixels_in(without.picture) == test::pixels_in(serial.picture));
}

TEST_F(CustomTest, EndsWhatDoesNotEnd) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THAT(why_not("light = function(q)\n while true do end\n end"), HasSubstr("g.lua:3: takes more than"));
    EXPECT_THAT(why_not("light = function(q)\n local t = {}\n for i = 1, 1e10 do t[i] = i end\n end"),
                HasSubstr("g.lua:4: takes more than"));
    EXPECT_THAT(why_not("light = function(q)\n local p = q.p\n while true do p = p + 1 end\n end"),
                HasSubstr("g.lua:4: takes more than"));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, test::slowdown * std::chrono::seconds(20));
}

TEST_F(CustomTest, HasNothingThatReachesOutOrDiffersBetweenHosts) {
    for (const char* name : {"io", "os", "load", "require", "print", "pairs", "next", "tostring", "setmetatable",
                             "pcall", "coroutine", "string", "debug", "collectgarbage", "rawset"})
        EXPECT_THAT(why_not(std::string("light = function(q)\n local f = ") + name + ".x\n end"),
                    HasSubstr("g.lua:3: attempt to index a nil value"))
            << name;
    for (const char* name : {"sin", "exp", "pow", "random", "log"})
        EXPECT_THAT(why_not(std::string("light = function(q)\n return math.") + name + "(1)\n end"),
                    HasSubstr("attempt to call a nil value"))
            << name;
    EXPECT_THAT(why_not("light = function(q)\n return q.n.x ^ 2\n end"), HasSubstr("g.lua:3: '^' is not the same"));
}

TEST_F(CustomTest, SaysWhereItIsWrong) {
    EXPECT_THAT(why_not("light = function(q)\n return q.m\n end"), HasSubstr("g.lua:3: a question has p, n, out"));
    EXPECT_THAT(why_not("light = function(q)\n return 'red'\n end"), HasSubstr("returns a column"));
    EXPECT_THAT(why_not("light = function(q, ask)\n return ask(1)\n end"), HasSubstr("g.lua:3: ask(i) asks input i"));
    EXPECT_THAT(why_not("light = function(q)\n return outside()\n end", "local function outside() return 1 end\n"),
                HasSubstr("takes 'outside' from outside, a function"));
    EXPECT_THAT(why_not("light = 3"), HasSubstr("light"));
    EXPECT_THAT(why_not(""), HasSubstr("light"));
}

TEST_F(CustomTest, KeepsNothingFromOneCallToTheNext) {
    const std::string counting =
        "local seen = { 0 }\nit = Custom {\nlight = function(q)\n seen[1] = seen[1] + 1\n return q.p.x * 0 + seen[1]\n "
        "end }";
    const Launch few = render(counting, {"--threads", "1", "--bundle", "512"}),
                 many = render(counting, {"--threads", "3", "--tile", "5"});
    ASSERT_EQ(few.code, 0) << few.said;
    EXPECT_TRUE(few.picture == many.picture);
}

}  // namespace
}  // namespace lightnet::custom_test
