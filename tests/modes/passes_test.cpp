// Nodes that learn anew for each pass of the picture: the same bytes in all modes, and two passes in memory at most.
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <string>

#include "tests/modes/daemons.hpp"
#include "tests/modes/learning.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::passes_test {
namespace {

using namespace std::chrono_literals;
using namespace test;
using Words = std::vector<std::string>;

std::atomic<int> tables{0}, most_tables{0};

// What one pass has prepared; how many there are in the process is counted.
struct Table {
    explicit Table(float of) : value(of) {
        const int now = ++tables;
        for (int most = most_tables; now > most && !most_tables.compare_exchange_weak(most, now);) {
        }
    }
    Table(Table&& other) noexcept : value(other.value) { ++tables; }
    ~Table() { --tables; }
    float value;
};

// Dims the light of its input, differently in each pass.
class Moody final : public LightOp {
public:
    explicit Moody(const NodeContext& here) : inputs_(here.inputs()), pass_(here.pass()) {}
    void prepare(Services& services) override {
        const auto parts = services.map<float>(12, [this](std::size_t shard, std::vector<float>& out) {
            out.push_back(float(child(5, pass_, shard) % 1000) * 1e-4f);
        });
        table_ = services.once<Table>([&] {
            float sum = 0;
            for (const float part : parts) sum += part;
            return Table(sum);
        });
    }
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        const float tint = table_ ? table_->value : 1;
        const auto part = ask(inputs_, 0, questions);
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = part.answers[i] * tint;
    }

private:
    Inputs inputs_;
    std::uint32_t pass_;
    std::shared_ptr<const Table> table_;
};

Registry with_moods() {
    Kind moody{.name = "Moody", .help = "for tests", .inputs = {1, 1}, .run = {.prepares = true, .passes = true}};
    moody.make_light = [](const NodeContext& here) { return std::make_unique<Moody>(here); };
    auto kinds = standard_nodes();
    kinds.push_back(moody);
    kinds.push_back(learner());
    return Registry(std::move(kinds));
}

// image ← both ← moody ← direct, (learned ← moody): what learns from it learns anew as well.
std::vector<Node> moody_nodes() {
    const auto ref = [](const char* name) { return Value{NodeRef{name}}; };
    return {node("scene", "Scene", {Value{std::string("none.pbrt")}}),
            node("direct", "DirectLighting", {}),
            node("moody", "Moody", {ref("direct")}),
            node("learned", "Learner", {ref("moody")}, {{"stride", Value{4.0}}}),
            node("both", "Combine", {ref("moody"), ref("learned")}),
            node("image", "RayTracer", {ref("both")}, seen())};
}

struct MoodyNetwork : Learning {
    explicit MoodyNetwork(std::uint32_t samples_per_pixel) : Learning(with_moods(), moody_nodes()) {
        tiles.clear();
        for (const Tile& tile : tiles_of(width, height, 8, samples_per_pixel))
            for (const Tile& block : one_by_one(tile)) tiles.push_back(block);
    }
};

TEST(Passes, GiveTheSameBytesInThreadsAndOnHosts) {
    const MoodyNetwork learning(40);
    const auto expected = learning.serial();
    for (const std::uint32_t threads : {1u, 3u}) {
        const auto whole = plan(learning.network->graph, learning.registry, {}, {{"", threads}});
        EXPECT_EQ(learning.threaded(whole, {}), expected) << threads << " whole networks";
        EXPECT_EQ(learning.threaded(spread(learning.network->graph.nodes.size(), threads), {}), expected)
            << "spread over " << threads;
    }
    const Folder folder;
    HostThread one(learning.registry, 2, folder.file("one")), two(learning.registry, 1, folder.file("two"));
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
    cluster.gather(slowdown * 20s, never);
    EXPECT_EQ(learning.networked(cluster), expected);
    cluster.finish();
}

TEST(Passes, GiveTheSameBytesWhenAHostLeavesInOne) {
    MoodyNetwork learning(48);
    const auto expected = learning.serial();
    const Folder folder;
    HostThread one(learning.registry, 1, folder.file("one")), two(learning.registry, 1, folder.file("two"));
    const std::atomic<bool> never{false};
    Cluster cluster(cluster_of(learning, {one.endpoint(), two.endpoint()}));
    cluster.gather(slowdown * 20s, never);
    learning.between_passes = [&](std::uint32_t pass) {
        if (pass == 1) two.leave();
    };
    EXPECT_EQ(learning.networked(cluster), expected);
    cluster.finish();
}

// In the order of a picture, that is, pass by pass; and from the middle on, as a run does that was resumed.
TEST(Passes, DoNotDependOnThoseBefore) {
    const MoodyNetwork learning(64);
    const auto all = learning.serial();
    MoodyNetwork rest(64);
    const auto is_early = [](const Tile& tile) { return tile.block() < 2; };
    const auto early = std::count_if(rest.tiles.begin(), rest.tiles.end(), is_early);
    std::erase_if(rest.tiles, is_early);
    const auto whole = plan(rest.network->graph, rest.registry, {}, {{"", 2}});
    ThreadedRun run(rest.network, 1, whole, {});
    Coordinator coordinator(rest.options(), run.carrier());
    coordinator.begin_pass(2);
    coordinator.propose(whole);
    const auto late = rest.render(coordinator);
    run.stop();
    std::vector<Pixels> expected;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (!is_early(learning.tiles[i])) expected.push_back(all[i]);
    ASSERT_GT(early, 0);
    EXPECT_EQ(late, expected);
}

TEST(Passes, KeepTwoInMemoryHoweverManyThereAre) {
    const MoodyNetwork learning(16 * 12);
    for (const bool threads : {false, true}) {
        ASSERT_EQ(tables, 0);
        most_tables = 0;
        if (threads)
            learning.threaded(plan(learning.network->graph, learning.registry, {}, {{"", 2}}), {});
        else
            learning.serial();
        EXPECT_LE(most_tables, 4) << "now and before; while one is made, its copy; and one that a late place holds";
        EXPECT_GE(most_tables, 2);
    }
}

// The network of figure 5 with progressive photons in place of its maps, asked by the renderer and by a cache.
class ProgressiveNetwork : public ::testing::Test {
protected:
    static std::string graph_in(const Folder& folder) {
        for (const char* scene : {"glass_ball.pbrt", "cornell_box.pbrt"})
            std::ofstream(folder / scene) << bytes_of(graph_file(scene));
        std::ofstream(folder / "progressive5.lua")
            << "scene    = Scene { 'glass_ball.pbrt' }\n"
               "direct   = DirectLighting {}\n"
               "caustics = ProgressivePhotonMapping { paths = 'caustic', photons = 500 }\n"
               "global   = ProgressivePhotonMapping { paths = 'diffuse', photons = 500 }\n"
               "first    = Combine { direct, caustics, global }\n"
               "soft     = IrradianceCache { first, rays = 16, stride = 8 }\n"
               "lighting = Combine { direct, caustics, soft }\n"
               "image    = RayTracer { lighting, scene = scene, samples = 72, film = { 32, 32 } }\n";
        return folder / "progressive5.lua";
    }
    Launch run(const Words& more) {
        Words words{"--progress", "none", "--cache", "none", "--tile", "16"};
        words.insert(words.end(), more.begin(), more.end());
        return launch(graph, folder, words);
    }
    Folder folder;
    std::string graph = graph_in(folder);
};

TEST_F(ProgressiveNetwork, GivesTheSameBytesInEveryModeAndWhenAWorkerDies) {
    const auto serial = run({"--threads", "1"});
    ASSERT_EQ(serial.code, 0) << serial.said;
    for (const Words& mode : {Words{"--threads", "3"}, {"--local-workers", "2"}}) {
        const auto other = run(mode);
        EXPECT_EQ(other.code, 0) << other.said;
        EXPECT_TRUE(other.picture == serial.picture) << mode[0];
    }
    const Daemon stays(folder);
    auto dies = std::make_unique<Daemon>(folder);
    std::ofstream(folder / "hosts.lua") << "place \"" << stays.endpoint << "\" { places = 1 }\nplace \""
                                        << dies->endpoint << "\" { places = 1 }\n";
    Process going(
        launch_words(graph, folder / "killed.exr",
                     {"--progress", "json", "--cache", "none", "--tile", "16", "--hosts", folder / "hosts.lua"}));
    ASSERT_TRUE(going.wait_for("\"event\":\"progress\"")) << going.output();
    dies->process->signal(SIGKILL);
    const auto killed = finish(going, folder / "killed.exr");
    EXPECT_EQ(killed.code, 0) << killed.said;
    EXPECT_TRUE(killed.picture == serial.picture) << "with a worker killed";
}

TEST_F(ProgressiveNetwork, GoesOnInTheMiddleWithTheBytesOfAllAtOnce) {
    const auto at_once = run({"--threads", "2"});
    ASSERT_EQ(at_once.code, 0) << at_once.said;
    const Folder elsewhere;
    const auto out = elsewhere / "picture.exr";
    Words words{"--progress", "none", "--cache", "none", "--tile", "16"};
    for (const Words& step : {Words{"--samples", "20", "--threads", "2"},
                              {"--samples", "40", "--threads", "1", "--resume"},
                              {"--local-workers", "1", "--resume"}}) {
        auto all = words;
        all.insert(all.end(), step.begin(), step.end());
        Process going(launch_words(graph, out, all));
        const auto part = finish(going, out);
        ASSERT_EQ(part.code, 0) << part.said;
        EXPECT_EQ(part.picture == at_once.picture, step.front() != "--samples");
    }
}

}  // namespace
}  // namespace lightnet::passes_test
