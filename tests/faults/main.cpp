// Plays rows of the table of faults. A guard stands behind them: whatever a row started, in whatever way the row ended,
// is ended as well.
#include <gtest/gtest.h>

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "tests/faults/memory_group.hpp"
#include "tests/faults/rows.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::test {
namespace {

pid_t player = 0;  // a handler can reach nothing else

void stop_player(int) { ::kill(player, SIGKILL); }

// All orphans below come to the guard, so that in the end these are all.
std::vector<pid_t> children() {
    std::ifstream in("/proc/self/task/" + std::to_string(getpid()) + "/children");
    std::vector<pid_t> all;
    for (pid_t child = 0; in >> child;) all.push_back(child);
    return all;
}

void bury() {
    while (::waitpid(-1, nullptr, WNOHANG) > 0) {
    }
}

std::string words_of(pid_t process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/cmdline");
    std::string line((std::istreambuf_iterator<char>(in)), {});
    for (auto& c : line)
        if (c == '\0') c = ' ';
    return line;
}

// What is still there a while after the end; all of it is killed.
std::vector<std::string> left_behind() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(3);
    for (bury(); !children().empty() && std::chrono::steady_clock::now() < end; bury())
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::vector<std::string> left;
    for (const auto child : children()) left.push_back(words_of(child));
    while (!children().empty()) {
        for (const auto child : children()) ::kill(child, SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        bury();
    }
    return left;
}

// Where rows keep their files: it goes, however they end.
class Shed {
public:
    Shed() {
        std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755));  // some rows are other users
        ::setenv("TMPDIR", folder_.path().c_str(), 1);
    }

private:
    Folder folder_;
};

int play(pid_t guard) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    return ::getppid() == guard ? RUN_ALL_TESTS() : 1;
}

int guard() {
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);
    const Shed shed;
    const pid_t self = ::getpid();
    player = ::fork();
    if (player == 0) _exit(play(self));  // the shed is the guard's
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, stop_player);
    int status = 0;
    while (::waitpid(player, &status, 0) < 0 && errno == EINTR) {
    }
    const auto left = left_behind();
    for (const auto& group : memory_groups(player)) ::rmdir(group.c_str());  // of a row that did not get so far
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return 1;
    for (const auto& words : left) std::cout << "seen: left behind: " << words << std::endl;
    return left.empty() ? 0 : 1;
}

TEST(TableOfFaults, HasATestForEachRowAndARowForEachTest) {
    std::size_t tests = 0;
    const auto& unit = *::testing::UnitTest::GetInstance();
    for (int i = 0; i < unit.total_test_suite_count(); ++i)
        if (std::string(unit.GetTestSuite(i)->name()) == "Faults")
            tests = static_cast<std::size_t>(unit.GetTestSuite(i)->total_test_count());
    EXPECT_EQ(tests, rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].number, static_cast<int>(i) + 1) << rows[i].name;
}

}  // namespace
}  // namespace lightnet::test

int main(int argc, char** argv) {
    ::testing::InitGoogleTest(&argc, argv);
    return ::testing::GTEST_FLAG(list_tests) ? RUN_ALL_TESTS() : lightnet::test::guard();
}
