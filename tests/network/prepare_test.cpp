// Nodes that prepare: the same bytes however many places do it, and whoever is lost meanwhile.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "core/film/film.hpp"
#include "core/graph/check.hpp"
#include "core/runtime/conductor.hpp"
#include "core/runtime/serial.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/learner.hpp"
#include "tests/support/slowdown.hpp"
#include "tests/support/small_scenes.hpp"
#include "transport/threaded_run.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;
using Pixels = std::vector<Rgb>;

constexpr std::uint32_t width = 24, height = 16, samples = 4;

Node node(std::string name, std::string kind, std::vector<Value> entries, std::map<std::string, Value> params = {}) {
    return {std::move(name), std::move(kind), std::move(entries), std::move(params), {"test.lua", 1}};
}

// image ← both ← (first ← direct), (second ← first): one learner asks another.
class Learning {
public:
    Learning() : registry(with_learner()) {
        const auto ref = [](const char* name) { return Value{NodeRef{name}}; };
        Graph graph{"test.lua", {}};
        graph.nodes = {
            node("scene", "Scene", {Value{std::string("none.pbrt")}}),
            node("direct", "DirectLighting", {}),
            node("first", "Learner", {ref("direct")}, {{"stride", Value{4.0}}}),
            node("second", "Learner", {ref("first")}, {{"stride", Value{2.0}}}),
            node("both", "Combine", {ref("first"), ref("second")}),
            node("image", "RayTracer", {ref("both")},
                 {{"scene", ref("scene")}, {"film", Value{Table{{Value{double(width)}, Value{double(height)}}, {}}}}})};
        SceneOptions options;
        options.width = width, options.height = height;
        network = std::make_shared<const Network>(Network{
            check(graph, registry), registry, std::make_shared<const Scene>(test::furnace(0.5f, 1), options), 1});
        tiles = tiles_of(width, height, 8, samples);
    }

    static Registry with_learner() {
        auto kinds = standard_nodes();
        kinds.push_back(test::learner());
        return Registry(std::move(kinds));
    }

    std::vector<Pixels> serial() const {
        SerialRun run(*network);
        run.prepare("");
        std::vector<Pixels> pixels;
        for (const auto& tile : tiles) pixels.push_back(run.render(tile));
        return pixels;
    }

    std::vector<Pixels> threaded(const Plan& plan, PlaceRules rules) const {
        ThreadedRun run(network, 1, plan, rules);
        Conductor conductor(options(), run.carrier());
        conductor.propose(plan);
        EXPECT_TRUE(conductor.prepare(test::slowdown * 30s)) << "preparing hangs: " << conductor.progress();
        EXPECT_EQ(conductor.in_force(), plan);
        auto pixels = render(conductor);
        run.stop();
        return pixels;
    }

    Conductor::Options options() const {
        Conductor::Options options;
        options.run = 1;
        options.graph = &network->graph;
        options.registry = &registry;
        options.width = static_cast<std::uint32_t>(network->layers.film.size());
        return options;
    }

    std::vector<Pixels> render(Conductor& conductor) const {
        std::vector<Pixels> pixels(tiles.size());
        MasterRenderer::Job job;
        job.run = 1;
        job.image = static_cast<std::uint32_t>(renderer_of(network->graph, registry));
        job.width = static_cast<std::uint32_t>(network->layers.film.size());
        job.tiles = tiles;
        MasterRenderer master(job, conductor, [&](const Tile& tile, std::span<const Rgb> colours) {
            const auto index = std::find(tiles.begin(), tiles.end(), tile) - tiles.begin();
            pixels[static_cast<std::size_t>(index)].assign(colours.begin(), colours.end());
        });
        master.use(conductor.in_force());
        EXPECT_TRUE(master.work(test::slowdown * 30s)) << "rendering hangs";
        return pixels;
    }

    Registry registry;
    std::shared_ptr<const Network> network;
    std::vector<Tile> tiles;
};

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

TEST(Prepare, GetsByWithOneFiberPerNodeAndBundlesOfOne) {
    const Learning learning;
    PlaceRules narrow;
    narrow.spare_fibers = 0;
    narrow.bundles.questions = 1;
    narrow.credit = {1, 1};
    EXPECT_EQ(learning.threaded(spread(learning.network->graph.nodes.size(), 3), narrow), learning.serial());
}

}  // namespace
}  // namespace lightnet
