// A launcher, its hosts, their places and the film in one thread, on lines and a clock that come from a seed: whatever
// is lost, doubled, late, cut, killed, told to stop or moved, at any event, the picture has the bytes of a serial one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/master/coordinator.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/master/tiles_by_pass.hpp"
#include "core/run/serial/serial.hpp"
#include "tests/modes/one_thread_cluster.hpp"
#include "tests/support/learner.hpp"
#include "tests/support/slowdown.hpp"

namespace lightnet::one_thread_test {
namespace {

using namespace test;

constexpr std::uint32_t size = 16, samples = 17;
constexpr double most_seconds = 3600;  // of simulated time, for each part of a run

Node node(std::string name, std::string kind, std::vector<Value> entries, std::map<std::string, Value> params = {}) {
    return {std::move(name), std::move(kind), std::move(entries), std::move(params), {"test.lua", 1}};
}
Value ref(const char* name) { return Value{NodeRef{name}}; }

Node image_of(const char* light) {
    return node("image", "RayTracer", {ref(light)},
                {{"scene", ref("scene")}, {"film", Value{Table{{Value{double(size)}, Value{double(size)}}, {}}}}});
}
Node the_scene() { return node("scene", "Scene", {Value{std::string("none.pbrt")}}); }

/// A network, and the picture that one thread makes of it.
struct Pictured {
    explicit Pictured(std::vector<Node> nodes) {
        job.graph = check({"test.lua", std::move(nodes)}, registry);
        job.scene = std::string(LIGHTNET_SOURCE_DIR) + "/graphs/glass_ball.pbrt";
        job.isa = usual_isa();
        job.width = job.height = size;
        DiskFiles disk;
        network = build_network(job, registry, disk);
        format.width = format.height = size;
        format.layers = network->layers.film;
        format.samples = samples;
        tiles = tiles_of(format, 4);
        SerialRun run(*network);
        run.prepare("");
        Film film(format);
        for (const auto& tile : tiles) {
            pixels.push_back(run.render(tile));
            film.add(tile, pixels.back());
        }
        expected = film.picture();
        for (const auto at : preparing_nodes(network->graph, registry))
            if (!network->renewed[at]) prepared[at] = run.last_result(at);
    }

    Registry registry = with_learner();
    Job job;
    std::shared_ptr<const Network> network;
    FilmFormat format;
    std::vector<Tile> tiles;
    std::vector<std::vector<Rgb>> pixels;  // of each
    Picture expected;
    std::map<std::size_t, Bytes> prepared;  // by node: the result of its last call
};

// Two that learn, one of which asks the other; photons that one takes as they are; and photons that are new in each
// pass.
const Pictured& pictured(std::uint64_t number) {
    static const Pictured learners({the_scene(), node("direct", "DirectLighting", {}),
                                    node("first", "Learner", {ref("direct")}, {{"stride", Value{4.0}}}),
                                    node("second", "Learner", {ref("first")}, {{"stride", Value{2.0}}}),
                                    node("both", "Combine", {ref("first"), ref("second")}), image_of("both")});
    static const Pictured takers(
        {the_scene(), node("direct", "DirectLighting", {}),
         node("photons", "PhotonMap", {}, {{"photons", Value{300.0}}, {"gather", Value{20.0}}}),
         node("resting", "PhotonIrradiance", {}, {{"of", ref("photons")}}),
         node("learned", "Learner", {ref("direct")}, {{"stride", Value{4.0}}}),
         node("both", "Combine", {ref("learned"), ref("resting")}), image_of("both")});
    static const Pictured progressive({the_scene(), node("direct", "DirectLighting", {}),
                                       node("photons", "ProgressivePhotonMapping", {},
                                            {{"paths", Value{std::string("caustic")}}, {"photons", Value{200.0}}}),
                                       node("soft", "Learner", {ref("photons")}, {{"stride", Value{4.0}}}),
                                       node("all", "Combine", {ref("direct"), ref("photons"), ref("soft")}),
                                       image_of("all")});
    static const Pictured* const all[] = {&learners, &takers, &progressive};
    return *all[number % 3];
}

struct Told {
    Picture picture;
    std::uint64_t story = 0, events = 0;
    std::map<Mishap::Kind, std::size_t> happened;
    std::pair<std::size_t, std::size_t> fetched;  // results: from other hosts, and from the launcher after all
};

// What must hold of every run is thrown.
Told play(const OneThreadWorld& world, const Pictured& what) {
    SimulatedClock clock(world.seed);
    OneThreadCluster cluster(world, clock, *what.network);
    cluster.gather();
    Coordinator::Options options;
    options.run = 1;
    options.graph = &what.network->graph;
    options.registry = &what.registry;
    options.width = static_cast<std::uint32_t>(colours_of(what.network->layers));
    options.let_go_after = world.let_go_after;
    Coordinator coordinator(std::move(options), cluster);
    coordinator.propose(cluster.plan());
    const auto most = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * most_seconds));
    const auto expect = [&](bool holds, const auto& else_why) {
        for (const auto& fault : cluster.faults()) throw Error("a host is blamed", fault);
        if (!holds) throw Error(else_why() + cluster.standing());
    };

    Film film(what.format);
    TilesByPass passes(what.network->graph, what.registry, what.tiles);
    while (!passes.empty()) {
        MasterRenderer::Job work;
        work.run = 1;
        work.image = static_cast<std::uint32_t>(renderer_of(what.network->graph, what.registry));
        work.width = static_cast<std::uint32_t>(what.format.colours());
        work.tiles = passes.begin_next();
        work.check_answers = true;
        coordinator.begin_pass(passes.pass());
        expect(coordinator.prepare(most), [&] { return "preparing hangs: " + to_string(coordinator.progress()); });
        for (const auto& [at, result] : what.prepared) {
            const auto found = coordinator.last_result(at);
            expect(!found || *found == *result,
                   [&] { return "node '" + what.network->graph.nodes[at].name + "' has prepared something else"; });
        }
        coordinator.begin_master();
        MasterRenderer master(std::move(work), coordinator, [&](const Tile& tile, std::span<const Rgb> pixels) {
            expect(!film.has(tile), [] { return std::string("a tile came twice"); });
            const auto at = static_cast<std::size_t>(std::ranges::find(what.tiles, tile) - what.tiles.begin());
            expect(
                at == what.tiles.size() || std::memcmp(pixels.data(), what.pixels[at].data(), pixels.size_bytes()) == 0,
                [&] { return "tile " + std::to_string(at) + " has other bytes"; });
            film.add(tile, pixels);
        });
        master.use(coordinator.in_force());
        expect(master.work(most),
               [&] { return "rendering hangs with " + std::to_string(master.unanswered()) + " blocks missing"; });
        expect(master.set_aside_tiles().empty(), [] { return std::string("a tile is set aside"); });
        master.settle(most);
        expect(master.outstanding() == 0, [] { return std::string("credit did not come back"); });
    }
    expect(film.complete(), [] { return std::string("the film is not complete"); });
    return {film.picture(), cluster.story(), cluster.events(), cluster.happened(), cluster.fetched()};
}

bool same_bytes(const Picture& a, const Picture& b) {
    const auto same = [](const std::vector<Rgb>& x, const std::vector<Rgb>& y) {
        return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(Rgb)) == 0;
    };
    bool all = same(a.beauty, b.beauty) && a.layers.size() == b.layers.size();
    for (std::size_t i = 0; all && i < a.layers.size(); ++i) all = same(a.layers[i].pixels, b.layers[i].pixels);
    return all;
}

#ifdef LIGHTNET_LARGE
constexpr std::uint64_t seeds = 10000;
#else
constexpr std::uint64_t seeds = 100 / slowdown;
#endif

// `LIGHTNET_SEED` in the environment plays one seed again, or all from one to another (300-999), and `LIGHTNET_STORY`
// tells what happens.
void for_every_seed(std::uint64_t most, const std::function<void(std::uint64_t)>& play_seed) {
    std::uint64_t first = 1, last = most;
    if (const char* only = std::getenv("LIGHTNET_SEED")) {
        const std::string said = only;
        const auto to = said.find('-');
        first = last = std::stoull(said);
        if (to != std::string::npos) last = std::stoull(said.substr(to + 1));
    }
    for (auto seed = first; seed <= last && !::testing::Test::HasFailure(); ++seed) play_seed(seed);
}

TEST(ClusterInOneThread, HasTheSameStoryForTheSameSeed) {
    for_every_seed(4, [](std::uint64_t seed) {
        const auto world = world_of(seed);
        const auto one = play(world, pictured(seed)), again = play(world, pictured(seed));
        EXPECT_EQ(one.story, again.story) << "seed " << seed;
        EXPECT_EQ(one.events, again.events) << "seed " << seed;
    });
}

TEST(ClusterInOneThread, GivesTheBytesOfASerialRunWhateverHappens) {
    std::map<Mishap::Kind, std::size_t> happened;
    std::uint64_t events = 0;
    std::size_t from_others = 0, from_launcher = 0;  // results
    for_every_seed(seeds, [&](std::uint64_t seed) {
        SCOPED_TRACE("play it again with LIGHTNET_SEED=" + std::to_string(seed));
        const auto& what = pictured(seed);
        try {
            const auto told = play(world_of(seed), what);
            EXPECT_TRUE(same_bytes(told.picture, what.expected)) << "another picture";
            for (const auto& [kind, times] : told.happened) happened[kind] += times;
            events += told.events;
            from_others += told.fetched.first, from_launcher += told.fetched.second;
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
    });
    RecordProperty("events", std::to_string(events));
    RecordProperty("results_from_others", std::to_string(from_others));
    if (std::getenv("LIGHTNET_SEED") || HasFailure()) return;
    EXPECT_GT(from_others, seeds / 4) << "hosts have what others lack";
    EXPECT_GT(from_launcher, seeds / 4) << "what nobody has at first, and where holders lie or are lost";
    for (const auto kind : {Mishap::Kind::kill, Mishap::Kind::drain, Mishap::Kind::cut_off, Mishap::Kind::cut,
                            Mishap::Kind::freeze, Mishap::Kind::move})
        EXPECT_GT(happened[kind], seeds / 20) << "of kind " << int(kind);
}

}  // namespace
}  // namespace lightnet::one_thread_test
