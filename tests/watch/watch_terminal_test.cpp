// `lightnet watch`: a run in a terminal.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "tests/modes/daemons.hpp"

namespace lightnet::watch_terminal_test {
namespace {

using namespace std::chrono_literals;
using test::Folder;
using test::graph_file;
using test::Process;
using test::program;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A program on a terminal of 100 × 30 letters, and what that shows.
class Terminal {
public:
    explicit Terminal(std::vector<std::string> words) {
        winsize size{};
        size.ws_col = 100, size.ws_row = 30;
        std::vector<char*> arguments;
        for (auto& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        process_ = ::forkpty(&line_, nullptr, nullptr, &size);
        if (process_ == 0) {
            ::execv(arguments[0], arguments.data());
            ::_exit(127);
        }
    }
    ~Terminal() {
        ::close(line_);
        if (!ended_) ::kill(process_, SIGKILL), ::waitpid(process_, nullptr, 0);
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    // Until the screen shows it. False: too long, or the program has ended.
    bool wait_for(const std::string& text) {
        const auto end = std::chrono::steady_clock::now() + test::slowdown * 30s;
        while (screen().find(text) == std::string::npos)
            if (std::chrono::steady_clock::now() > end || !read()) return screen().find(text) != std::string::npos;
        return true;
    }
    int wait() {
        while (read()) {
        }
        int status = 0;
        ::waitpid(process_, &status, 0);
        ended_ = true;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    void signal(int number) const { ::kill(process_, number); }
    std::string screen() const {
        std::string text;
        for (const auto& line : lines_) text += line + "\n";
        return text;
    }
    int redraws() const { return redraws_; }

private:
    bool read() {
        pollfd item{line_, POLLIN, 0};
        if (::poll(&item, 1, 20'000) <= 0) return false;
        std::array<char, 4096> part{};
        const auto size = ::read(line_, part.data(), part.size());
        if (size <= 0) return false;
        for (const char letter : std::string(part.data(), static_cast<std::size_t>(size))) show(letter);
        return true;
    }
    // What the program uses of a terminal's language: up, to the left, and away with all that is below.
    void show(char letter) {
        if (!escape_.empty() || letter == '\x1b') {
            escape_ += letter;
            if (!std::isalpha(static_cast<unsigned char>(letter))) return;
            if (letter == 'A') row_ -= std::min<std::size_t>(row_, std::stoul(escape_.substr(2)));
            if (letter == 'J') lines_.resize(row_), ++redraws_;
            if (letter != 'A' && letter != 'J') ADD_FAILURE() << "a word that is not known: " << escape_.substr(1);
            escape_.clear();
            return;
        }
        if (letter == '\r') return;
        if (letter == '\n') {
            ++row_;
            return;
        }
        if (lines_.size() <= row_) lines_.resize(row_ + 1);
        lines_[row_] += letter;
        EXPECT_LE(std::count_if(lines_[row_].begin(), lines_[row_].end(), [](char c) { return (c & 0xc0) != 0x80; }),
                  100);
    }

    int line_ = -1;
    pid_t process_ = -1;
    bool ended_ = false;
    std::string escape_;
    std::vector<std::string> lines_;
    std::size_t row_ = 0;
    int redraws_ = 0;
};

std::string address_in(Process& run) {
    const std::string before = "watch it at ";
    EXPECT_TRUE(run.wait_for(before) && run.wait_for("\n")) << run.output();
    const auto at = run.output().find(before) + before.size();
    return run.output().substr(at, run.output().find('\n', at) - at);
}

// One that goes on until it is told to end.
std::vector<std::string> long_run(const std::string& picture, std::vector<std::string> more) {
    more.insert(more.end(), {"--samples", "1000000", "--size", "64x64", "--watch"});
    return test::launch_words(graph_file("cornell.lua"), picture, more);
}

TEST(WatchInATerminal, IsDrawnAnewUntilTheRunEnds) {
    const Folder folder;
    Process run(long_run(folder / "x.exr", {"--local-workers", "2", "--cache", folder / "cache"}));
    const auto url = address_in(run);
    Terminal terminal({program("lightnet"), "watch", url});
    ASSERT_TRUE(terminal.wait_for("cornell.lua  render")) << terminal.screen();
    // The screen is drawn line by line, and hosts may get ready after the first time that it is.
    for (const char* part : {" left", "DirectLighting", "questions/s", "is ready"})
        EXPECT_TRUE(terminal.wait_for(part)) << part << "\n" << terminal.screen();
    EXPECT_GT(terminal.redraws(), 0);

    Process stranger({program("lightnet"), "watch", url.substr(0, url.find('#')), "--end"});
    EXPECT_EQ(stranger.wait(), 2) << stranger.output();
    EXPECT_THAT(stranger.output(), HasSubstr("token"));
    Process end({program("lightnet"), "watch", url, "--end"});
    EXPECT_EQ(end.wait(), 0) << end.output();
    EXPECT_EQ(run.wait(), 130) << run.output();
    EXPECT_EQ(terminal.wait(), 0) << terminal.screen();
    EXPECT_THAT(terminal.screen(), HasSubstr("cornell.lua  cancelled")) << "what it was at last stays";
}

TEST(WatchInATerminal, WaitsForWhatBecomesOfAWish) {
    const Folder folder;
    Process run(long_run(folder / "x.exr", {"--local-workers", "2", "--cache", folder / "cache"}));
    const auto url = address_in(run);
    const auto ask = [&](const std::vector<std::string>& wish) {
        std::vector<std::string> words{program("lightnet"), "watch", url};
        words.insert(words.end(), wish.begin(), wish.end());
        Process watch(words);
        const int code = watch.wait();
        return std::to_string(code) + " " + watch.output();
    };
    EXPECT_THAT(ask({"--drain", "foo"}),
                AllOf(StartsWith("2 "), HasSubstr("'foo' can't be taken out: it is not there")));
    EXPECT_EQ(ask({"--write"}), "0 ");
    EXPECT_TRUE(std::filesystem::exists(folder / "x.exr"));
    EXPECT_EQ(ask({"--end"}), "0 ");
    EXPECT_EQ(run.wait(), 130) << run.output();
}

TEST(WatchInATerminal, SaysWhenTheLauncherIsGone) {
    const Folder folder;
    Process run(long_run(folder / "x.exr", {"--threads", "2"}));
    Terminal terminal({program("lightnet"), "watch", address_in(run)});
    ASSERT_TRUE(terminal.wait_for("cornell.lua  render")) << terminal.screen();
    run.signal(SIGKILL);
    EXPECT_EQ(terminal.wait(), 1);
    EXPECT_THAT(terminal.screen(), HasSubstr("the launcher is gone"));
}

TEST(WatchInATerminal, IsPrintedOnceWhereThereIsNone) {
    const Folder folder;
    Process run(long_run(folder / "x.exr", {"--threads", "2"}));
    Process watch({program("lightnet"), "watch", address_in(run)});
    EXPECT_EQ(watch.wait(), 0) << watch.output();
    EXPECT_THAT(watch.output(), AllOf(HasSubstr("cornell.lua  "), HasSubstr("here"), Not(HasSubstr("\x1b"))));
}

TEST(WatchInATerminal, PrintsTheReportOfARun) {
    const Folder folder;
    const auto launch =
        test::launch(graph_file("cornell.lua"), folder, {"--threads", "2", "--samples", "16", "--size", "64x64"});
    ASSERT_EQ(launch.code, 0) << launch.said;
    Process watch({program("lightnet"), "watch", folder / "picture.run.json"});
    EXPECT_EQ(watch.wait(), 0) << watch.output();
    EXPECT_THAT(watch.output(), AllOf(HasSubstr("cornell.lua  done"), HasSubstr("DirectLighting"), HasSubstr("here")));
}

TEST(WatchInATerminal, SaysWhatIsNoRun) {
    const Folder folder;
    const auto said = [](const std::vector<std::string>& words) {
        Process watch(words);
        const int code = watch.wait();
        return std::to_string(code) + " " + watch.output();
    };
    const auto lightnet = program("lightnet");
    EXPECT_THAT(said({lightnet, "watch", folder / "none.run.json"}),
                AllOf(HasSubstr("2 "), HasSubstr("can't be read")));
    EXPECT_THAT(said({lightnet, "watch", folder.write("x.json", "{}")}), HasSubstr("no report of a run"));
    EXPECT_THAT(said({lightnet, "watch", "https://farm/#1"}), AllOf(HasSubstr("2 "), HasSubstr("ssh -L")));
    EXPECT_THAT(said({lightnet, "watch", "http://127.0.0.1:1/#1"}), HasSubstr("1 "));
}

}  // namespace
}  // namespace lightnet::watch_terminal_test
