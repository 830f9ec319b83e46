// Preparing that is not wanted any more ends soon, and says meanwhile what it does.
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "core/base/unwanted.hpp"
#include "tests/modes/learning.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::cancel_test {
namespace {

using namespace std::chrono_literals;
using namespace test;
using Clock = std::chrono::steady_clock;

std::atomic<int> at_work{0};

/// Prepares for ever: in its prepare(), in a shard, in a value that places share, in pieces of that, or in one piece.
class Endless final : public LightOp {
public:
    explicit Endless(const NodeContext& here) : where_(here.text("where")) {}

    void prepare(Services& services) override {
        services.doing("goes on for ever", 3, 8);  // first: who sees it at work looks at what it does
        struct Busy {
            Busy() { ++at_work; }
            ~Busy() { --at_work; }
        } busy;
        const auto for_ever = [&services] {
            for (; true; std::this_thread::sleep_for(1ms)) services.look();
        };
        if (where_ == "prepare") for_ever();
        if (where_ == "shard") services.map<int>(4, [&](std::size_t, std::vector<int>&) { for_ever(); });
        if (where_ == "value")
            services.once<int>([&] {
                for_ever();
                return 0;
            });
        if (where_ == "pieces" || where_ == "piece")
            services.once<int>([&](Builders& builders) {
                builders.each(1'000'000, [&](std::size_t) {
                    if (where_ == "piece") for_ever();
                    std::this_thread::sleep_for(1ms);  // pieces so short need not look
                });
                return 0;
            });
    }
    void light(std::span<const Query>, std::span<Rgb>) const override {}

private:
    std::string where_;
};

Learning endless(const std::string& where) {
    Kind kind{.name = "Endless", .help = "for tests", .run = {.prepares = true}};
    kind.params = {{.name = "where", .type = ParamType::text, .help = "it works"}};
    kind.make_light = [](const NodeContext& here) { return std::make_unique<Endless>(here); };
    auto kinds = standard_nodes();
    kinds.push_back(kind);
    return {Registry(std::move(kinds)),
            {node("scene", "Scene", {Value{std::string("none.pbrt")}}),
             node("endless", "Endless", {}, {{"where", Value{where}}}),
             node("image", "RayTracer", {Value{NodeRef{"endless"}}}, seen())}};
}

// Whoever does not look is at work for ever.
void expect_nobody_at_work() {
    const auto end = Clock::now() + slowdown * 20s;
    while (at_work > 0 && Clock::now() < end) std::this_thread::sleep_for(1ms);
    EXPECT_EQ(at_work, 0);
}

class Cancel : public ::testing::TestWithParam<std::string> {};

TEST_P(Cancel, EndsASerialRun) {
    const Learning learning = endless(GetParam());
    std::atomic<bool> stop{false};
    SerialRun run(*learning.network, [&] {
        if (stop) throw Cancelled{};
    });
    std::vector<PrepareProgress> told;
    run.watch([&](const PrepareProgress& progress) { told.push_back(progress); });
    const std::jthread user([&] {
        while (at_work == 0) std::this_thread::sleep_for(1ms);
        stop = true;
    });
    EXPECT_THROW(run.prepare(""), Cancelled);
    expect_nobody_at_work();
    EXPECT_EQ(told.back(), (PrepareProgress{"endless", 1, 1, 3, 8, "goes on for ever"}));
}

// Until somebody is at work.
void begin(Coordinator& coordinator) {
    const auto end = Clock::now() + slowdown * 20s;
    while (at_work == 0 && Clock::now() < end) EXPECT_FALSE(coordinator.prepare(2ms));
    ASSERT_GT(at_work, 0);
}

TEST_P(Cancel, EndsPlacesInThreads) {
    const Learning learning = endless(GetParam());
    const Plan all = plan(learning.network->graph, learning.registry, {}, {{"", 3}});
    ThreadedRun run(learning.network, 1, all, {});
    Coordinator coordinator(learning.options(), run.carrier());
    coordinator.propose(all);
    begin(coordinator);
    EXPECT_EQ(with(coordinator.progress(), learning.network->activity->all()),
              (PrepareProgress{"endless", 1, 1, 3, 8, "goes on for ever"}));
    run.stop();
    expect_nobody_at_work();
}

TEST_P(Cancel, EndsPlacesOnHosts) {
    const Learning learning = endless(GetParam());
    const Folder folder;
    HostThread one(learning.registry, 2, folder.file("one")), two(learning.registry, 1, folder.file("two"));
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
    cluster.gather(slowdown * 20s, never);
    Coordinator coordinator(learning.options(), cluster);
    coordinator.propose(cluster.plan());
    begin(coordinator);
    const auto end = Clock::now() + slowdown * 20s;  // hosts tell it with their heartbeats
    while (cluster.doing().empty() && Clock::now() < end) coordinator.prepare(2ms);
    EXPECT_EQ(with(coordinator.progress(), cluster.doing()),
              (PrepareProgress{"endless", 1, 1, 3, 8, "goes on for ever"}));
    cluster.finish(300ms);
    expect_nobody_at_work();
}

INSTANTIATE_TEST_SUITE_P(WhereverANodeWorks, Cancel, ::testing::Values("prepare", "shard", "value", "pieces", "piece"),
                         [](const auto& where) { return where.param; });

TEST(Activity, TravelsAsText) {
    const Doings doings{{"caustics", {"builds its tree", 3, 8}}, {"cache", {"waits", 0, 0}}};
    EXPECT_EQ(doings_from(to_text(doings)), doings);
    EXPECT_EQ(doings_from(""), Doings{});
    EXPECT_EQ(doings_from("what is this\n3 8 caustics builds its tree\n9\n"),
              (Doings{{"caustics", {"builds its tree", 3, 8}}}));
}

}  // namespace
}  // namespace lightnet::cancel_test
