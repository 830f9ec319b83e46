// Lines that are cut, hang and damage what they carry, and workers that are killed and stopped over and over: the bytes
// stay the same, nothing is lost or counted twice.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/modes/daemons.hpp"
#include "tests/modes/long_enough.hpp"
#include "tests/support/bad_line.hpp"

namespace lightnet::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

#ifdef LIGHTNET_LARGE
constexpr int cuts = 100, kills = 100, stops = 50;
constexpr auto length = seconds(120);  // of an undisturbed run: all of this must happen in it
constexpr auto patience = seconds(900);
#else
constexpr int cuts = 10, kills = 4, stops = 1;
constexpr auto length = seconds(2);
constexpr auto patience = slowdown * seconds(60);
#endif

class Cut : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        reference = new Launch(launch_for(length, graph_file("cornell.lua"), picture, patience));
        ASSERT_EQ(reference->code, 0) << reference->said;
    }
    static void TearDownTestSuite() { delete reference; }

    std::unique_ptr<Process> start(std::vector<std::string> more) {
        auto words = picture;
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<Process>(launch_words(graph_file("cornell.lua"), out, words));
    }
    // Both daemons stand behind bad lines; operators are on both, so that they ask each other.
    std::unique_ptr<Process> start_between(const std::string& one, const std::string& two) {
        return start(
            {"--hosts", folder.write("hosts.lua", "place '" + one + "' { image = 1, direct = 1, lighting = 1 }\n" +
                                                      "place '" + two + "' { image = 1, bounce = 1 }\n")});
    }
    static std::size_t times(const std::string& text, const std::string& word) {
        std::size_t count = 0;
        for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
        return count;
    }
    // What the last line of progress says when each tile was counted once.
    static std::string all_tiles() {
        const auto tiles = std::to_string(4 * 4 * std::stoi(picture[3]) / 16);
        return "\"done\":" + tiles + ",\"total\":" + tiles + ",";
    }
    // False: the run is over.
    static bool pause(Process& run, int ms) {
        run.wait_for("never said", milliseconds(ms));
        return run.wait(milliseconds(1)) < 0;
    }
    // Every tile is there once.
    Launch expect_same(Process& run) {
        auto end = finish(run, out, patience);
        EXPECT_EQ(end.code, 0) << end.said;
        EXPECT_TRUE(end.picture == reference->picture) << "the bytes differ\n" << end.said;
        const auto last = end.said.rfind("\"event\":\"finish\"");
        EXPECT_NE(end.said.find(all_tiles(), std::min(last, end.said.size())), std::string::npos)
            << "not every tile was counted once\n"
            << end.said;
        return end;
    }

    static inline std::vector<std::string> picture{"--size",     "64x64", "--samples", "128",
                                                   "--progress", "json",  "--tile",    "16"};
    static inline Launch* reference = nullptr;
    Folder folder;
    std::filesystem::path out = folder / "picture.exr";
};

TEST_F(Cut, LinesHealAndChangeNoByte) {
    const Daemon one(folder), two(folder);
    BadLine first(one.endpoint), second(two.endpoint);
    const auto run = start_between(first.endpoint(), second.endpoint());
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    int done = 0;
    for (; done < cuts && pause(*run, 60); ++done) {
        auto& line = done % 2 ? first : second;
        done % 3 == 2 ? line.truncate() : line.cut();
    }
    expect_same(*run);
    EXPECT_GE(done, cuts) << "the run was too short";
}

TEST_F(Cut, LinesOfHostsThatDialledInHealToo) {
    const auto run = start({"--listen", "tcp://127.0.0.1:*", "--hosts",
                            folder.write("hosts.lua", "place 'left' { image = 1 }\nplace 'right' { bounce = 1 }\n")});
    BadLine first(join_endpoint(*run)), second(join_endpoint(*run));
    const auto left = joining_daemon(folder, first.endpoint(), "left"),
               right = joining_daemon(folder, second.endpoint(), "right");
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    int done = 0;
    for (; done < cuts && pause(*run, 60); ++done) (done % 2 ? first : second).cut();
    expect_same(*run);
    EXPECT_GE(done, cuts) << "the run was too short";
}

TEST_F(Cut, DamagedBytesAreNeverTakenForAnswers) {
    const Daemon one(folder), two(folder);
    BadLine first(one.endpoint), second(two.endpoint);
    const auto run = start_between(first.endpoint(), second.endpoint());
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    for (auto* line : {&first, &second}) line->flip_every(1'000'000);
    const auto end = expect_same(*run);
    EXPECT_GT(first.flips() + second.flips(), 0u);
}

TEST_F(Cut, LinesThatHangWithoutAWordAreNoticed) {
    const Daemon one(folder), two(folder);
    BadLine first(one.endpoint), second(two.endpoint);
    const auto run = start_between(first.endpoint(), second.endpoint());
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    second.hold(true);
    ASSERT_TRUE(run->wait_for("is lost")) << run->output();
    second.hold(false);
    expect_same(*run);
}

TEST_F(Cut, WorkersThatAreKilledAgainAndAgainAreStartedAnew) {
    const auto run = start({"--local-workers", "2"});
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    Clock::duration slowest{};
    const auto mark = "--parent " + std::to_string(run->id());
    int done = 0;
    for (; done < kills && pause(*run, 50); ++done) {
        // One that dies again and again before it was of use is given up.
        const auto ready = 2 + static_cast<std::size_t>(done);
        while (times(run->output(), "is ready") < ready && pause(*run, 10)) {
        }
        const auto workers = processes_with(mark);
        if (workers.empty()) break;
        const auto anew = times(run->output(), "it is started anew");
        ::kill(workers[static_cast<std::size_t>(done) % workers.size()], SIGKILL);
        const auto begun = Clock::now();
        while (times(run->output(), "it is started anew") == anew && pause(*run, 5)) {
        }
        slowest = std::max(slowest, Clock::now() - begun);
    }
    RecordProperty("slowest_ms", std::to_string(slowest / milliseconds(1)));
    const auto end = expect_same(*run);
    EXPECT_GE(done, kills) << "the run was too short";
    EXPECT_NE(end.said.find("it is started anew"), std::string::npos) << end.said;
    EXPECT_TRUE(processes_with(mark).empty()) << "no process may stay behind";
}

TEST_F(Cut, HostsThatAreStoppedAgainAndAgainAreLostAndFound) {
    const Daemon one(folder), two(folder);
    const auto run = start_between(one.endpoint, two.endpoint);
    ASSERT_TRUE(run->wait_for("\"event\":\"progress\"")) << run->output();
    Clock::duration slowest{};
    int done = 0;
    for (; done < stops && pause(*run, 10); ++done) {
        const auto before = times(run->output(), "is lost");
        two.process->signal(SIGSTOP);
        const auto begun = Clock::now();
        while (times(run->output(), "is lost") == before && Clock::now() - begun < slowdown * seconds(20))
            if (!pause(*run, 10)) break;
        slowest = std::max(slowest, Clock::now() - begun);
        two.process->signal(SIGCONT);
        const auto ready = times(run->output(), two.endpoint + " is ready");
        while (times(run->output(), two.endpoint + " is ready") == ready && pause(*run, 10)) {
        }
    }
    RecordProperty("slowest_ms", std::to_string(slowest / milliseconds(1)));
    expect_same(*run);
    EXPECT_EQ(done, stops) << "the run was too short";
}

}  // namespace
}  // namespace lightnet::test
