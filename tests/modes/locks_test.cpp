// Named locks in a whole run.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/error.hpp"
#include "tests/modes/learning.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::locks_test {
namespace {

using namespace std::chrono_literals;
using namespace test;

std::atomic<int> holders{0}, most_holders{0}, times_held{0};

// Adds nothing; looks how many hold the lock with it.
class Rare final : public LightOp {
public:
    explicit Rare(const NodeContext& here) : inputs_(here.inputs()), locks_(here.locks()), asks_(here.flag("asks")) {}

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        const Part part = ask(inputs_, 0, questions);
        const auto held = locks_.hold("device");
        if (asks_) ask(inputs_, 0, questions);
        const int now = ++holders;
        most_holders = std::max(most_holders.load(), now);
        ++times_held;
        std::this_thread::sleep_for(50us);
        --holders;
        add(part, answers);
    }

private:
    Inputs inputs_;
    Locks& locks_;
    bool asks_;
};

Registry with_rare() {
    auto kinds = standard_nodes();
    Kind rare{.name = "Rare", .help = "needs what there is one of", .inputs = {1, 1}};
    rare.run.locks = true;
    rare.params = {{.name = "asks", .type = ParamType::flag, .help = "with the lock in hand", .initial = Value{false}}};
    rare.make_light = [](const NodeContext& here) { return std::make_unique<Rare>(here); };
    kinds.push_back(std::move(rare));
    return Registry(std::move(kinds));
}

std::vector<Node> rare_nodes(bool asks) {
    const auto ref = [](const char* name) { return Value{NodeRef{name}}; };
    return {node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("direct", "DirectLighting", {}),
            node("rare", "Rare", {ref("direct")}, {{"asks", Value{asks}}}),
            node("image", "RayTracer", {ref("rare")}, seen())};
}

TEST(Locks, AreHeldByOneCallInTheWholeRun) {
    const Learning rare(with_rare(), rare_nodes(false));
    const auto expected = rare.serial();
    most_holders = 0, times_held = 0;
    EXPECT_EQ(rare.threaded(plan(rare.network->graph, rare.registry, {}, {{"", 3}}), {}), expected);
    EXPECT_GE(times_held, 6);
    EXPECT_EQ(most_holders, 1);

    const test::Folder folder;
    HostThread one(rare.registry, 2, folder.file("one")), two(rare.registry, 1, folder.file("two"));
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(rare, {one.endpoint(), two.endpoint()}));
    cluster.gather(test::slowdown * 20s, never);
    EXPECT_EQ(rare.networked(cluster), expected);
    EXPECT_EQ(most_holders, 1);
    cluster.finish();
}

TEST(Locks, AreGivenOnWhenALineIsCutAgainAndAgain) {
    const Learning rare(with_rare(), rare_nodes(false));
    const auto expected = rare.serial();
    const test::Folder folder;
    HostThread one(rare.registry, 2, folder.file("one")), two(rare.registry, 2, folder.file("two"));
    test::BadLine line(two.endpoint());
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(rare, {one.endpoint(), line.endpoint()}));
    cluster.gather(test::slowdown * 20s, never);
    const Scissors scissors(line, test::slowdown * 40ms);
    EXPECT_EQ(rare.networked(cluster), expected) << "nobody may wait for ever";
    cluster.finish();
}

TEST(Locks, MayNotBeHeldWhileAsking) {
    const Learning rare(with_rare(), rare_nodes(true));
    try {
        rare.serial();
        FAIL() << "nobody noticed";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("it asks an input while it holds the lock 'device'"));
    }
}

}  // namespace
}  // namespace lightnet::locks_test
