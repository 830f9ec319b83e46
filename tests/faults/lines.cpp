// Lines that hang, are slow, break, damage what they carry, and deliver it late and twice.
#include <fmt/format.h>

#include <random>

#include "tests/bench/figure.hpp"
#include "tests/faults/faults.hpp"
#include "tests/support/bad_line.hpp"
#include "tests/support/delaying_proxy.hpp"
#include "tests/support/meddling_post.hpp"

namespace lightnet::test {
namespace {

// Operators are on both, so that the daemons ask each other over the same lines.
std::vector<std::string> between(const std::string& one, const std::string& two) {
    return {"'" + one + "' { image = 1, direct = 1, lighting = 1 }", "'" + two + "' { image = 1, bounce = 1 }"};
}

TEST_F(Faults, OfLinesThatHangChangeNoByte) {
    constexpr int goal = 12, seed = 4;
    std::mt19937 random(seed);
    int cuts = 0, losses = 0, runs = 0;
    double slowest = 0;
    for (; cuts < goal && !HasFailure(); ++runs) {
        const Daemon one(folder), two(folder);
        BadLine first(one.endpoint), second(two.endpoint);
        const auto run =
            start_in_the_middle(lasting, {"--hosts", hosts_file(between(first.endpoint(), second.endpoint()))});
        while (cuts < goal && pause(*run, milliseconds(200))) {
            BadLine& line = random() % 2 ? first : second;
            const auto ready = line.endpoint() + " is ready", lost = line.endpoint() + " is lost";
            const auto losses_before = times(run->output(), lost), ready_before = times(run->output(), ready);
            const auto way = random() % 3;  // both, there, back
            const auto hold = [&](bool on) {
                way == 0 ? line.hold(on)
                         : line.hold(way == 1 ? BadLine::Way::to_target : BadLine::Way::from_target, on);
            };
            hold(true);
            const bool goes_on = pause(*run, milliseconds(50 + random() % 2500));
            hold(false);
            const auto healed = Clock::now();
            ++cuts;
            if (!goes_on || times(run->output(), lost) == losses_before) continue;
            ++losses;
            while (times(run->output(), ready) == ready_before && pause(*run, milliseconds(5))) {
            }
            if (run->wait(milliseconds(1)) < 0) slowest = std::max(slowest, seconds_since(healed));
        }
        expect_same(*run, lasting);
    }
    done(fmt::format("{} hangs of 0.05 to 2.5 s (seed {}), both ways and one way, in {} runs", cuts, seed, runs));
    seen(fmt::format("{} times a host was lost, and ready again {:.2f} s at most after the line healed", losses,
                     slowest));
    EXPECT_LT(slowest, slowdown * 5.0);
    figure("resumed", slowest, "s", 3, false);
}

TEST_F(Faults, OfALineThatIsBadChangeNothingButTheTime) {
    const auto delay = std::chrono::milliseconds(25);  // each way
    const LineLoss loss{.share = 0.05, .delay = milliseconds(200), .seed = 5};
    const Daemon one(folder), two(folder);
    DelayingProxy first(one.endpoint, delay, loss), second(two.endpoint, delay, loss);
    BadLine narrow(first.endpoint()), wide(second.endpoint());
    for (auto* line : {&narrow, &wide}) line->limit(20e6 / 8);
    const auto begun = Clock::now();
    const Words picture{"--size", "64x64", "--samples", "128", "--tile", "16", "--progress", "json"};
    const auto run = start(picture, {"--hosts", hosts_file(between(narrow.endpoint(), wide.endpoint()))});
    expect_same(*run, picture);
    done(fmt::format("a run of {:.0f} s at 50 ms, 20 Mbit/s, {} pieces lost", seconds_since(begun),
                     first.losses() + second.losses()));
    const auto deaths = times(run->output(), "is lost");
    seen(fmt::format("{} hosts taken for dead", deaths));
    EXPECT_EQ(deaths, 0u) << run->output();
    EXPECT_GT(first.losses() + second.losses(), 0u);
}

TEST_F(Faults, OfLinesThatBreakAndDamageChangeNoByte) {
    constexpr std::uint64_t most_cuts = 200, most_flips = 50;
    std::uint64_t cuts = 0, flips = 0;
    double broken = 0;
    int runs = 0;
    for (; (cuts < most_cuts || flips < most_flips) && !HasFailure(); ++runs) {
        const Daemon one(folder), two(folder);
        BadLine first(one.endpoint), second(two.endpoint);
        const auto run =
            start_in_the_middle(usual, {"--hosts", hosts_file(between(first.endpoint(), second.endpoint()))});
        for (auto* line : {&first, &second}) line->flip_every(flips < most_flips ? 1'000'000 : 0);
        for (int i = 0; pause(*run, milliseconds(60)); ++i) {
            if (cuts + first.cuts() + second.cuts() >= most_cuts) continue;
            auto& line = i % 2 ? first : second;
            i % 3 == 2 ? line.truncate() : line.cut();
        }
        const auto report = expect_same(*run, usual);
        if (!report.empty()) broken += counter(report, "broken_packets");
        cuts += first.cuts() + second.cuts();
        flips += first.flips() + second.flips();
    }
    done(fmt::format("{} connections reset, some in the middle of a packet, {} bits flipped, in {} runs", cuts, flips,
                     runs));
    seen(fmt::format("{:.0f} damaged packets known and dropped", broken));
}

TEST_F(Faults, OfRepliesThatComeLateAndTwiceChangeNoByte) {
    constexpr std::uint64_t goal = 20;
    std::uint64_t meddled = 0;
    double late = 0, repeated = 0;
    int runs = 0;
    for (; meddled < goal && !HasFailure(); ++runs) {
        const Daemon one(folder), two(folder);
        MeddlingPost first(one.endpoint, {.seed = 7}), second(two.endpoint, {.seed = 8});
        const auto run = start(usual, {"--hosts", hosts_file(between(first.endpoint(), second.endpoint()))});
        const auto report = expect_same(*run, usual);
        if (!report.empty()) late += counter(report, "late_replies"), repeated += counter(report, "repeated_tiles");
        meddled += first.meddled() + second.meddled();
    }
    done(fmt::format("{} replies kept back up to 3 s and delivered twice, in {} runs", meddled, runs));
    seen(fmt::format("{:.0f} late replies dropped, {:.0f} tiles that came again dropped", late, repeated));
}

// The consumer gets a hundredth of what it would take.
TEST_F(Faults, OfAConsumerThatIsSlowFillNoMemory) {
    const Daemon one(folder), two(folder);
    BadLine narrow(two.endpoint);
    const Words endless{"--size", "512x512", "--samples", "4096", "--progress", "json"};
    const auto run = start_in_the_middle(endless, {"--hosts", hosts_file(between(one.endpoint, narrow.endpoint()))});
    narrow.limit(100'000);
    const auto all = [&] {
        return std::array{memory_of(run->id()), memory_of(one.process->id()), memory_of(two.process->id())};
    };
    pause(*run, seconds(17));  // the first checkpoints take room that the launcher keeps: after 5 s, and 5 s more
    std::array<std::vector<double>, 3> sizes;
    for (int i = 0; i < 45; ++i) {
        pause(*run, milliseconds(400));
        const auto now = all();
        for (std::size_t k = 0; k < now.size(); ++k) sizes[k].push_back(now[k]);
    }
    double most = 0;
    std::array<double, 3> late{};
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        const double early = bench::median({sizes[k].begin(), sizes[k].begin() + 15});
        late[k] = bench::median({sizes[k].end() - 15, sizes[k].end()});
        EXPECT_GT(late[k], 0) << "a process is gone\n" << run->output();
        most = std::max(most, late[k] / early - 1);
    }
    run->signal(SIGINT);
    EXPECT_EQ(run->wait(slowdown * seconds(10)), 130) << run->output();
    done("18 s behind a line of 100 kB/s, after 17 s of warming up");
    seen(fmt::format("launcher {:.0f} MB, daemons {:.0f} and {:.0f} MB", late[0], late[1], late[2]));
    EXPECT_LT(most, 0.25);
    figure("growth", 100 * most, "%", 5, false);
}

}  // namespace
}  // namespace lightnet::test
