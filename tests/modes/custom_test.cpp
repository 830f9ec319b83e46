// Operators that a graph file has as functions: what they compute, and what they can't.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>

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
    EXPECT_THAT(why_not("light = function(q)\n local p = q.p\n while true do p = p + 1 end\n end"),
                HasSubstr("g.lua:4: takes more than"));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, test::slowdown * std::chrono::seconds(20));
}

// One instruction may make, copy or compare much.
TEST_F(CustomTest, EndsWhatTakesBytes) {
    const std::string text = "light = function(q)\n local s = 'xxxxxxxxxxxxxxxx'\n for i = 1, ";
    EXPECT_THAT(why_not(text + "20 do s = s .. s end\n end"), HasSubstr("g.lua:4: makes a text of more than 4 KiB"));
    EXPECT_THAT(why_not(text + "7 do s = s .. s end\n for i = 1, 1e9 do local t = s .. 'y' end\n end"),
                HasSubstr("takes more than"));
    EXPECT_THAT(why_not("light = function(q)\n local t = {}\n for i = 1, 1e5 do t[i] = i end\n end"),
                HasSubstr("makes a table, or arguments of a call, of more than 256 KiB"));
    EXPECT_THAT(why_not("light = function(q, ask)\n while true do local c = ask(1, q.n) end\n end, direct",
                        "direct = DirectLighting {}\n"),
                HasSubstr("takes more than"));
}

TEST_F(CustomTest, EndsWithTheRunThatIsToldToStop) {
    std::ofstream(folder / "g.lua")
        << "it = Custom { light = function(q)\n local n = 0\n while true do n = q:open(q.n) "
           "end\n end }\nscene = Scene { 'box.pbrt' }\nimage = RayTracer { it, scene = "
           "scene, samples = 1024, film = { 256, 256, file = 'g.exr' } }\n";
    for (const char* threads : {"1", "2"}) {
        test::Process run(test::launch_words(folder / "g.lua", folder / "g.exr",
                                             {"--threads", threads, "--progress", "json", "--forget"}));
        EXPECT_TRUE(run.wait_for("\"event\":\"phase\"")) << run.output();
        run.signal(SIGTERM);
        EXPECT_GE(run.wait(test::slowdown * std::chrono::seconds(20)), 0) << "it goes on with " << threads;
    }
}

// Others want it.
TEST_F(CustomTest, LeavesADaemonWhoseLauncherIsGone) {
    const test::Daemon daemon(folder);
    const std::string hosts = folder.write("hosts.lua", "place '" + daemon.endpoint + "' {}\n");
    std::ofstream(folder / "long.lua") << "it = Custom { light = function(q)\n local n = 0\n for i = 1, 100 do n = n + "
                                          "q:open(q.n) end\n return n\n end }\nscene = Scene { 'box.pbrt' }\nimage = "
                                          "RayTracer { it, scene = scene, samples = 4096, film = { 256, 256, file = "
                                          "'long.exr' } }\n";
    {
        test::Process lost(test::launch_words(folder / "long.lua", folder / "long.exr",
                                              {"--hosts", hosts, "--progress", "json", "--forget", "--tile", "256"}));
        EXPECT_TRUE(daemon.process->wait_for("serves a run")) << daemon.process->output();
        EXPECT_TRUE(lost.wait_for("\"event\":\"phase\"")) << lost.output();
        lost.signal(SIGKILL);
        lost.wait();
    }
    const Launch next = render("it = DirectLighting {}", {"--hosts", hosts, "--wait", "30"});
    EXPECT_EQ(next.code, 0) << next.said << daemon.process->output();
}

// Nobody can trace them: they meet nothing, the run goes on and says whose they were, and no host dies of them.
TEST_F(CustomTest, MayAskAlongDirectionsThatAreNone) {
    const test::Daemon one(folder), two(folder);
    const std::string hosts =
        folder.write("hosts.lua", "place '" + one.endpoint + "' {}\nplace '" + two.endpoint + "' {}\n");
    for (const char* rays : {"ask(1, q.p * (0/0))", "q:open(q.p * (0/0))", "q:open(q.p * 1e30 * 1e30)",
                             "ask(1, q.n * 1e19)", "ask(1, q.n * 0)"}) {
        const std::string nodes = std::string(
                                      "direct = DirectLighting {}\nit = Custom { direct, light = function(q, "
                                      "ask)\n return ask(1) * 0 + ") +
                                  rays + "\n end }";
        const Launch here = render(nodes), there = render(nodes, {"--hosts", hosts});
        EXPECT_EQ(here.code, 0) << here.said;
        EXPECT_THAT(here.said, HasSubstr("'it' sent")) << rays;
        EXPECT_EQ(there.code, 0) << there.said;
        EXPECT_TRUE(here.picture == there.picture) << rays;
    }
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
