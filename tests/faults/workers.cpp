// Workers that are killed, hang, are slow, or have wrong clocks.
#include <fmt/format.h>

#include <atomic>
#include <csignal>

#include "tests/faults/faults.hpp"

namespace lightnet::test {
namespace {

// Waits until `text` was said more than `before` times: how long it took. None: the run is over.
double until_said(Process& run, const std::string& text, std::size_t before) {
    const auto begun = Clock::now();
    while (times(run.output(), text) <= before) {
        run.wait_for("never said", milliseconds(2));
        if (run.wait(milliseconds(1)) >= 0) break;
    }
    return seconds_since(begun);
}

TEST_F(Faults, OfWorkersThatAreKilledChangeNoByte) {
    constexpr int goal = 20;
    const std::string progress = "\"event\":\"progress\"";
    int kills = 0, runs = 0;
    double slowest = 0;
    for (; kills < goal && !HasFailure(); ++runs) {
        const auto run = start_in_the_middle(lasting, {"--local-workers", "2"});
        const auto mark = "--parent " + std::to_string(run->id());
        for (std::size_t here = 0; kills < goal && pause(*run, milliseconds(50)); ++here) {
            // One that dies again and again before it was of use is given up, and a tile of which three died is set
            // aside: something is done between deaths.
            while (times(run->output(), "is ready") < 2 + here && pause(*run, milliseconds(10))) {
            }
            until_said(*run, progress, times(run->output(), progress) + 1);
            const auto workers = processes_with(mark);
            if (workers.empty() || run->wait(milliseconds(1)) >= 0) break;
            const auto anew = times(run->output(), "it is started anew");
            ::kill(workers[here % workers.size()], SIGKILL);
            const double took = until_said(*run, "it is started anew", anew);
            if (run->wait(milliseconds(1)) >= 0) break;  // it ended before it had to notice
            slowest = std::max(slowest, took);
            ++kills;
        }
        expect_same(*run, lasting);
        EXPECT_TRUE(processes_with(mark).empty()) << "no process may stay behind";
    }
    done(fmt::format("{} workers killed in {} runs", kills, runs));
    seen(fmt::format("each started anew, after {:.2f} s at most", slowest));
    EXPECT_LT(slowest, slowdown * 2.0);
    figure("noticed", slowest, "s", 2, false);
}

TEST_F(Faults, OfWorkersThatHangAndWakeChangeNoByte) {
    constexpr int goal = 6;
    int stops = 0, runs = 0;
    double slowest = 0, late = 0;
    for (; stops < goal && !HasFailure(); ++runs) {
        const Daemon one(folder), two(folder);
        const auto run =
            start_in_the_middle(lasting, {"--hosts", hosts_file({whole(one.endpoint), whole(two.endpoint)})});
        while (stops < goal && pause(*run, milliseconds(100))) {
            const auto lost = times(run->output(), "is lost");
            two.process->signal(SIGSTOP);
            const double took = until_said(*run, "is lost", lost);
            if (run->wait(milliseconds(1)) < 0) {
                slowest = std::max(slowest, took);
                ++stops;
            }
            const auto ready = times(run->output(), two.endpoint + " is ready");
            two.process->signal(SIGCONT);
            until_said(*run, two.endpoint + " is ready", ready);
        }
        const auto report = expect_same(*run, lasting);
        if (!report.empty()) late += counter(report, "late_replies");
    }
    done(fmt::format("{} hangs of a worker in {} runs", stops, runs));
    seen(fmt::format("lost after {:.2f} s at most, found again; {:.0f} late replies dropped", slowest, late));
    EXPECT_LT(slowest, slowdown * 2.5);
    figure("noticed", slowest, "s", 2, false);
}

/// Lets a process run a tenth of the time.
class Straggle {
public:
    explicit Straggle(const Process& process)
        : thread_([&process](const std::stop_token& over) {
              while (!over.stop_requested()) {
                  process.signal(SIGSTOP);
                  std::this_thread::sleep_for(milliseconds(90));
                  process.signal(SIGCONT);
                  std::this_thread::sleep_for(milliseconds(10));
              }
          }) {}

private:
    std::jthread thread_;
};

TEST_F(Faults, OfAStragglerChangeNoByte) {
    const auto timed = [&](const std::vector<std::string>& places) {
        const auto begun = Clock::now();
        expect_same(*start(usual, {"--hosts", hosts_file(places)}), usual);
        return seconds_since(begun);
    };
    const Daemon good(folder), slow(folder);
    reference(usual);
    const double alone = timed({whole(good.endpoint)});
    double with = 0;
    {
        const Straggle straggle(*slow.process);
        with = timed({whole(good.endpoint), whole(slow.endpoint)});
    }
    done("one run with a good worker alone, one with a straggler beside it");
    seen(fmt::format("{:.1f} s alone, {:.1f} s with the straggler", alone, with));
    figure("time", with / alone, "of the time without it", 1.3, false);
}

// A day off, and another hour at each look at the clock.
TEST_F(Faults, OfClocksThatAreWrongChangeNothing) {
    const auto wrong = [](const std::string& days) {
        return "export LD_PRELOAD=" LIGHTNET_WRONG_CLOCK " LIGHTNET_WRONG_DAYS=" + days;
    };
    int runs = 0;
    std::size_t deaths = 0;
    for (const auto* const days : {"-1", "1", "jumps"}) {
        const OddDaemon one(under(wrong(days), daemon_words(folder / "cache"))), two(daemon_words(folder / "cache"));
        ASSERT_FALSE(one.endpoint.empty()) << one.process->output();
        const auto words = launch_words(
            graph_file("cornell.lua"), out,
            join(usual, {"--hosts", hosts_file({whole(one.endpoint), whole(two.endpoint)}), "--checkpoint", "1"}));
        Process run(under(wrong(runs == 2 ? "jumps" : "0"), words));
        expect_same(run, usual);
        EXPECT_EQ(times(run.output(), "is lost"), 0u) << run.output();
        deaths += times(run.output(), "is lost");
        ++runs;
    }
    done(fmt::format("{} runs: a worker a day early, a day late, all clocks jumping", runs));
    seen(fmt::format("{} hosts taken for dead", deaths));
}

}  // namespace
}  // namespace lightnet::test
