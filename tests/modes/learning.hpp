// A network that prepares, and the ways to render it: serially, in threads, on hosts of this process.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/layout.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/master/coordinator.hpp"
#include "core/run/master/tiles_by_pass.hpp"
#include "core/run/serial/serial.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/bad_line.hpp"
#include "tests/support/host_thread.hpp"
#include "tests/support/learner.hpp"
#include "tests/support/slowdown.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::test {

using Pixels = std::vector<Rgb>;

inline constexpr std::uint32_t width = 24, height = 16, samples = 4;

inline Node node(std::string name, std::string kind, std::vector<Value> entries,
                 std::map<std::string, Value> params = {}) {
    return {std::move(name), std::move(kind), std::move(entries), std::move(params), {"test.lua", 1}};
}

// Operators spread over places, round about.
inline Plan spread(std::size_t nodes, std::uint32_t places) {
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

inline std::map<std::string, Value> seen() {
    return {{"scene", Value{NodeRef{"scene"}}},
            {"film", Value{Table{{Value{double(width)}, Value{double(height)}}, {}}}}};
}

// image ← both ← (first ← direct), (second ← first): one learner asks another.
inline std::vector<Node> learning_nodes() {
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
    Learning() : Learning(with_learner(), learning_nodes()) {}
    Learning(Registry kinds, std::vector<Node> nodes, const std::map<std::string, std::uint32_t>& shards = {},
             const std::string& scene = "cornell_box.pbrt")
        : registry(std::move(kinds)) {
        job.graph = sharded(check({"test.lua", std::move(nodes)}, registry), shards);
        job.scene = std::string(LIGHTNET_SOURCE_DIR) + "/graphs/" + scene;
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
        Coordinator coordinator(options(), cluster);
        coordinator.propose(cluster.plan());
        const auto end = std::chrono::steady_clock::now() + slowdown * std::chrono::seconds(30);
        while (!coordinator.prepare(std::chrono::milliseconds(2))) {
            if (meanwhile) meanwhile();
            if (std::chrono::steady_clock::now() > end) {
                ADD_FAILURE() << "preparing hangs: " << to_string(coordinator.progress());
                return {};
            }
        }
        return render(coordinator);
    }

    std::vector<Pixels> threaded(const Plan& plan, Tuning rules) const {
        ThreadedRun run(network, 1, plan, rules);
        Coordinator coordinator(options(), run.carrier());
        coordinator.propose(plan);
        EXPECT_TRUE(coordinator.prepare(slowdown * std::chrono::seconds(30)))
            << "preparing hangs: " << to_string(coordinator.progress());
        for (std::size_t node = 0; node < plan.places_of.size(); ++node)
            EXPECT_EQ(coordinator.in_force().places_of[node].empty(), plan.places_of[node].empty()) << "can be asked";
        EXPECT_LE(said.size(), std::max<std::size_t>(2, 2 * job.graph.sectors.size()))
            << "each line once, however many places say it";
        auto pixels = render(coordinator);
        counted = run.stop();
        return pixels;
    }

    Coordinator::Options options() const {
        Coordinator::Options options;
        said.clear();
        options.say = [this](const std::string& line) { said.push_back(line); };
        options.run = 1;
        options.graph = &network->graph;
        options.registry = &registry;
        options.width = static_cast<std::uint32_t>(colours_of(network->layers));
        options.verify = verify;
        return options;
    }

    std::vector<Pixels> render(Coordinator& coordinator) const {
        std::vector<Pixels> pixels(tiles.size());
        MasterRenderer::Job work;
        work.run = 1;
        work.image = static_cast<std::uint32_t>(renderer_of(network->graph, registry));
        work.width = static_cast<std::uint32_t>(colours_of(network->layers));
        TilesByPass passes(network->graph, registry, tiles);
        while (!passes.empty()) {
            work.tiles = passes.begin_next();
            coordinator.begin_pass(passes.pass());
            EXPECT_TRUE(coordinator.prepare(slowdown * std::chrono::seconds(30))) << "preparing hangs";
            if (between_passes) between_passes(passes.pass());
            MasterRenderer master(work, coordinator, [&](const Tile& tile, std::span<const Rgb> colours) {
                const auto index = std::find(tiles.begin(), tiles.end(), tile) - tiles.begin();
                pixels[static_cast<std::size_t>(index)].assign(colours.begin(), colours.end());
            });
            master.use(coordinator.in_force());
            EXPECT_TRUE(master.work(slowdown * std::chrono::seconds(30))) << "rendering hangs";
        }
        return pixels;
    }

    Registry registry;
    Job job;
    std::map<std::string, Bytes> files;
    std::shared_ptr<const Network> network;
    std::vector<Tile> tiles;
    std::uint32_t verify = 0;                                // millionths of the shards
    std::function<void(std::uint32_t pass)> between_passes;  // when one is prepared
    mutable std::vector<std::string> said;                   // by the nodes of the last run
    mutable Counters counted;                                // in the last run with threads
};

inline Cluster::Options cluster_of(const Learning& learning, std::vector<std::string> endpoints) {
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

// Cuts a line again and again, as long as it lives; each time a little later than the time before, so that a machine
// that is too busy to use the line meanwhile gets on in the end.
class Scissors {
public:
    Scissors(BadLine& line, std::chrono::milliseconds pause)
        : thread_([&line, pause](const std::stop_token& stop) mutable {
              for (; !stop.stop_requested(); std::this_thread::sleep_for(pause), pause += pause / 10) line.cut();
          }) {}

private:
    std::jthread thread_;
};

}  // namespace lightnet::test
