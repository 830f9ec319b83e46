// Hosts that serve one run after the other.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>

#include "tests/modes/learning.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::run_after_run_test {
namespace {

using namespace std::chrono_literals;
using namespace test;

TEST(RunAfterRun, EndsAsSoonAsAllHostsSayThatTheyAreFree) {
    const Learning learning;
    const Folder folder;
    const HostThread one(learning.registry, 1, folder.file("one")), two(learning.registry, 1, folder.file("two"));
    const std::atomic<bool> never{false};
    for (std::uint64_t run = 1; run <= 100; ++run) {
        auto options = cluster_of(learning, {one.endpoint(), two.endpoint()});
        options.run = run;
        Cluster cluster(std::move(options));
        cluster.gather(slowdown * 20s, never);
        cluster.adopt(cluster.plan());
        const auto end = std::chrono::steady_clock::now() + slowdown * 30s;
        cluster.finish(slowdown * 60s);
        ASSERT_TRUE(std::chrono::steady_clock::now() < end) << "run " << run << ": a host did not end";
    }
}

TEST(RunAfterRun, GoesOnWithTheSceneOfTheRunBefore) {
    const Learning learning;
    const auto expected = learning.serial();
    const Folder folder;
    std::atomic<int> found{0};
    Host::Options host;
    host.places = 2;
    host.cache = folder.file("one");
    host.log = [&found](const LogEntry& entry) { found += entry.text == "has its scene from the run before"; };
    const HostThread one(learning.registry, std::move(host));
    const std::atomic<bool> never{false};
    const auto run = [&](std::uint32_t wider) {
        auto options = cluster_of(learning, {one.endpoint()});
        options.job.width += wider;
        Cluster cluster(std::move(options));
        cluster.gather(slowdown * 20s, never);
        if (wider == 0) {
            EXPECT_TRUE(learning.networked(cluster) == expected);
        }
        cluster.finish(slowdown * 60s);
        return found.load();
    };
    EXPECT_EQ(run(0), 0);
    EXPECT_EQ(run(0), 1);
    EXPECT_EQ(run(8), 1) << "another camera's picture";
    EXPECT_EQ(run(0), 1) << "the scene before the last is gone";
    EXPECT_EQ(run(0), 2);
}

TEST(RunAfterRun, NeedsNoFilesOfASceneThatIsThere) {
    const Learning learning;
    const auto expected = learning.serial();
    const Folder folder;
    Host::Options host;
    host.places = 1;
    host.cache = folder.file("one");
    const HostThread one(learning.registry, std::move(host));
    const std::atomic<bool> never{false};
    const auto run = [&] {
        Cluster cluster(cluster_of(learning, {one.endpoint()}));
        cluster.gather(slowdown * 20s, never);
        EXPECT_TRUE(learning.networked(cluster) == expected);
        cluster.finish(slowdown * 60s);
    };
    const auto file = folder.file("one") + "/" + to_hex(cluster_of(learning, {}).job.files.at(0).hash);
    run();
    EXPECT_TRUE(std::filesystem::remove(file));
    run();
    EXPECT_FALSE(std::filesystem::exists(file)) << "it was brought once more";
}

}  // namespace
}  // namespace lightnet::run_after_run_test
