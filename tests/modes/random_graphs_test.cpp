// Any sound graph: random ones of all kinds render to numbers, and to the same ones in every mode of one process.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/serial/serial.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/oracle_run.hpp"
#include "tests/support/slowdown.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::random_graphs_test {
namespace {

using Pixels = std::vector<std::vector<Rgb>>;

/// Writes graphs. Those that learn before they answer are in random_preparing_test.
class Author {
public:
    Author(const Registry& registry, unsigned seed) : registry_(registry), random_(seed) {}

    Graph graph() {
        graph_ = {};
        graph_.file = LIGHTNET_SOURCE_DIR "/graphs/random.lua";
        graph_.nodes.push_back(
            {"scene", "Scene", {Value{"cornell_box.pbrt"}}, {{"groups", Value{Table{{}, {{"all", Value{"*"}}}}}}}, {}});
        const std::size_t count = 1 + below(6);
        for (std::size_t i = 0; i < count; ++i) add_light("n" + std::to_string(i), i);
        graph_.nodes.push_back({"image",
                                "RayTracer",
                                {Value{NodeRef{"n" + std::to_string(count - 1)}}},
                                {{"scene", Value{NodeRef{"scene"}}},
                                 {"film", Value{Table{{Value{12.0}, Value{8.0}}, {}}}},
                                 {"samples", Value{2.0}},
                                 {"filter", Value{std::string(below(2) ? "box" : "gaussian")}}},
                                {}});
        return graph_;
    }

private:
    std::size_t below(std::size_t end) { return random_() % end; }

    void add_light(const std::string& name, std::size_t others) {
        std::vector<const Kind*> possible;
        for (const auto& kind : registry_.kinds())
            if (kind.role == Role::light && !kind.light.facts && !kind.run.prepares &&
                (kind.inputs.least == 0 || others > 0))
                possible.push_back(&kind);
        const Kind& kind = *possible[below(possible.size())];
        Node node{name, kind.name, {}, {}, {}};
        const std::size_t most = std::min<std::size_t>(kind.inputs.most, 3);
        const std::size_t inputs =
            kind.inputs.least + (most > kind.inputs.least ? below(most - kind.inputs.least + 1) : 0);
        for (std::size_t i = 0; i < inputs; ++i)
            node.entries.push_back(
                Value{NodeRef{"n" + std::to_string(others - 1 - below(std::min<std::size_t>(others, 3)))}});
        for (const auto& param : kind.params) add_param(node, param);
        if (kind.name == "Select") node.params["material"] = Value{"white"}, node.params["hair"] = Value{"all"};
        graph_.nodes.push_back(std::move(node));
    }

    void add_param(Node& node, const Param& param) {
        if (param.type == ParamType::integer)
            node.params[param.name] = Value{std::max(param.least, 0.0) + double(below(3))};
        // who keeps groups apart needs inputs that all do
        if (param.type == ParamType::flag)
            node.params[param.name] = Value{below(2) == 1 && (param.name != "groups" || node.entries.empty())};
        if (param.type == ParamType::text && !param.choices.empty())
            node.params[param.name] = Value{param.choices[below(param.choices.size())]};
    }

    const Registry& registry_;
    std::mt19937 random_;
    Graph graph_;
};

class RandomGraphs : public testing::TestWithParam<unsigned> {
protected:
    Pixels oracle() const {
        Pixels pixels(tiles_.size());
        Tuning rules;
        rules.bundle = 5;
        run_oracle(network_, tiles_, rules, [&](const Tile& tile, std::span<const Rgb> colours) {
            pixels[index_of(tile)].assign(colours.begin(), colours.end());
        });
        return pixels;
    }
    Pixels threaded() const { return threaded_by(plan(network_->graph, registry_, {}, {{"", 2}})); }
    // Each node at one place of the process or several, as a hosts file may say, so that questions cross its sockets.
    Pixels spread_over_threads(std::mt19937& random) const {
        Hosts hosts{"hosts.lua", std::vector<HostEntry>(2 + random() % 3, {std::string(own_process), {}, 1, {}})};
        for (const auto& node : network_->graph.nodes) {
            if (node.kind == "Scene") continue;
            for (auto& entry : hosts.hosts)
                if (random() % 3 == 0) entry.replicas[node.name] = 1;
        }
        hosts.hosts[random() % hosts.hosts.size()].replicas["image"] = 1;
        std::erase_if(hosts.hosts, [](const HostEntry& entry) { return entry.replicas.empty(); });
        return threaded_by(plan(network_->graph, registry_, hosts, {{"", 1}}));
    }
    Pixels threaded_by(const Plan& where) const {
        Pixels pixels(tiles_.size());
        ThreadedRun run(network_, 1, where, {});
        MasterRenderer::Job job;
        job.run = 1;
        job.image = static_cast<std::uint32_t>(renderer_of(network_->graph, registry_));
        job.width = static_cast<std::uint32_t>(colours_of(network_->layers));
        job.tiles = tiles_;
        MasterRenderer master(job, run.carrier(), [&](const Tile& tile, std::span<const Rgb> colours) {
            pixels[index_of(tile)].assign(colours.begin(), colours.end());
        });
        master.use(where);
        EXPECT_TRUE(master.work(test::slowdown * std::chrono::seconds(30))) << "it hangs";
        run.stop();
        return pixels;
    }
    std::size_t index_of(const Tile& tile) const {
        return static_cast<std::size_t>(std::find(tiles_.begin(), tiles_.end(), tile) - tiles_.begin());
    }

    const Registry registry_{standard_nodes()};
    std::shared_ptr<const Network> network_;
    const std::vector<Tile> tiles_ = tiles_of(12, 8, 8, 2);
};

TEST_P(RandomGraphs, AreNumbersAndTheSameInEveryMode) {
    Author author(registry_, GetParam());
    std::mt19937 layouts(GetParam());
    for (int i = 0; i < 8; ++i) {
        Job job;
        job.graph = check(author.graph(), registry_);
        job.scene = scene_file(job.graph, registry_);
        job.isa = usual_isa();
        job.width = 12;
        job.height = 8;
        DiskFiles disk;
        network_ = build_network(job, registry_, disk);
        SerialRun run(*network_);
        Pixels serial;
        for (const auto& tile : tiles_) serial.push_back(run.render(tile));
        for (const auto& colours : serial)
            EXPECT_TRUE(std::all_of(colours.begin(), colours.end(), [](Rgb c) { return finite(c); }))
                << to_json(job.graph);
        EXPECT_TRUE(oracle() == serial) << to_json(job.graph);
        EXPECT_TRUE(threaded() == serial) << to_json(job.graph);
        EXPECT_TRUE(spread_over_threads(layouts) == serial) << to_json(job.graph);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomGraphs, testing::Range(1u, 6u));

}  // namespace
}  // namespace lightnet::random_graphs_test
