// The launcher is killed at any point of its run.
#include <fmt/format.h>

#include <csignal>
#include <random>

#include "tests/faults/faults.hpp"

namespace lightnet::test {
namespace {

const Words some_seconds{"--size", "64x64", "--samples", "1024", "--tile", "16", "--progress", "json"};

TEST_F(Faults, OfALauncherThatIsKilledAndResumedChangeNoByte) {
    constexpr int goal = 20, seed = 8;
    std::mt19937 random(seed);
    const auto picture = reference(some_seconds);
    const std::vector<Words> modes{{"--threads", "2"}, {"--local-workers", "2"}, {"--threads", "1"}};
    std::vector<double> lengths;  // of undisturbed runs
    for (const auto& mode : modes) {
        const auto begun = Clock::now();
        expect_same(*start(some_seconds, mode), some_seconds);
        lengths.push_back(seconds_since(begun));
    }
    int kills = 0, resumed = 0, from_checkpoint = 0, whole_before = 0;
    while (kills < goal && !HasFailure()) {
        const auto mode = random() % modes.size();
        const auto point = std::uniform_real_distribution<>(0, lengths[mode])(random);
        for (const auto& entry : std::filesystem::directory_iterator(folder.path())) std::filesystem::remove(entry);
        const auto words = join(modes[mode], {"--checkpoint", "1"});
        int killed = 0;
        {
            const auto run = start(some_seconds, words);
            killed = run->id();
            if (!pause(*run, milliseconds(static_cast<int>(1000 * point)))) continue;
            run->signal(SIGKILL);
            EXPECT_EQ(run->wait(), 128 + SIGKILL);
            ++kills;
        }
        const bool there = std::filesystem::exists(out);
        whole_before += there;
        EXPECT_TRUE(!there || bytes_of(out) == picture) << "half a picture, after " << point << " s";
        from_checkpoint += std::filesystem::exists(out.string() + ".checkpoint");
        const auto other = modes[random() % modes.size()];
        const auto run = start(some_seconds, join(other, {"--checkpoint", "1", "--resume"}));
        resumed += run->wait(slowdown * seconds(60)) == 0;
        EXPECT_TRUE(bytes_of(out) == picture) << "killed after " << point << " s\n" << run->output();
        EXPECT_TRUE(processes_with("--parent " + std::to_string(killed)).empty()) << "a daemon without its launcher";
    }
    done(fmt::format("{} kills at random points (seed {}), each resumed, in threads and on workers", kills, seed));
    seen(fmt::format("{} pictures the same, {} from a checkpoint; {} were whole before", resumed, from_checkpoint,
                     whole_before));
    EXPECT_EQ(resumed, kills);
    EXPECT_GT(from_checkpoint, 0) << "no run lived long enough for a checkpoint";
}

}  // namespace
}  // namespace lightnet::test
