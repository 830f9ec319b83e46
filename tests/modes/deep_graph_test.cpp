// Graphs that are as deep as they may be: nodes that ask each other in a row get along with the stack of a fiber.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/serial/serial.hpp"
#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/oracle_run.hpp"
#include "tests/support/slowdown.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::deep_graph_test {
namespace {

constexpr std::uint32_t side = 8;

struct Link {
    std::string name, node;  // as a graph has it, with IN for its input
};

/// So many links above a light, and a renderer above them.
Graph chain(const std::string& node, unsigned links) {
    std::string text = "scene = Scene { 'cornell_box.pbrt' }\nn0 = DirectLighting { samples = 1 }\n";
    for (unsigned i = 1; i <= links; ++i) {
        std::string link = node;
        link.replace(link.find("IN"), 2, "n" + std::to_string(i - 1));
        text += "n" + std::to_string(i) + " = " + link + "\n";
    }
    text += "image = RayTracer { n" + std::to_string(links) + ", scene = scene, samples = 1, film = { 8, 8 } }";
    return parse_graph(text, std::string(LIGHTNET_SOURCE_DIR) + "/graphs/chain.lua");
}

class Deepest : public ::testing::TestWithParam<Link> {
protected:
    Deepest() : registry_(standard_nodes()) {
        Job job;
        job.graph = check(chain(GetParam().node, most_rank - 1), registry_);
        job.scene = scene_file(job.graph, registry_);
        job.isa = usual_isa();
        job.width = job.height = side;
        DiskFiles disk;
        network_ = build_network(job, registry_, disk);
        tiles_ = tiles_of(side, side, side, 1);
    }

    using Pixels = std::vector<Rgb>;
    Pixels serial() const {
        SerialRun run(*network_);
        return run.render(tiles_.at(0));
    }
    Pixels in_a_place() const {
        Plan plan{{{"", 0}}, std::vector<std::vector<std::uint32_t>>(network_->graph.nodes.size(), {0})};
        ThreadedRun run(network_, 1, plan, {});
        MasterRenderer::Job job;
        job.run = 1;
        job.image = static_cast<std::uint32_t>(renderer_of(network_->graph, registry_));
        job.width = static_cast<std::uint32_t>(colours_of(network_->layers));
        job.tiles = tiles_;
        Pixels pixels;
        MasterRenderer master(job, run.carrier(), [&](const Tile&, std::span<const Rgb> colours) {
            pixels.assign(colours.begin(), colours.end());
        });
        master.use(plan);
        EXPECT_TRUE(master.work(test::slowdown * std::chrono::seconds(30))) << "it hangs";
        run.stop();
        return pixels;
    }
    Pixels by_messages() const {
        Pixels pixels;
        run_oracle(network_, tiles_, {},
                   [&](const Tile&, std::span<const Rgb> colours) { pixels.assign(colours.begin(), colours.end()); });
        return pixels;
    }

    Registry registry_;
    std::shared_ptr<const Network> network_;
    std::vector<Tile> tiles_;
};

// Registers are wider on some processors, and so are the frames of what traces rays there.
TEST_P(Deepest, GraphLeavesAThirdOfAFibersStack) {
    Fibers fibers(usual_stack_size * 2 / 3);
    bool ended = false;
    fibers.start("the deepest graph", [&] {
        serial();
        ended = true;
    });
    EXPECT_TRUE(ended);
}

TEST_P(Deepest, GraphIsRenderedOnOneFiberWithTheSameBytes) {
    const auto pixels = serial();
    EXPECT_TRUE(in_a_place() == pixels);
    EXPECT_TRUE(by_messages() == pixels);
    EXPECT_TRUE(std::any_of(pixels.begin(), pixels.end(), [](const Rgb& colour) { return max_component(colour) > 0; }));
}

INSTANTIATE_TEST_SUITE_P(Of, Deepest,
                         ::testing::Values(Link{"Scale", "Scale { IN, factor = 1 }"}, Link{"Combine", "Combine { IN }"},
                                           Link{"Clamp", "Clamp { IN, most = 100 }"},
                                           Link{"FinalGather", "FinalGather { IN, rays = 1 }"}),
                         [](const auto& link) { return link.param.name; });

TEST(DeepGraph, ThatIsDeeperIsRefusedBeforeItIsBuilt) {
    const Registry registry{standard_nodes()};
    EXPECT_NO_THROW(check(chain("Scale { IN }", most_rank - 1), registry));
    for (const unsigned links : {most_rank, 1000u}) {
        try {
            check(chain("Scale { IN }", links), registry);
            FAIL() << "a chain of " << links << " was taken";
        } catch (const UserError& error) {
            EXPECT_THAT(error.what(), ::testing::HasSubstr("too many nodes ask each other in a row"));
        }
    }
}

}  // namespace
}  // namespace lightnet::deep_graph_test
