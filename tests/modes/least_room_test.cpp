// Random acyclic graphs over random places, with as little room as there can be: they never hang, and give the same
// answers as one thread. And what is started and stopped leaves nothing behind.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "core/network/light/light_op.hpp"
#include "core/network/light/renderer.hpp"
#include "core/network/light/wrap.hpp"
#include "core/run/fiber/fiber_stack.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/serial/serial.hpp"
#include "tests/support/slowdown.hpp"
#include "tests/support/small_scenes.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::least_room_test {
namespace {

constexpr std::uint8_t deepest = 4;  // questions are handed on so often: graphs have exponentially many paths

Rgb own_answer(const Query& question, Key key) {
    const auto bits = child(question.stream, key, question.depth);
    return {static_cast<float>(bits % 1000), static_cast<float>(question.depth), 1};
}

Query handed_on(const Query& question, Key key, std::uint64_t i) {
    Query next = question;
    next.stream = child(question.stream, key, i);
    ++next.depth;
    return next;
}

/// Asks all its inputs two questions for each of its own.
class Plain final : public LightOp {
public:
    explicit Plain(const NodeContext& here) : inputs_(here.inputs()), key_(here.key()) {}
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        std::vector<Query> more;
        std::vector<std::size_t> whose;
        for (std::size_t i = 0; i < questions.size(); ++i) {
            answers[i] = own_answer(questions[i], key_);
            for (std::uint64_t k = 0; k < 2 && questions[i].depth < deepest; ++k)
                more.push_back(handed_on(questions[i], key_, k)), whose.push_back(i);
        }
        if (more.empty()) return;
        for (const auto& part : ask_all(inputs_, more))
            for (std::size_t k = 0; k < more.size(); ++k) answers[whose[k]] += part.answers[k] * 0.25f;
    }

private:
    Inputs inputs_;
    Key key_;
};

/// Asks its inputs one by one, in an order that depends on the question.
class Traditional {
public:
    Traditional(OneByOne& inputs, Key key) : inputs_(inputs), key_(key) {}
    Rgb answer(const Query& question) {
        Rgb sum = own_answer(question, key_);
        if (question.depth >= deepest) return sum;
        const auto first = question.stream % 7;
        for (std::size_t i = 0; i < inputs_.inputs(); ++i)
            sum += 0.5f * inputs_.ask((i + first) % inputs_.inputs(), handed_on(question, key_, i));
        return sum;
    }

private:
    OneByOne& inputs_;
    Key key_;
};

class Asking final : public Renderer {
public:
    explicit Asking(const NodeContext& here) : inputs_(here.inputs()) {}
    void render_block(const Tile& tile, std::span<Rgb> pixels) const override {
        std::vector<Query> questions(tile.pixels());
        for (std::size_t i = 0; i < questions.size(); ++i)
            questions[i].stream = pixel_key(tile.x, tile.y, std::uint32_t(i));
        const Part part = ask(inputs_, 0, questions);
        for (std::size_t i = 0; i < questions.size(); ++i) pixels[2 * i + 1] = part.answers[i];
    }

private:
    Inputs inputs_;
};

}  // namespace

}  // namespace lightnet::least_room_test

namespace lightnet {

template <>
struct Bridge<least_room_test::Traditional> {
    Bridge(const NodeContext& here, OneByOne& inputs) : instance_(inputs, here.key()) {}
    Rgb light(const Query& question) { return instance_.answer(question); }

private:
    least_room_test::Traditional instance_;
};

}  // namespace lightnet

namespace lightnet::least_room_test {
namespace {

Registry kinds() {
    return Registry({{.name = "Plain",
                      .help = "asks twice",
                      .inputs = {0, 3},
                      .make_light = [](const NodeContext& here) { return std::make_unique<Plain>(here); }},
                     wrap<Traditional>("Traditional", {.help = "asks one by one", .inputs = {0, 3}}),
                     {.name = "Asking",
                      .role = Role::image,
                      .help = "asks",
                      .inputs = {0, 1},
                      .make_renderer = [](const NodeContext& here) { return std::make_unique<Asking>(here); }}});
}

using Random = std::mt19937;
std::size_t below(Random& random, std::size_t limit) { return random() % limit; }

// Up to seven operators; each asks some of those before it.
Graph some_graph(Random& random) {
    Graph graph;
    graph.file = "random.lua";
    const std::size_t count = 2 + below(random, 6);
    for (std::size_t i = 0; i < count; ++i) {
        Node node{"node" + std::to_string(i), below(random, 2) ? "Plain" : "Traditional", {}, {}, {}};
        for (std::size_t input = i ? 1 + below(random, std::min<std::size_t>(i, 3)) : 0; input > 0; --input)
            node.entries.push_back(Value{NodeRef{"node" + std::to_string(below(random, i))}});
        graph.nodes.push_back(node);
    }
    graph.nodes.push_back({"image", "Asking", {Value{NodeRef{graph.nodes.back().name}}}, {}, {}});
    return graph;
}

// Each node on one or more of the places, in any order.
Plan some_plan(Random& random, const Graph& graph) {
    Plan plan;
    const std::size_t count = 1 + below(random, 3);
    for (std::uint32_t i = 0; i < count; ++i) plan.places.push_back({"", i});
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
        auto& places = plan.places_of.emplace_back();
        for (std::uint32_t i = 0; i < count; ++i)
            if (below(random, 2)) places.push_back(i);
        if (places.empty()) places.push_back(static_cast<std::uint32_t>(below(random, count)));
    }
    return plan;
}

Tuning narrow_rules(Random& random) {
    Tuning rules;
    rules.credit = rules.credit_questions = 1;
    rules.bundle = 1 + below(random, 8);
    rules.spare_fibers = below(random, 3);
    rules.side_fibers = below(random, 4);
    rules.call_own_nodes = below(random, 2);
    return rules;
}

std::vector<Tile> some_tiles() {
    std::vector<Tile> tiles;
    for (std::uint32_t i = 0; i < 4; ++i) tiles.push_back({3 * i, 0, 3, 2, 0, 1});
    return tiles;
}

using Pixels = std::vector<std::vector<Rgb>>;

Pixels serially(const Network& network, const std::vector<Tile>& tiles) {
    SerialRun run(network);
    Pixels pixels;
    for (const auto& tile : tiles) pixels.push_back(run.render(tile));
    return pixels;
}

// Nothing: it hangs.
Pixels in_places(const std::shared_ptr<const Network>& network, const Plan& plan, Tuning rules,
                 const std::vector<Tile>& tiles, Counters& counters) {
    ThreadedRun run(network, 1, plan, rules);
    Pixels pixels(tiles.size());
    MasterRenderer::Job job;
    job.run = 1;
    job.image = static_cast<std::uint32_t>(network->graph.nodes.size() - 1);
    job.width = 2;
    job.tiles = tiles;
    MasterRenderer master(job, run.carrier(), [&](const Tile& tile, std::span<const Rgb> colours) {
        pixels[tile.x / 3].assign(colours.begin(), colours.end());
    });
    master.use(plan);
    if (!master.work(test::slowdown * std::chrono::seconds(30))) return {};
    counters += run.stop();
    return pixels;
}

std::shared_ptr<const Network> network_of(const Graph& graph, const Registry& registry) {
    static const auto scene = std::make_shared<const Scene>(test::furnace(0.5f, 1));
    return std::make_shared<const Network>(Network{graph, registry, scene, 1});
}

#if defined(LIGHTNET_LARGE)
constexpr unsigned first_seed = 1000, seeds = 20000;
#else
constexpr unsigned first_seed = 0, seeds = 400;
#endif

TEST(RandomGraphs, NeverHangWithTheLeastRoomThereIs) {
    const Registry registry = kinds();
    const auto tiles = some_tiles();
    Counters counters;
    for (unsigned seed = first_seed; seed < first_seed + seeds; ++seed) {
        Random random(seed);
        const Graph graph = some_graph(random);
        const Plan plan = some_plan(random, graph);
        const Tuning rules = narrow_rules(random);
        const auto network = network_of(graph, registry);
        const auto found = in_places(network, plan, rules, tiles, counters);
        ASSERT_FALSE(found.empty()) << "seed " << seed << " hangs";
        ASSERT_EQ(found, serially(*network, tiles)) << "seed " << seed;
    }
    EXPECT_GT(counters.questions, 100 * seeds) << "they should have travelled";
    EXPECT_GT(counters.bundles, 20 * seeds);
}

std::size_t entries_of(const char* folder) {
    const std::filesystem::directory_iterator all(folder), end;
    return static_cast<std::size_t>(std::distance(all, end));
}

std::size_t resident_pages() {
    std::ifstream file("/proc/self/statm");
    std::size_t whole = 0, resident = 0;
    file >> whole >> resident;
    return resident;
}

// Also stops in the middle of work: fibers that wait must unwind.
TEST(ThreadedRuns, LeaveNothingBehind) {
    const Registry registry = kinds();
    Random random(1);
    const Graph graph = some_graph(random);
    const auto network = network_of(graph, registry);
    const Plan plan = some_plan(random, graph);
    const auto tiles = some_tiles();
    const auto start_and_stop = [&](std::size_t times) {
        for (std::size_t i = 0; i < times; ++i) {
            ThreadedRun run(network, i, plan, {});
            Message ask;
            ask.run = i;
            ask.node = static_cast<std::uint32_t>(graph.nodes.size() - 1);
            ask.width = 2;
            ask.questions = std::make_shared<const std::vector<Tile>>(tiles);
            run.carrier().ask(plan.places[plan.places_of.back()[0]], ask);
            if (i % 2) run.stop();
        }
    };
    start_and_stop(200);
    const auto files = entries_of("/proc/self/fd"), threads = entries_of("/proc/self/task");
    const auto memory = resident_pages();
    start_and_stop(800);
    EXPECT_EQ(entries_of("/proc/self/fd"), files);
    EXPECT_EQ(entries_of("/proc/self/task"), threads);
    EXPECT_LT(resident_pages(), memory + 1024 * test::slowdown) << "pages";
    EXPECT_EQ(stacks_mapped(), 0u);
}

}  // namespace
}  // namespace lightnet::least_room_test
