// Nothing is done twice without need: a run traces the rays of the serial run, wherever it is.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <map>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using Words = std::vector<std::string>;

// At full length it is an hour's rendering.
#ifdef LIGHTNET_LARGE
constexpr bool is_soak = true;
const std::string size = "384x384", samples = "512";
constexpr auto patience = std::chrono::minutes(20);
#else
constexpr bool is_soak = false;
const std::string size = "96x96", samples = "64";
constexpr auto patience = slowdown * std::chrono::seconds(60);
#endif

struct Where {
    std::string name;
    Words words;
    bool busy = false;  // others keep the processors busy
};

const std::vector<Where> wheres{
    {"two threads", {"--threads", "2"}},
    {"five threads", {"--threads", "5"}},
    {"two threads of a busy machine", {"--threads", "2"}, true},
    {"two local workers", {"--local-workers", "2"}},
    {"two local workers of a busy machine", {"--local-workers", "2"}, true},
};

class SameRays : public ::testing::TestWithParam<std::string> {};

TEST_P(SameRays, AreTracedWhereverTheRunIs) {
    const Folder folder;
    Words some{"--size", size, "--samples", samples, "--forget", "--progress", "none"};
    if (!is_soak) some.insert(some.end(), {"--tile", "16"});
    const auto rays = [&](Words more) {
        more.insert(more.end(), some.begin(), some.end());
        const auto run = launch(graph_file(GetParam()), folder, more, patience);
        EXPECT_EQ(run.code, 0) << run.said;
        return std::pair{counter(run.report, "rays"), run.picture};
    };
    const auto [serial, picture] = rays({"--threads", "1"});
    ASSERT_GT(serial, 1e5);
    for (const auto& where : wheres) {
        std::atomic<bool> over{false};
        std::vector<std::jthread> others;
        for (int i = 0; where.busy && i < 4; ++i)
            others.emplace_back([&over] {
                while (!over.load(std::memory_order_relaxed)) {
                }
            });
        const auto [traced, same] = rays(where.words);
        over = true;
        EXPECT_TRUE(same == picture) << where.name;
        EXPECT_GE(traced, serial) << where.name;
        EXPECT_LE(traced, 1.01 * serial) << where.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Graphs, SameRays, ::testing::Values("cornell.lua", "path_all.lua", "direct.lua"),
                         [](const auto& graph) { return graph.param.substr(0, graph.param.find('.')); });

}  // namespace
}  // namespace lightnet::test
