// Nodes whose replicas share what they have prepared by sectors of the scene: the bytes are those of a whole one.
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <optional>
#include <string>

#include "core/network/light/services.hpp"
#include "core/scene/scene.hpp"
#include "tests/modes/daemons.hpp"
#include "tests/modes/learning.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::sharded_test {
namespace {

using namespace std::chrono_literals;
using namespace test;

using Shards = std::map<std::string, std::uint32_t>;

std::map<std::string, Value> photons(const char* paths, double ways, double gather) {
    return {{"paths", Value{std::string(paths)}},
            {"photons", Value{ways}},
            {"gather", Value{gather}},
            {"aim", Value{gather == 0}}};
}

// A map by number, one by radius, and a cache that asks the first from everywhere.
std::vector<Node> mapped_nodes() {
    const auto ref = [](const char* name) { return Value{NodeRef{name}}; };
    return {node("scene", "Scene", {Value{std::string("none.pbrt")}}),
            node("number", "PhotonMap", {}, photons("all", 60000, 30)),
            node("radius", "PhotonMap", {}, photons("caustic", 60000, 0)),
            node("soft", "IrradianceCache", {ref("number")},
                 {{"rays", Value{32.0}}, {"accuracy", Value{1.0}}, {"stride", Value{8.0}}}),
            node("both", "Combine", {ref("number"), ref("radius"), ref("soft")}),
            node("image", "RayTracer", {ref("both")}, seen())};
}

Learning mapped(const Shards& shards = {}) {
    return {Registry(standard_nodes()), mapped_nodes(), shards, "glass_ball.pbrt"};
}

// Each place has all but the sectors, of which each has its share.
Plan share(const Graph& graph, std::uint32_t places) {
    Plan plan;
    for (std::uint32_t i = 0; i < places; ++i) plan.places.push_back({"", i});
    plan.places_of.resize(graph.nodes.size());
    for (std::size_t node = 1; node < graph.nodes.size(); ++node) {
        const auto* sector = sector_at(graph, node);
        if (sector) plan.places_of[node] = {(sector->index + sector->node) % places};
        for (std::uint32_t i = 0; !sector && sectors_of(graph, node).empty() && i < places; ++i)
            plan.places_of[node].push_back(i);
    }
    return plan;
}

TEST(Sharded, GivesTheBytesOfAWholeMapInThreads) {
    const Learning whole = mapped();
    const auto expected = whole.serial();
    EXPECT_EQ(whole.threaded(share(whole.network->graph, 2), {}), expected) << "replicated";
    EXPECT_EQ(mapped({{"number", 2}}).serial(), expected) << "in one thread nothing is shared out";
    for (const auto& [sectors, places] : {std::pair(2u, 3u), {3u, 2u}, {5u, 3u}}) {
        const Learning cut = mapped({{"number", sectors}, {"radius", sectors}});
        EXPECT_EQ(cut.threaded(share(cut.network->graph, places), {}), expected)
            << sectors << " sectors at " << places << " places";
    }
}

TEST(Sharded, GetsByWithOneFiberPerNodeAndBundlesOfOne) {
    Tuning narrow;
    narrow.spare_fibers = 0;
    narrow.bundle = 1;
    narrow.credit = 1, narrow.credit_questions = 1;
    const Learning cut = mapped({{"number", 3}});
    EXPECT_EQ(cut.threaded(share(cut.network->graph, 2), narrow), mapped().serial());
}

// Light of many small lamps that hang in the room: what is sharded, with more pieces than go at one time, and sums that
// depend on the order of their parts.
class Fireflies final : public LightOp {
public:
    explicit Fireflies(const NodeContext& here) : scene_(here.scene()) {}

    void prepare(Services& services) override {
        const auto hatch = [&](std::size_t shard, std::vector<Vec3>& out) {
            for (std::size_t i = 0; i < 20; ++i) out.push_back(place(shard * 20 + i));
        };
        flies_ = services.map_near<Vec3>(150, reach, hatch, [](Vec3 fly) { return fly; });
        std::size_t count = 0;
        for (const auto& some : flies_) count += some.size();
        services.say(std::to_string(count) + " flies");
    }

    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) {
            const Vec3 at = scene_.surface(questions[i]).position;
            for (const auto& some : flies_)
                for (const Vec3 fly : some)
                    if (const float d = length_squared(fly - at); d <= reach * reach)
                        answers[i] += Rgb{1 - d / (reach * reach), 0.1f, d / 7000};
        }
    }

    // In the Cornell box, which is 550 high; most of them in a corner.
    static Vec3 place(std::size_t fly) {
        const auto part = [&](Key i) { return float(child(11, fly, i) >> 40) / float(1 << 24); };
        const float scale = fly % 3 ? 200 : 550;
        return {scale * part(1), scale * part(2), scale * part(3)};
    }

private:
    static constexpr float reach = 30;
    const Scene& scene_;
    std::vector<Mapped<Vec3>> flies_;
};

Registry with_fireflies() {
    Kind kind{.name = "Fireflies", .help = "small lights"};
    kind.run.prepares = true;
    kind.run.landmarks = [](const NodeContext&) {
        std::vector<Vec3> landmarks;
        for (std::size_t fly = 0; fly < 1000; ++fly) landmarks.push_back(Fireflies::place(fly));
        return landmarks;
    };
    kind.make_light = [](const NodeContext& here) { return std::make_unique<Fireflies>(here); };
    auto kinds = standard_nodes();
    kinds.push_back(std::move(kind));
    return Registry(std::move(kinds));
}

std::vector<Node> firefly_nodes() {
    return {node("scene", "Scene", {Value{std::string("none.pbrt")}}), node("flies", "Fireflies", {}),
            node("image", "RayTracer", {Value{NodeRef{"flies"}}}, seen())};
}

TEST(Sharded, SendsResultsInSeveralLotsAndEachPlaceItsOwnAlone) {
    const Learning whole(with_fireflies(), firefly_nodes());
    const auto expected = whole.serial();
    EXPECT_EQ(whole.threaded(share(whole.network->graph, 4), {}), expected);
    const auto all = whole.counted.prepared_bytes;
    const Learning cut(with_fireflies(), firefly_nodes(), {{"flies", 4}});
    EXPECT_EQ(cut.threaded(share(cut.network->graph, 4), {}), expected);
    EXPECT_EQ(all % 4, 0u);
    EXPECT_GT(cut.counted.prepared_bytes, all / 4) << "each at least a quarter, and what is near to that";
    EXPECT_LT(cut.counted.prepared_bytes, all / 2);
}

TEST(Sharded, SaysForEachSectorWhatItsNodeSaysAndHowMuchItTookIn) {
    const Learning cut(with_fireflies(), firefly_nodes(), {{"flies", 2}});
    cut.threaded(share(cut.network->graph, 2), {});
    EXPECT_THAT(cut.said, testing::UnorderedElementsAre(
                              testing::MatchesRegex("flies#1: .* flies"), testing::MatchesRegex("flies#2: .* flies"),
                              "flies#1: took in 1 MB for sector 1 of 2", "flies#2: took in 1 MB for sector 2 of 2"));
}

// A result cache in memory, and how often it was asked for what it has.
class MemoryCache final : public ResultCache {
public:
    Result find(const Hash& recipe) const override {
        const auto found = kept_.find(recipe);
        if (found == kept_.end()) return {};
        ++found_;
        return {content_hash(found->second), std::make_shared<const std::vector<std::byte>>(found->second)};
    }
    void keep(const Hash& recipe, const Result& result) override { kept_[recipe] = *result.bytes; }
    std::size_t size() const { return kept_.size(); }
    std::size_t found() const { return found_; }
    void forget() { kept_.clear(); }

private:
    std::map<Hash, std::vector<std::byte>> kept_;
    mutable std::size_t found_ = 0;
};

std::vector<Pixels> prepared_with(const Learning& learning, const Plan& plan, ResultCache& cache) {
    ThreadedRun run(learning.network, 1, plan, {});
    auto options = learning.options();
    options.cache = &cache;
    Coordinator coordinator(options, run.carrier());
    coordinator.propose(plan);
    EXPECT_TRUE(coordinator.prepare(slowdown * 30s));
    auto pixels = learning.render(coordinator);
    run.stop();
    return pixels;
}

TEST(Sharded, IsFoundAgainByTheNextRunAndNotByOneWithOtherSectors) {
    MemoryCache cache;
    const auto run = [&](std::uint32_t sectors) {
        const Learning cut(with_fireflies(), firefly_nodes(), {{"flies", sectors}});
        return prepared_with(cut, share(cut.network->graph, 2), cache);
    };
    const auto expected = Learning(with_fireflies(), firefly_nodes()).serial();
    EXPECT_EQ(run(2), expected);
    EXPECT_EQ(cache.size(), 2u * 3u) << "two sectors, three lots";
    EXPECT_EQ(cache.found(), 0u);
    EXPECT_EQ(run(2), expected);
    EXPECT_EQ(cache.found(), 6u);
    EXPECT_EQ(run(3), expected);
    EXPECT_EQ(cache.size(), 2u * 3u + 3u * 3u);
}

// ---- on hosts ----

Hosts hosts_of(const std::vector<std::string>& endpoints) {
    Hosts hosts{"hosts.lua", {}, {}, {{"", "sharded", {"hosts.lua", 1}}}};
    for (const auto& endpoint : endpoints) hosts.hosts.push_back({endpoint, {}, 0, {"hosts.lua", 2}});
    return hosts;
}

Cluster::Options sharded_cluster(const Learning& learning, const std::vector<std::string>& endpoints) {
    auto options = cluster_of(learning, endpoints);
    options.plan = [&learning, hosts = hosts_of(endpoints)](const std::vector<HostOffer>& offers) {
        return plan(learning.network->graph, learning.registry, hosts, offers);
    };
    return options;
}

TEST(Sharded, GivesTheBytesOfAWholeMapOnHosts) {
    const Learning cut = mapped({{"number", 3}, {"radius", 3}});
    const test::Folder folder;
    HostThread one(cut.registry, 2, folder.file("one")), two(cut.registry, 1, folder.file("two")),
        three(cut.registry, 1, folder.file("three"));
    const std::atomic<bool> never{false};
    Cluster cluster(sharded_cluster(cut, {one.endpoint(), two.endpoint(), three.endpoint()}));
    cluster.gather(test::slowdown * 20s, never);
    EXPECT_EQ(cut.networked(cluster), mapped().serial());
    cluster.finish();
}

TEST(Sharded, IsMadeElsewhereWhenAHostLeavesWhileItPrepares) {
    const auto expected = Learning(with_fireflies(), firefly_nodes()).serial();
    for (const int calls : {1, 2, 4, 8}) {
        const Learning cut(with_fireflies(), firefly_nodes(), {{"flies", 3}});
        const test::Folder folder;
        HostThread one(cut.registry, 1, folder.file("one")), two(cut.registry, 1, folder.file("two"));
        const std::atomic<bool> never{false};
        Cluster cluster(sharded_cluster(cut, {one.endpoint(), two.endpoint()}));
        cluster.gather(test::slowdown * 20s, never);
        int called = 0;
        EXPECT_EQ(cut.networked(cluster,
                                [&] {
                                    if (++called == calls) two.leave();
                                }),
                  expected)
            << "left at look " << calls;
        cluster.finish();
    }
}

// Everything as users run it. `photons` of the whole network is sharded over three daemons, one of which is killed.
class ShardedRun : public ::testing::Test {
protected:
    void SetUp() override {
        std::ofstream(graph) << "scene = Scene { '" << graph_file("glass_ball.pbrt") << "' }\n"
                             << "photons = PhotonMap { paths = 'all', photons = 200000, gather = 50 }\n"
                             << "gather = FinalGather { photons, rays = 4 }\n"
                             << "both = Combine { photons, gather }\n"
                             << "image = RayTracer { both, scene = scene, samples = 256, film = { 48, 48 } }\n";
    }
    std::string hosts_file(const std::vector<const Daemon*>& daemons) {
        std::ofstream file(folder / "hosts.lua");
        file << "layout { photons = 'sharded' }\n";
        for (const auto* daemon : daemons) file << "place '" << daemon->endpoint << "' { places = 1 }\n";
        return folder / "hosts.lua";
    }
    const std::vector<std::string> words{"--progress", "json",      "--tile",
                                         "16",         "--samples", std::to_string(64 / slowdown)};
    Folder folder;
    std::string graph = folder / "sharded.lua";
    std::filesystem::path out = folder / "picture.exr";
};

TEST_F(ShardedRun, ChangesNoByteWhenADaemonIsKilledInTheMiddle) {
    auto alone = words;
    alone.insert(alone.end(), {"--threads", "2"});
    const auto expected = launch(graph, folder, alone);
    ASSERT_FALSE(expected.picture.empty()) << expected.said;
    for (const bool kill : {false, true}) {
        const Daemon one(folder), two(folder), three(folder);
        auto more = words;
        more.insert(more.end(), {"--hosts", hosts_file({&one, &two, &three})});
        Process run(launch_words(graph, out, more));
        if (kill) {
            ASSERT_TRUE(run.wait_for("\"event\":\"progress\"")) << run.output();
            two.process->signal(SIGKILL);
        }
        const auto end = finish(run, out);
        ASSERT_EQ(end.code, 0) << end.said;
        EXPECT_TRUE(end.picture == expected.picture) << "the bytes differ\n" << end.said;
        EXPECT_EQ(kill, counter(end.report, "asked_again") > 0) << end.report;
        EXPECT_NE(end.report.find("\"photons#1\""), std::string::npos) << end.report;
    }
}

}  // namespace
}  // namespace lightnet::sharded_test
