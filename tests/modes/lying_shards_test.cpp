// A host whose shards of preparing are false.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <vector>

#include "tests/modes/learning.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::lying_shards_test {
namespace {

using namespace std::chrono_literals;
using namespace test;

// Adds up what its shards found, which is always the same where nobody lies.
class Counting final : public LightOp {
public:
    explicit Counting(bool lies) : lies_(lies) {}
    void prepare(Services& services) override {
        const auto numbers =
            services.map<std::uint64_t>(60, [this](std::size_t shard, std::vector<std::uint64_t>& out) {
                out.push_back(shard + (lies_ && shard % 2 == 0));
            });
        for (const auto number : numbers) sum_ += static_cast<float>(number);
    }
    void light(std::span<const Query>, std::span<Rgb> answers) const override {
        for (auto& answer : answers) answer = {sum_, sum_, sum_};
    }

private:
    bool lies_;
    float sum_ = 0;
};

Registry with_counting(bool lies) {
    auto kinds = standard_nodes();
    Kind counting{.name = "Counting", .help = "counts"};
    counting.run.prepares = true;
    counting.make_light = [lies](const NodeContext&) { return std::make_unique<Counting>(lies); };
    kinds.push_back(std::move(counting));
    return Registry(std::move(kinds));
}

std::vector<Node> counting_nodes() {
    return {node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("counting", "Counting", {}),
            node("image", "RayTracer", {Value{NodeRef{"counting"}}}, seen())};
}

std::optional<Failure> lie_among(std::uint32_t millionths, bool lies) {
    Learning learning{with_counting(false), counting_nodes()};
    learning.verify = millionths;
    const Folder folder;
    const Registry honest = with_counting(false), liar = with_counting(lies);
    HostThread one(honest, 1, folder.file("one")), two(liar, 1, folder.file("two")),
        three(honest, 1, folder.file("three"));
    auto options = cluster_of(learning, {one.endpoint(), two.endpoint(), three.endpoint()});
    options.plan = [&](const std::vector<HostOffer>& offers) {
        return plan(learning.network->graph, learning.registry, {}, offers);
    };
    Cluster cluster(std::move(options));
    const std::atomic<bool> never{false};
    cluster.gather(slowdown * 20s, never);
    EXPECT_FALSE(learning.networked(cluster).empty());
    auto lie = cluster.lie();
    cluster.finish();
    if (lie && lie->host == two.endpoint()) lie->host = "two";
    return lie;
}

TEST(LyingShards, AreFoundWhereTheyAreAskedOfASecondHost) {
    const auto lie = lie_among(1'000'000, true);
    ASSERT_TRUE(lie);
    EXPECT_EQ(lie->host, "two") << lie->why;
    EXPECT_FALSE(lie_among(0, true)) << "nobody looks";
    EXPECT_FALSE(lie_among(1'000'000, false));
}

}  // namespace
}  // namespace lightnet::lying_shards_test
