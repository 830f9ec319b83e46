// A place that has more to do than another, which holds only some of its nodes, gives questions away.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "core/run/master/master_renderer.hpp"
#include "tests/support/slowdown.hpp"
#include "tests/support/small_scenes.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::relief_test {
namespace {

constexpr auto cost = std::chrono::microseconds(40);  // of a question; it is waited for, not computed
constexpr std::uint32_t tiles = 24, side = 16;

// Places that answer now, and questions answered while another place did so, too.
std::atomic<int> answering{0};
std::atomic<std::uint64_t> side_by_side{0};

class Costly final : public LightOp {
public:
    explicit Costly(const NodeContext& here) : key_(here.key()) {}
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        const bool first = answering.fetch_add(1) == 0;
        std::this_thread::sleep_for(cost * questions.size());
        const bool last = answering.fetch_sub(1) == 1;
        if (!first || !last) side_by_side += questions.size();
        for (std::size_t i = 0; i < questions.size(); ++i)
            answers[i] = {static_cast<float>(child(questions[i].stream, key_, 1) % 1000), 1, 2};
    }

private:
    Key key_;
};

/// Asks about each pixel, several times one after the other.
class Asking final : public Renderer {
public:
    explicit Asking(const NodeContext& here) : inputs_(here.inputs()) {}
    void render_block(const Tile& tile, std::span<Rgb> pixels) const override {
        std::vector<Query> questions(tile.pixels());
        for (std::uint64_t time = 0; time < 4; ++time) {
            for (std::size_t i = 0; i < questions.size(); ++i)
                questions[i].stream = child(pixel_key(tile.x, tile.y, std::uint32_t(i)), time, 0);
            const Part part = ask(inputs_, 0, questions);
            for (std::size_t i = 0; i < questions.size(); ++i) pixels[2 * i + 1] += part.answers[i];
        }
    }

private:
    Inputs inputs_;
};

Registry kinds() {
    return Registry({{.name = "Costly",
                      .help = "takes its time",
                      .make_light = [](const NodeContext& here) { return std::make_unique<Costly>(here); }},
                     {.name = "Asking",
                      .role = Role::image,
                      .help = "asks",
                      .inputs = {0, 1},
                      .make_renderer = [](const NodeContext& here) { return std::make_unique<Asking>(here); }}});
}

struct Outcome {
    std::vector<std::vector<Rgb>> pixels;
    Counters counters;
    std::uint64_t side_by_side = 0;  // of the questions
};

// `places_of`: of Costly, and of the renderer.
Outcome render(std::uint32_t places, const std::vector<std::vector<std::uint32_t>>& places_of) {
    const Registry registry = kinds();
    Graph graph;
    graph.file = "relief.lua";
    graph.nodes.push_back({"costly", "Costly", {}, {}, {}});
    graph.nodes.push_back({"image", "Asking", {Value{NodeRef{"costly"}}}, {}, {}});
    const auto network = std::make_shared<const Network>(
        Network{graph, registry, std::make_shared<const Scene>(test::furnace(0.5f, 1)), 1});
    Plan plan;
    for (std::uint32_t i = 0; i < places; ++i) plan.places.push_back({"", i});
    plan.places_of = places_of;
    Outcome outcome;
    outcome.pixels.resize(tiles);
    side_by_side = 0;
    ThreadedRun run(network, 1, plan, Tuning{});
    MasterRenderer::Job job;
    job.run = 1;
    job.image = 1;
    job.width = 2;
    for (std::uint32_t i = 0; i < tiles; ++i) job.tiles.push_back({side * i, 0, side, side, 0, 1});
    MasterRenderer master(job, run.carrier(), [&](const Tile& tile, std::span<const Rgb> colours) {
        outcome.pixels[tile.x / side].assign(colours.begin(), colours.end());
    });
    master.use(plan);
    EXPECT_TRUE(master.work(test::slowdown * std::chrono::seconds(60))) << "it hangs";
    outcome.counters = run.stop();
    outcome.side_by_side = side_by_side;
    return outcome;
}

constexpr std::uint64_t questions = std::uint64_t{tiles} * side * side * 4;

TEST(Relief, BringsQuestionsToAPlaceThatIdlesAndThePictureSooner) {
    const auto alone = render(1, {{0}, {0}});
    const auto helped = render(2, {{0, 1}, {0}});
    EXPECT_EQ(alone.counters.local_questions, questions);
    EXPECT_EQ(alone.counters.questions, 0u);
    EXPECT_GT(helped.counters.questions, questions / 4) << "the other place idles otherwise";
    EXPECT_GT(helped.counters.local_questions, questions / 16) << "this place does its part, however held up it is";
    EXPECT_EQ(alone.side_by_side, 0u);
    EXPECT_GT(helped.side_by_side, questions / 16) << "one waits for the other";
    EXPECT_TRUE(helped.pixels == alone.pixels);
}

TEST(Relief, SendsNothingWhereAllPlacesHoldTheSame) {
    const auto outcome = render(2, {{0, 1}, {0, 1}});
    EXPECT_EQ(outcome.counters.questions, 0u);
    EXPECT_EQ(outcome.counters.local_questions, questions);
}

}  // namespace
}  // namespace lightnet::relief_test
