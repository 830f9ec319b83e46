#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

#include "lua/child.hpp"
#include "lua/load_graph.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::sandbox_test {
namespace {

using test::error_of;
using testing::AnyOf;
using testing::HasSubstr;

// Short enough that the tests are fast.
const LuaOptions brief{.cpu_seconds = 0.1, .wall_seconds = 60, .memory = std::size_t{16} << 20};
// Long enough for a sanitized build on a busy machine.
const LuaOptions patient{.cpu_seconds = 30, .wall_seconds = 60, .memory = std::size_t{16} << 20};

std::string error_in(const std::string& text, const LuaOptions& options = patient) {
    return error_of([&] { parse_graph(text, "graph.lua", options); });
}

TEST(Sandbox, HasNoWayOut) {
    for (const char* name : {"io", "os", "package", "debug", "load", "loadfile", "dofile", "loadstring",
                             "collectgarbage", "coroutine", "_G"})
        EXPECT_EQ(error_in(std::string("assert(type(") + name + ") == 'userdata') local x = " + name),
                  std::string("graph.lua:1: nothing is called '") + name + "'");
    EXPECT_EQ(error_in("assert(string.dump == nil and math.randomseed == nil)"), "");
}

TEST(Sandbox, ReadsNoCompiledCode) {
    EXPECT_EQ(error_in(std::string("\x1bLua", 4) + std::string(20, '\0')),
              "graph.lua: compiled Lua is not read, only text");
}

TEST(Sandbox, HidesWhatItsGlobalsAreMadeOf) {
    EXPECT_EQ(error_in("assert(getmetatable(_ENV) == false)"), "");
    EXPECT_THAT(error_in("setmetatable(_ENV, {})"), HasSubstr("cannot change a protected metatable"));
    EXPECT_EQ(error_in("sky = Ambient {}\nassert(getmetatable(sky) == false)"), "");
}

class Endless : public testing::TestWithParam<const char*> {};

TEST_P(Endless, EndsWithItsProcessorTime) {
    EXPECT_EQ(error_in(GetParam(), brief), "graph.lua: takes more than 0.1 s of processor time");
}

INSTANTIATE_TEST_SUITE_P(Programs, Endless,
                         testing::Values("while true do end", "while true do pcall(error) end",
                                         "while true do pcall(function() while true do end end) end",
                                         "string.find(('a'):rep(1e6), ('a*'):rep(50) .. 'b')",
                                         "setmetatable({}, { __gc = function() while true do end end })\n"
                                         "while true do local t = {} end",
                                         "setmetatable({}, { __gc = function() while true do end end })\n"
                                         "sky = Ambient {}",
                                         "while true do pcall(string.rep, 'x', 1e9) end",
                                         "while true do pcall(function() return Ambient {} end) end",
                                         "while true do pcall(function() return nothing end) end",
                                         "local t = setmetatable({}, { __index = function(t) while true do end end })\n"
                                         "sky = Ambient { rays = t.x }"));

TEST(Sandbox, EndsWithItsTime) {
    const lua::Budget budget{.cpu_seconds = 20, .wall_seconds = 0.1};
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THAT(error_of([&] {
                    lua::in_child(budget, [] {
                        for (;;) ::pause();
                        return std::string();
                    });
                }),
                ::testing::StartsWith("takes more than 0.1 s, in which it did not get"));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(Sandbox, EndsWithItsMemory) {
    for (const char* text :
         {"x = ('x'):rep(1e9)", "local t = {} while true do t[#t + 1] = {} end",
          "local s = 'x' while true do s = s .. s end", "x = table.concat({ ('x'):rep(1e7), ('y'):rep(1e7) })"})
        EXPECT_EQ(error_in(text), "graph.lua: needs more than 16 MiB of memory") << text;
}

TEST(Sandbox, EndsWithItsStack) {
    EXPECT_THAT(error_in("local function f() return 1 + f() end f()"),
                AnyOf(HasSubstr("stack overflow"), HasSubstr("memory")));
    EXPECT_THAT(error_in("local function f() return (string.gsub('x', 'x', f)) end f()"), HasSubstr("overflow"));
    EXPECT_THAT(error_in("x = " + std::string(10000, '(')), HasSubstr("overflow"));
}

TEST(Sandbox, LimitsWhatAGraphHolds) {
    EXPECT_THAT(error_in("local t = {} for i = 1, 3e5 do t[i] = i end sky = Ambient { x = t }", {}),
                HasSubstr("at most 200000 values"));
    EXPECT_THAT(error_in("sky = Ambient { x = ('x'):rep(5e6) }", {}), HasSubstr("at most 4 MiB"));
}

TEST(Child, GivesItsAnswer) {
    EXPECT_EQ(lua::in_child({}, [] { return std::string("answer"); }), "answer");
    EXPECT_EQ(lua::in_child({}, [] { return std::string(1 << 20, 'x'); }).size(), std::size_t{1} << 20);
}

TEST(Child, MayNotAnswerMoreThanItsBudget) {
    EXPECT_EQ(error_of([] { lua::in_child({.output = 1 << 20}, [] { return std::string(2 << 20, 'x'); }); }),
              "gives more than 1 MiB");
}

TEST(Child, HasNoneOfOurFiles) {
    const int file = ::fcntl(STDERR_FILENO, F_DUPFD, 20);
    const std::string answer = lua::in_child({}, [&] { return std::to_string(::fcntl(file, F_GETFD)); });
    ::close(file);
    EXPECT_EQ(answer, "-1");
}

TEST(Child, IsBuriedAlways) {
    EXPECT_THAT(error_of([] { lua::in_child({}, []() -> std::string { ::_exit(7); }); }),
                HasSubstr("ended without an answer"));
    EXPECT_THAT(error_of([] {
                    lua::in_child({}, []() -> std::string {
                        ::raise(SIGKILL);
                        return "";
                    });
                }),
                HasSubstr("ended by a signal: Killed"));
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "no child is left";
}

}  // namespace
}  // namespace lightnet::sandbox_test
