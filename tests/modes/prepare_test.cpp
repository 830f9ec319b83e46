// Nodes that prepare: the same bytes however many places do it, and whoever is lost meanwhile.
#include <gmock/gmock.h>
#include <signal.h>

#include <atomic>
#include <optional>
#include <string>

#include "tests/modes/learning.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/hosts_in_memory.hpp"
#include "tests/support/process.hpp"

namespace lightnet::prepare_test {
namespace {

using namespace std::chrono_literals;
using namespace test;

TEST(Prepare, GivesTheBytesOfASerialRunInThreads) {
    const Learning learning;
    const auto expected = learning.serial();
    for (const std::uint32_t threads : {1u, 2u, 3u}) {
        const auto whole = plan(learning.network->graph, learning.registry, {}, {{"", threads}});
        EXPECT_EQ(learning.threaded(whole, {}), expected) << threads << " whole networks";
        EXPECT_EQ(learning.threaded(spread(learning.network->graph.nodes.size(), threads), {}), expected)
            << "spread over " << threads;
    }
}

TEST(Prepare, PassesOnWhatNodesSayOnce) {
    const Learning learning;
    learning.threaded(plan(learning.network->graph, learning.registry, {}, {{"", 3}}), {});
    EXPECT_THAT(learning.said, testing::ElementsAre(testing::MatchesRegex("first: .* points at 3 places"),
                                                    testing::MatchesRegex("second: .* points at 3 places")));
}

TEST(Prepare, GetsByWithOneFiberPerNodeAndBundlesOfOne) {
    const Learning learning;
    Tuning narrow;
    narrow.spare_fibers = 0;
    narrow.bundle = 1;
    narrow.credit = 1, narrow.credit_questions = 1;
    EXPECT_EQ(learning.threaded(spread(learning.network->graph.nodes.size(), 3), narrow), learning.serial());
}

TEST(Prepare, GivesTheBytesOfASerialRunOnHosts) {
    const Learning learning;
    const test::Folder folder;
    HostThread one(learning.registry, 2, folder.file("one")), two(learning.registry, 1, folder.file("two"));
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
    cluster.gather(test::slowdown * 20s, never);
    EXPECT_EQ(learning.networked(cluster), learning.serial());
    cluster.finish();
}

// Launcher and daemons, of which one is called and one dials in, and places of each that ask the other's.
TEST(Prepare, GivesTheBytesOfASerialRunOverATransportOfAnotherMake) {
    const Learning learning;
    const test::Folder folder;
    const auto hosts = std::make_shared<HostsInMemory>();
    const auto host = [&](const char* name, const char* listen, const char* join) {
        Host::Options options;
        options.listen = listen, options.join = join, options.name = name;
        options.places = 1;
        options.cache = folder.file(name);
        options.pass = folder.file("pass");
        options.transport = hosts;
        return options;
    };
    // No number of a machine: whoever opened a socket would find nobody.
    HostThread one(learning.registry, host("one", "tcp://192.0.2.1:1", ""));
    auto options = cluster_of(learning, {"tcp://192.0.2.1:1"});
    options.transport = hosts;
    options.listen = "tcp://192.0.2.9:1";
    options.pass = folder.file("pass");
    options.expected = {"two"};
    Cluster cluster(std::move(options));
    HostThread two(learning.registry, host("two", "", "tcp://192.0.2.9:1"));
    const std::atomic<bool> never{false};
    cluster.gather(test::slowdown * 20s, never);
    EXPECT_TRUE(cluster.ready("two") && cluster.ready("tcp://192.0.2.1:1"));
    EXPECT_EQ(learning.networked(cluster), learning.serial());
    cluster.finish();
    EXPECT_GT(hosts->sent(), 100u);
}

TEST(Prepare, GoesOnWhenAHostLeavesInTheMiddle) {
    const Learning learning;
    const auto expected = learning.serial();
    for (const int calls : {1, 5, 20}) {
        const test::Folder folder;
        HostThread one(learning.registry, 1, folder.file("one")), two(learning.registry, 1, folder.file("two"));
        const std::atomic<bool> never{false};
        Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
        cluster.gather(test::slowdown * 20s, never);
        int called = 0;
        EXPECT_EQ(learning.networked(cluster,
                                     [&] {
                                         if (++called == calls) two.leave();
                                     }),
                  expected);
        cluster.finish();
    }
}

// Has much done in little pieces, some of which take long or have large results.
class Bulky final : public LightOp {
public:
    explicit Bulky(const NodeContext&) {}
    void prepare(Services& services) override {
        const auto made = services.map<std::uint64_t>(60, [](std::size_t shard, std::vector<std::uint64_t>& out) {
            for (std::size_t i = 0; i < (shard % 20 == 3 ? 600'000 : shard); ++i) out.push_back(child(7, shard, i));
        });
        services.say(to_hex(content_hash(std::as_bytes(made.all()))) + " of " + std::to_string(made.shards()));
    }
    void light(std::span<const Query>, std::span<Rgb>) const override {}
};

TEST(Prepare, PutsShardsTogetherThoughPlacesDoOnlySomeOfThoseThatTheyAreAskedFor) {
    Kind bulky{.name = "Bulky", .help = "for tests", .run = {.prepares = true}};
    bulky.make_light = [](const NodeContext& here) { return std::make_unique<Bulky>(here); };
    auto kinds = standard_nodes();
    kinds.push_back(bulky);
    const auto nodes = std::vector{node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("bulk", "Bulky", {}),
                                   node("image", "RayTracer", {Value{NodeRef{"bulk"}}}, test::seen())};
    const Learning learning(Registry(std::move(kinds)), nodes);
    std::vector<std::string> expected;
    SerialRun(*learning.network).prepare("", nullptr, [&](const std::string& line) { expected.push_back(line); });
    ASSERT_EQ(expected.size(), 1u);
    learning.threaded(plan(learning.network->graph, learning.registry, {}, {{"", 3}}), {});
    EXPECT_EQ(learning.said, expected);
    const test::Folder folder;
    HostThread one(learning.registry, 1, folder.file("one")), two(learning.registry, 1, folder.file("two"));
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
    cluster.gather(test::slowdown * 20s, never);
    learning.networked(cluster);
    EXPECT_EQ(learning.said, expected);
    cluster.finish();
}

// A daemon in a process of its own, which can be killed.
class LearningDaemon {
public:
    explicit LearningDaemon(const std::string& cache) : process_({LIGHTNET_LEARNING_DAEMON, cache, "1"}) {
        EXPECT_TRUE(process_.wait_for("\n")) << process_.output();
    }
    std::string endpoint() const {
        const auto at = process_.output().find("tcp://");
        return process_.output().substr(at, process_.output().find('\n') - at);
    }
    void signal(int number) { process_.signal(number); }

private:
    test::Process process_;
};

TEST(Prepare, GetsOverTheLossOfAHostAtAnyMoment) {
    const Learning learning;
    const auto expected = learning.serial();
    for (const int number : {SIGKILL, SIGSTOP})
        for (const int calls : {1, 2, 4, 8, 16}) {
            const test::Folder folder;
            HostThread one(learning.registry, 1, folder.file("one"));
            LearningDaemon two(folder.file("two"));
            const std::atomic<bool> never{false};
            Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
            cluster.gather(test::slowdown * 20s, never);
            int called = 0;
            const auto hurt = [&] {
                if (++called == calls) two.signal(number);
            };
            EXPECT_EQ(learning.networked(cluster, hurt), expected) << "signal " << number << " at look " << calls;
            two.signal(SIGCONT);
            cluster.finish();
        }
}

TEST(Prepare, LetsAHostJoinInTheMiddle) {
    const Learning learning;
    const auto expected = learning.serial();
    const test::Folder folder;
    HostThread one(learning.registry, 1, folder.file("one"));
    std::optional<HostThread> two;
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(learning, {one.endpoint()}));
    cluster.gather(test::slowdown * 20s, never);
    EXPECT_EQ(learning.networked(cluster,
                                 [&] {
                                     if (!two) {
                                         two.emplace(learning.registry, 1, folder.file("two"));
                                         cluster.call(two->endpoint());
                                     }
                                 }),
              expected);
    cluster.finish();
}

TEST(Prepare, GoesOnWhenALineIsCutAgainAndAgain) {
    const Learning learning;
    const auto expected = learning.serial();
    const test::Folder folder;
    HostThread one(learning.registry, 1, folder.file("one")), two(learning.registry, 1, folder.file("two"));
    test::BadLine line(two.endpoint());
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(learning, {one.endpoint(), line.endpoint()}));
    cluster.gather(test::slowdown * 20s, never);
    const Scissors scissors(line, test::slowdown * 40ms);
    EXPECT_EQ(learning.networked(cluster), expected);
    cluster.finish();
}

}  // namespace
}  // namespace lightnet::prepare_test
