// What a file may cost beside Lua's own memory: the C++ side of it, its complaints, and its words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include <fstream>
#include <iterator>

#include "lua/child.hpp"
#include "lua/load_graph.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/parse.hpp"

namespace lightnet::bounds_test {
namespace {

using test::error_of;
using testing::HasSubstr;
using testing::SizeIs;

// Long enough for a sanitized build on a busy machine.
const LuaOptions patient{.cpu_seconds = 30, .wall_seconds = 60};

std::string error_in(const std::string& text) {
    return error_of([&] { parse_graph(text, "graph.lua", patient); });
}
std::string error_in_hosts(const std::string& text) {
    return error_of([&] { parse_hosts(text, "hosts.lua", patient); });
}

std::vector<Problem> problems_in(const std::string& text) {
    try {
        parse_graph(text, "graph.lua", patient);
    } catch (const UserError& error) {
        return error.problems();
    }
    return {};
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their allocators have set all room apart before
TEST(Child, MayNotTakeMoreMemoryThanItsBudget) {
    const lua::Budget budget{.memory = std::size_t{64} << 20};
    EXPECT_EQ(
        error_of([&] { lua::in_child(budget, [] { return std::string(std::size_t{1} << 30, 'x').substr(0, 1); }); }),
        "needs more than 64 MiB of memory");
    EXPECT_EQ(lua::in_child(budget, [] { return std::string(std::size_t{16} << 20, 'x').substr(0, 1); }), "x");
}
#endif

TEST(Child, SaysNothingThatWouldCommandATerminal) {
    const test::Folder folder;
    const std::string file = folder / "words.txt";
    const int usual = ::dup(STDERR_FILENO), ours = ::open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(ours, STDERR_FILENO);
    error_in("print('\\27]0;owned\\7', '\\27[2J', 'two\\nlines')");
    ::dup2(usual, STDERR_FILENO);
    ::close(usual), ::close(ours);
    std::ifstream in(file);
    const std::string said{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(said, "\\x1b]0;owned\\x07\t\\x1b[2J\ttwo\nlines\n");
}

TEST(Child, SaysItsWordsThroughUsWhereverTheyGo) {
    const test::Folder folder;
    const std::string file = folder / "words.txt";
    const int usual = ::dup(STDERR_FILENO), ours = ::open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(ours, STDERR_FILENO);
    const std::string problem = error_in("print('hello', 7)\nsky = Ambient {}");
    const std::string chatter = error_in("for i = 1, 1e5 do print('0123456789') end");
    ::dup2(usual, STDERR_FILENO);
    ::close(usual), ::close(ours);
    std::ifstream in(file);
    const std::string said((std::istreambuf_iterator<char>(in)), {});
    EXPECT_EQ(problem, "");
    EXPECT_EQ(chatter, "");
    EXPECT_EQ(said.substr(0, 8), "hello\t7\n");
    EXPECT_LE(said.size(), 8u + (64u << 10)) << "it was to be cut short";
    EXPECT_GT(said.size(), 60'000u);
}

TEST(Child, SaysWhatItCanBeforeItIsEnded) {
    testing::internal::CaptureStderr();
    EXPECT_THAT(error_of([] {
                    parse_graph("print('so far') while true do end", "graph.lua",
                                {.cpu_seconds = 0.1, .wall_seconds = 60});
                }),
                HasSubstr("takes more than 0.1 s"));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "so far\n");
}

TEST(Child, IsAnsweredThoughWeHaveNoStandardFiles) {
    const int usual = ::dup(STDERR_FILENO), in = ::dup(STDIN_FILENO);
    ::close(STDERR_FILENO), ::close(STDIN_FILENO);  // the ends of its pipes get these numbers
    const std::string answer = lua::in_child({}, [] { return std::string("answer"); });
    ::dup2(usual, STDERR_FILENO), ::dup2(in, STDIN_FILENO);
    ::close(usual), ::close(in);
    EXPECT_EQ(answer, "answer");
}

TEST(Names, ThatAreManyOrLongAreRefused) {
    const std::string refused = "a file has too many names, or too long ones: at most 8 MiB in all";
    EXPECT_THAT(error_in("local a = ('x'):rep(1e6) for i = 1, 1e5 do local v = _ENV[a .. i] end"), HasSubstr(refused));
    EXPECT_THAT(error_in("local a = ('x'):rep(1e6) for i = 1, 1e5 do _ENV[a .. i] = 1 end"), HasSubstr(refused));
    EXPECT_THAT(error_in("sky = Ambient {} local a = ('x'):rep(1e6) for i = 1, 100 do _ENV[a .. i] = sky end"),
                HasSubstr(refused));
    EXPECT_THAT(error_in_hosts("local a = ('x'):rep(1e6) for i = 1, 9000 do place(a) {} end"), HasSubstr(refused));
    EXPECT_THAT(error_in_hosts("local a = ('x'):rep(1e6) for i = 1, 100 do place 'tcp://a:1' { [a .. i] = 1 } end"),
                HasSubstr(refused));
    EXPECT_THAT(error_in_hosts("for i = 1, 1e6 do strategy = 'fastest' end"), HasSubstr(refused));
    EXPECT_THAT(error_in_hosts("for i = 1, 1e6 do layout { a = 'sharded' } end"), HasSubstr(refused));
}

TEST(Names, MayBeWrittenAsOftenAsOneLikes) {
    EXPECT_EQ(error_in("n = 0 for i = 1, 2e5 do n = n + 1 end sky = Ambient { x = n }"), "");
}

TEST(Nodes, ThatAreTooManyAreRefusedWhereTheyAreMade) {
    EXPECT_EQ(error_in("n0 = Ambient {}\nfor i = 1, 1e5 do _ENV['n' .. i] = Scale { _ENV['n' .. i - 1] } end"),
              "graph.lua:2: a graph has at most 4096 nodes");
}

TEST(Complaints, AreToldUpToAHundred) {
    const auto nameless = problems_in("for i = 1, 1000 do local x = Ambient {} end");
    ASSERT_THAT(nameless, SizeIs(101));
    EXPECT_EQ(to_string(nameless.back()), "and 900 more");
    const auto entries = problems_in("local t = {} for i = 1, 500 do t[i] = print end sky = Ambient(t)");
    ASSERT_THAT(entries, SizeIs(101));
    EXPECT_EQ(to_string(entries.back()), "and 400 more");
}

TEST(Complaints, AreNoLongerThanOneReads) {
    for (const auto& problem :
         problems_in("local long = ('ü'):rep(1e5) sky = Ambient { [long] = print } _ENV[long] = Ambient { later }"))
        EXPECT_LT(problem.what.size(), 900u);
    EXPECT_THAT(problems_in("local t = {} for i = 1, 30 do t[('x'):rep(1e5) .. i] = print end sky = Ambient(t)"),
                SizeIs(30));
}

TEST(Complaints, OfHostsAreBoundedAlike) {
    const std::string error = error_in_hosts("for i = 1, 1000 do place 'tcp://a:1' { a = 'b' } end");
    EXPECT_THAT(error, HasSubstr("\nand 900 more"));
}

// As by a terminal, or by a container that is frozen: the answer is there when it goes on.
TEST(Child, HasNoLessTimeWhereItsParentIsStopped) {
    const pid_t process = ::fork();
    ASSERT_GE(process, 0);
    if (process == 0) {
        const lua::Budget budget{30, 1.5, std::size_t{256} << 20};
        const auto answer = [&] {
            return lua::in_child(budget, [] {
                ::usleep(500'000);
                return std::string("there");
            });
        };
        ::_exit(error_of([&] { (void)answer(); }).empty() ? 0 : 1);
    }
    ::usleep(100'000);
    ::kill(process, SIGSTOP);
    ::usleep(2'500'000);
    ::kill(process, SIGCONT);
    int status = 0;
    ASSERT_EQ(::waitpid(process, &status, 0), process);
    EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace lightnet::bounds_test
