// Nodes that prepare: the same bytes however many places do it, and whoever is lost meanwhile.
#include <gmock/gmock.h>

#include <signal.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <thread>

#include "core/film/film.hpp"
#include "core/graph/check.hpp"
#include "core/runtime/conductor.hpp"
#include "core/runtime/fingerprint.hpp"
#include "core/runtime/job.hpp"
#include "core/runtime/serial.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/learner.hpp"
#include "tests/support/process.hpp"
#include "tests/support/slowdown.hpp"
#include "transport/cluster.hpp"
#include "transport/host.hpp"
#include "transport/threaded_run.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;
using Pixels = std::vector<Rgb>;

constexpr std::uint32_t width = 24, height = 16, samples = 4;

Node node(std::string name, std::string kind, std::vector<Value> entries, std::map<std::string, Value> params = {}) {
    return {std::move(name), std::move(kind), std::move(entries), std::move(params), {"test.lua", 1}};
}

// Operators spread over places, round about.
Plan spread(std::size_t nodes, std::uint32_t places) {
    Plan plan;
    for (std::uint32_t i = 0; i < places; ++i) plan.places.push_back({"", i});
    plan.places_of.resize(nodes);
    for (std::size_t node = 1; node < nodes; ++node)
        plan.places_of[node] = {static_cast<std::uint32_t>(node % places),
                                static_cast<std::uint32_t>((node + 1) % places)};
    if (places == 1)
        for (auto& at : plan.places_of) at = {0};
    return plan;
}

std::map<std::string, Value> seen() {
    return {{"scene", Value{NodeRef{"scene"}}},
            {"film", Value{Table{{Value{double(width)}, Value{double(height)}}, {}}}}};
}

// image ← both ← (first ← direct), (second ← first): one learner asks another.
std::vector<Node> learning_nodes() {
    const auto ref = [](const char* name) { return Value{NodeRef{name}}; };
    return {node("scene", "Scene", {Value{std::string("none.pbrt")}}),
            node("direct", "DirectLighting", {}),
            node("first", "Learner", {ref("direct")}, {{"stride", Value{4.0}}}),
            node("second", "Learner", {ref("first")}, {{"stride", Value{2.0}}}),
            node("both", "Combine", {ref("first"), ref("second")}),
            node("image", "RayTracer", {ref("both")}, seen())};
}

// A network, and the ways to render it.
class Learning {
public:
    Learning() : Learning(test::with_learner(), learning_nodes()) {}
    Learning(Registry kinds, std::vector<Node> nodes) : registry(std::move(kinds)) {
        job.graph = check({"test.lua", std::move(nodes)}, registry);
        job.scene = std::string(LIGHTNET_SOURCE_DIR) + "/graphs/cornell_box.pbrt";
        job.isa = usual_isa();
        job.width = width, job.height = height;
        DiskFiles disk;
        network = build_network(job, registry, disk);
        for (const auto& [path, bytes] : disk.seen()) {
            job.files.push_back({path, content_hash(*bytes), bytes->size()});
            files[path] = bytes;
        }
        tiles = tiles_of(width, height, 8, samples);
    }

    std::vector<Pixels> serial() const {
        SerialRun run(*network);
        run.prepare("");
        std::vector<Pixels> pixels;
        for (const auto& tile : tiles) pixels.push_back(run.render(tile));
        return pixels;
    }

    // On hosts, whose carrier this is. `meanwhile` is called often while they prepare.
    std::vector<Pixels> networked(Cluster& cluster, const std::function<void()>& meanwhile = {}) const {
        Conductor conductor(options(), cluster);
        conductor.propose(cluster.plan());
        const auto end = std::chrono::steady_clock::now() + test::slowdown * 30s;
        while (!conductor.prepare(2ms)) {
            if (meanwhile) meanwhile();
            if (std::chrono::steady_clock::now() > end) {
                ADD_FAILURE() << "preparing hangs: " << conductor.progress();
                return {};
            }
        }
        return render(conductor);
    }

    std::vector<Pixels> threaded(const Plan& plan, PlaceRules rules) const {
        ThreadedRun run(network, 1, plan, rules);
        Conductor conductor(options(), run.carrier());
        conductor.propose(plan);
        EXPECT_TRUE(conductor.prepare(test::slowdown * 30s)) << "preparing hangs: " << conductor.progress();
        EXPECT_EQ(conductor.in_force(), plan);
        EXPECT_LE(said.size(), 2u) << "each line once, however many places say it";
        auto pixels = render(conductor);
        run.stop();
        return pixels;
    }

    Conductor::Options options() const {
        Conductor::Options options;
        said.clear();
        options.say = [this](const std::string& line) { said.push_back(line); };
        options.run = 1;
        options.graph = &network->graph;
        options.registry = &registry;
        options.width = static_cast<std::uint32_t>(network->layers.film.size());
        return options;
    }

    std::vector<Pixels> render(Conductor& conductor) const {
        std::vector<Pixels> pixels(tiles.size());
        MasterRenderer::Job work;
        work.run = 1;
        work.image = static_cast<std::uint32_t>(renderer_of(network->graph, registry));
        work.width = static_cast<std::uint32_t>(network->layers.film.size());
        work.tiles = tiles;
        MasterRenderer master(work, conductor, [&](const Tile& tile, std::span<const Rgb> colours) {
            const auto index = std::find(tiles.begin(), tiles.end(), tile) - tiles.begin();
            pixels[static_cast<std::size_t>(index)].assign(colours.begin(), colours.end());
        });
        master.use(conductor.in_force());
        EXPECT_TRUE(master.work(test::slowdown * 30s)) << "rendering hangs";
        return pixels;
    }

    Registry registry;
    Job job;
    std::map<std::string, Bytes> files;
    std::shared_ptr<const Network> network;
    std::vector<Tile> tiles;
    mutable std::vector<std::string> said;  // by the nodes of the last run
};

// A daemon in a thread of this process: its nodes may be those of a test.
class HostThread {
public:
    HostThread(const Registry& registry, const std::string& cache, std::uint32_t places)
        : host_(options(cache, places), registry), thread_([this] { host_.serve(stop_); }) {}
    ~HostThread() { stop_ = true; }
    static Host::Options options(const std::string& cache, std::uint32_t places) {
        Host::Options options;
        options.cache = cache;
        options.places = places;
        return options;
    }
    void leave() { stop_ = true; }
    std::string endpoint() const { return host_.endpoint(); }

private:
    std::atomic<bool> stop_{false};
    Host host_;
    std::jthread thread_;
};

Cluster::Options cluster_of(const Learning& learning, std::vector<std::string> endpoints) {
    Cluster::Options options;
    options.run = 1;
    options.endpoints = std::move(endpoints);
    options.job = learning.job;
    options.files = learning.files;
    options.plan = [&learning](const std::vector<HostOffer>& offers) {
        std::uint32_t places = 0;
        Plan all = plan(learning.network->graph, learning.registry, {}, offers);
        places = static_cast<std::uint32_t>(all.places.size());
        all.places_of = spread(all.places_of.size(), places).places_of;
        return all;
    };
    return options;
}

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
    PlaceRules narrow;
    narrow.spare_fibers = 0;
    narrow.bundles.questions = 1;
    narrow.credit = {1, 1};
    EXPECT_EQ(learning.threaded(spread(learning.network->graph.nodes.size(), 3), narrow), learning.serial());
}

TEST(Prepare, GivesTheBytesOfASerialRunOnHosts) {
    const Learning learning;
    const test::Folder folder;
    HostThread one(learning.registry, folder.file("one"), 2), two(learning.registry, folder.file("two"), 1);
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
    cluster.gather(test::slowdown * 5s, never);
    EXPECT_EQ(learning.networked(cluster), learning.serial());
    cluster.finish();
}

TEST(Prepare, GoesOnWhenAHostLeavesInTheMiddle) {
    const Learning learning;
    const auto expected = learning.serial();
    for (const int calls : {1, 5, 20}) {
        const test::Folder folder;
        HostThread one(learning.registry, folder.file("one"), 1), two(learning.registry, folder.file("two"), 1);
        const std::atomic<bool> never{false};
        Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
        cluster.gather(test::slowdown * 5s, never);
        int called = 0;
        EXPECT_EQ(learning.networked(cluster,
                                     [&] {
                                         if (++called == calls) two.leave();
                                     }),
                  expected);
        cluster.finish();
    }
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
            HostThread one(learning.registry, folder.file("one"), 1);
            LearningDaemon two(folder.file("two"));
            const std::atomic<bool> never{false};
            Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
            cluster.gather(test::slowdown * 5s, never);
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
    HostThread one(learning.registry, folder.file("one"), 1);
    std::optional<HostThread> two;
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(learning, {one.endpoint()}));
    cluster.gather(test::slowdown * 5s, never);
    EXPECT_EQ(learning.networked(cluster,
                                 [&] {
                                     if (!two) {
                                         two.emplace(learning.registry, folder.file("two"), 1);
                                         cluster.call(two->endpoint());
                                     }
                                 }),
              expected);
    cluster.finish();
}

// ---- locks ----------------------------------------------------------------------------------------------------------

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
    Kind rare{.name = "Rare", .help = "needs what there is one of", .least_inputs = 1, .most_inputs = 1};
    rare.locks = true;
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
    HostThread one(rare.registry, folder.file("one"), 2), two(rare.registry, folder.file("two"), 1);
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(rare, {one.endpoint(), two.endpoint()}));
    cluster.gather(test::slowdown * 5s, never);
    EXPECT_EQ(rare.networked(cluster), expected);
    EXPECT_EQ(most_holders, 1);
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
}  // namespace lightnet
