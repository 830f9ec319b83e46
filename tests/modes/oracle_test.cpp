// One process: the oracle that packs, parks and unpacks every ask, and places that serve each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <future>

#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/serial/serial.hpp"
#include "lua/load_graph.hpp"
#include "nodes/examples/candela/candela_kinds.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/mailbox_transport.hpp"
#include "tests/support/oracle_run.hpp"
#include "tests/support/slowdown.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::oracle_test {
namespace {

using Pixels = std::vector<Rgb>;

// A shipped graph, small enough to be rendered many times.
class Shipped {
public:
    explicit Shipped(const std::string& name, std::uint32_t size = 24, std::uint32_t samples = 4)
        : registry(standard_nodes()), file(std::string(LIGHTNET_SOURCE_DIR) + "/graphs/" + name) {
        registry.add(candela_kinds());
        Job job;
        job.graph = check(load_graph(file), registry);
        job.scene = scene_file(job.graph, registry);
        job.isa = usual_isa();
        job.width = job.height = size;
        DiskFiles disk;
        network = build_network(job, registry, disk);
        tiles = tiles_of(size, size, 8, samples);
    }

    std::vector<Pixels> serial() const {
        SerialRun run(*network);
        std::vector<Pixels> pixels;
        for (const auto& tile : tiles) pixels.push_back(run.render(tile));
        return pixels;
    }
    std::vector<Pixels> oracle(Tuning rules) const {
        std::vector<Pixels> pixels(tiles.size());
        run_oracle(network, tiles, rules, [&](const Tile& tile, std::span<const Rgb> colours) {
            pixels[index_of(tile)].assign(colours.begin(), colours.end());
        });
        return pixels;
    }
    std::vector<Pixels> threaded(const Plan& plan, Tuning rules, Counters* counters = nullptr,
                                 const MakePlaceTransport& make = zmq_within_process) const {
        std::vector<Pixels> pixels(tiles.size());
        ThreadedRun run(network, 1, plan, rules, make);
        MasterRenderer::Job job;
        job.run = 1;
        job.image = static_cast<std::uint32_t>(renderer_of(network->graph, registry));
        job.width = static_cast<std::uint32_t>(colours_of(network->layers));
        job.tiles = tiles;
        MasterRenderer master(job, run.carrier(), [&](const Tile& tile, std::span<const Rgb> colours) {
            pixels[index_of(tile)].assign(colours.begin(), colours.end());
        });
        master.use(plan);
        EXPECT_TRUE(master.work(test::slowdown * std::chrono::seconds(30))) << "it hangs";
        const auto counted = run.stop();
        if (counters) *counters = counted;
        return pixels;
    }
    std::size_t index_of(const Tile& tile) const {
        return static_cast<std::size_t>(std::find(tiles.begin(), tiles.end(), tile) - tiles.begin());
    }
    std::size_t node(const std::string& name) const { return *network->graph.find(name); }

    Registry registry;
    std::string file;
    std::shared_ptr<const Network> network;
    std::vector<Tile> tiles;
};

class Oracle : public ::testing::TestWithParam<std::string> {};

TEST_P(Oracle, AgreesWithSerialBitForBit) {
    const Shipped graph(GetParam());
    const auto serial = graph.serial();
    for (const std::size_t bundle : {1, 7, 512}) {
        Tuning rules;
        rules.bundle = bundle;
        rules.spare_fibers = bundle == 7 ? 0 : 16;
        EXPECT_TRUE(graph.oracle(rules) == serial) << "bundles of " << bundle;
    }
}

// But for graphs that hold locks, which want a launcher to give them.
INSTANTIATE_TEST_SUITE_P(EveryGraph, Oracle,
                         ::testing::Values("cornell.lua", "weights.lua", "ambient.lua", "direct.lua", "traditional.lua",
                                           "traditional_eye.lua"),
                         [](const auto& graph) { return std::filesystem::path(graph.param).stem().string(); });

// image on both; lighting asks direct at the other place, which asks nobody; so each place asks and serves the other.
Plan crossed(const Shipped& graph) {
    Plan plan;
    plan.places = {{"", 0}, {"", 1}};
    plan.places_of.resize(graph.network->graph.nodes.size());
    plan.places_of[graph.node("image")] = {0, 1};
    plan.places_of[graph.node("lighting")] = {1};
    plan.places_of[graph.node("direct")] = {0};
    plan.places_of[graph.node("bounce")] = {0, 1};
    return plan;
}

TEST(Places, ThatServeEachOtherWithOneFiberPerNodeAndCreditOneDoNotHang) {
    const Shipped graph("cornell.lua");
    Tuning narrow;
    narrow.credit = 1, narrow.credit_questions = 1;
    narrow.spare_fibers = 0;
    for (const std::size_t bundle : {1, 64}) {
        narrow.bundle = bundle;
        Counters counters;
        EXPECT_TRUE(graph.threaded(crossed(graph), narrow, &counters) == graph.serial());
        EXPECT_GT(counters.questions, 0u);
        EXPECT_EQ(counters.bytes, 0u) << "within a process bundles are handed over by pointer";
    }
}

TEST(Places, MakeTheSamePictureOnATransportOfAnotherMake) {
    const Shipped graph("cornell.lua");
    Counters counters;
    EXPECT_TRUE(graph.threaded(crossed(graph), {}, &counters, test::mailboxes) == graph.serial());
    EXPECT_GT(counters.questions, 0u) << "they should have travelled";
}

TEST(Places, EndTheRunWithTheNameOfTheNodeThatThrew) {
    const Shipped graph("cornell.lua");
    ThreadedRun run(graph.network, 1, crossed(graph), {});
    Message ask;  // a question about a surface that is not there
    ask.run = 1;
    ask.node = static_cast<std::uint32_t>(graph.node("lighting"));
    ask.width = 2;
    ask.questions = std::make_shared<const std::vector<Query>>(1, Query{.geometry = 999});
    ASSERT_TRUE(run.carrier().ask({"", 1}, ask));
    std::optional<Message> reply;
    for (int i = 0; i < 100 && !reply; ++i) {
        run.carrier().wait(std::chrono::milliseconds(100));
        reply = run.carrier().receive();
    }
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->type, Message::Type::failure);
    EXPECT_NE(reply->trouble.why.find("on place 1: 'lighting': "), std::string::npos) << reply->trouble.why;
    EXPECT_NE(reply->trouble.why.find("a surface that isn't there"), std::string::npos) << reply->trouble.why;
}

}  // namespace
}  // namespace lightnet::oracle_test
