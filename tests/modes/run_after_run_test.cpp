// Hosts that serve one run after the other.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

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
        cluster.gather(slowdown * 5s, never);
        cluster.adopt(cluster.plan());
        const auto end = std::chrono::steady_clock::now() + slowdown * 5s;
        cluster.finish(slowdown * 10s);
        ASSERT_TRUE(std::chrono::steady_clock::now() < end) << "run " << run << ": a host did not end";
    }
}

}  // namespace
}  // namespace lightnet::run_after_run_test
