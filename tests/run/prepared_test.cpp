#include "core/run/assembly/prepared.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "core/network/graph/check.hpp"
#include "core/network/light/mapped.hpp"
#include "core/network/light/rehearsal.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/serial/serial.hpp"
#include "tests/support/learner.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::prepared_test {
namespace {

using testing::ElementsAre;

Node node(std::string name, std::string kind, std::vector<Value> entries, std::map<std::string, Value> params = {}) {
    return {std::move(name), std::move(kind), std::move(entries), std::move(params), {"test.lua", 1}};
}

// image ← learner ← direct
Graph learning_graph(const Registry& registry, double stride = 4) {
    Graph graph{"test.lua", {}};
    graph.nodes = {
        node("scene", "Scene", {Value{std::string("none.pbrt")}}),
        node("direct", "DirectLighting", {}),
        node("learned", "Learner", {Value{NodeRef{"direct"}}}, {{"stride", Value{stride}}}),
        node("image", "RayTracer", {Value{NodeRef{"learned"}}},
             {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{24.0}, Value{16.0}}, {}}}}}),
    };
    return check(graph, registry);
}

std::shared_ptr<const Network> network_of(const Graph& graph, const Registry& registry) {
    SceneOptions options;
    options.width = 24, options.height = 16;
    return std::make_shared<const Network>(
        Network{graph, registry, std::make_shared<const Scene>(test::furnace(0.5f, 1), options), 1});
}

// Remembers in memory.
class MemoryCache final : public ResultCache {
public:
    Result find(const Hash& recipe) const override {
        const auto found = results.find(recipe);
        return found == results.end() ? Result{} : found->second;
    }
    void keep(const Hash& recipe, const Result& result) override { results[recipe] = result; }
    std::map<Hash, Result> results;
};

TEST(Mapped, GivesShardsAndAllOfThemInOrder) {
    std::vector<std::vector<std::byte>> shards(3);
    const std::vector<std::uint32_t> numbers{1, 2, 3};
    const auto* bytes = reinterpret_cast<const std::byte*>(numbers.data());
    shards[0].assign(bytes, bytes + 4);
    shards[2].assign(bytes + 4, bytes + 12);
    const Mapped<std::uint32_t> mapped(join_shards(shards));
    EXPECT_EQ(mapped.shards(), 3u);
    EXPECT_THAT(mapped.shard(0), ElementsAre(1));
    EXPECT_THAT(mapped.shard(1), ElementsAre());
    EXPECT_THAT(mapped.all(), ElementsAre(1, 2, 3));
    EXPECT_EQ(Mapped<std::uint32_t>(join_shards(std::span<const std::vector<std::byte>>())).size(), 0u);
}

TEST(Mapped, RefusesBytesThatWereCut) {
    const std::vector<std::vector<std::byte>> shards(2, std::vector<std::byte>(8));
    const auto whole = join_shards(shards);
    for (std::size_t size = 0; size < whole->size(); ++size)
        EXPECT_THROW(
            Mapped<std::uint64_t>(std::make_shared<std::vector<std::byte>>(whole->begin(), whole->begin() + size)),
            Error);
}

TEST(Rehearsal, GivesEachQuestionOnceInAnOrderOfItsOwn) {
    Rehearsal rehearsal;
    const Query a{.stream = 1}, b{.stream = 2}, c{.stream = 2, .sample = 1};
    rehearsal.note(c);  // not on: forgotten
    rehearsal.begin();
    for (const auto& q : {c, a, b, c, b}) rehearsal.note(q);
    EXPECT_THAT(rehearsal.end(), ElementsAre(a, b, c));
    EXPECT_FALSE(rehearsal.on());
    EXPECT_THAT(rehearsal.end(), ElementsAre());
}

// A second copy of a tile, which nobody waits for any more, asks on while the next pass rehearses.
TEST(Rehearsal, NotesNoQuestionsOfAnotherPass) {
    Rehearsal rehearsal;
    const Query before{.stream = 1, .pass = 1}, now{.stream = 2, .pass = 2};
    rehearsal.begin(2);
    for (const auto& q : {before, now}) rehearsal.note(q);
    EXPECT_THAT(rehearsal.end(), ElementsAre(now));
    rehearsal.begin();
    for (const auto& q : {before, now}) rehearsal.note(q);
    EXPECT_THAT(rehearsal.end(), ElementsAre(before, now));
}

TEST(RehearsalTiles, CoverTheFilm) {
    const auto registry = test::with_learner();
    std::size_t pixels = 0;
    for (const auto& tile : rehearsal_tiles(learning_graph(registry), registry, 2)) {
        pixels += tile.pixels();
        EXPECT_EQ(tile.stride, 2u);
    }
    EXPECT_EQ(pixels, 24u * 16);
}

// Rehearsals change what others would note in theirs, so who rehearses is alone.
TEST(Stages, AreOfNodesThatCannotAskEachOther) {
    const auto registry = test::with_learner();
    Graph graph{"test.lua", {}};
    const auto ref = [](const char* name) { return Value{NodeRef{name}}; };
    graph.nodes = {
        node("scene", "Scene", {Value{std::string("none.pbrt")}}),
        node("direct", "DirectLighting", {}),
        node("caustics", "PhotonMap", {}),
        node("early", "Learner", {ref("direct")}),
        node("global", "PhotonMap", {}, {{"paths", Value{"diffuse"}}}),
        node("records", "PhotonIrradiance", {}, {{"of", ref("global")}}),
        node("late", "Learner", {ref("early")}),
        node("all", "Combine", {ref("direct"), ref("caustics"), ref("records"), ref("late")}),
        node("image", "RayTracer", {ref("all")},
             {{"scene", ref("scene")}, {"film", Value{Table{{Value{24.0}, Value{16.0}}, {}}}}}),
    };
    graph = check(graph, registry);
    const auto nodes = preparing_nodes(graph, registry);
    std::vector<std::string> names;
    for (const auto node : nodes) names.push_back(graph.nodes[node].name);
    ASSERT_THAT(names, ElementsAre("caustics", "global", "early", "records", "late"));
    EXPECT_THAT(stages_of(nodes, graph, registry), ElementsAre(0, 0, 2, 3, 4));
}

TEST(SerialRun, TellsOfACoarseLookWhatIsLookedAtAlone) {
    const auto registry = test::with_learner();
    const auto network = network_of(learning_graph(registry), registry);
    SerialRun run(*network);
    run.prepare("", nullptr);
    const Tile fine{3, 2, 7, 5, 0, 1};
    Tile coarse = fine;
    coarse.stride = coarse_stride, coarse.coarse = 1;
    const auto all = run.render(fine), some = run.render(coarse);
    const std::size_t colours = all.size() / fine.pixels();
    std::vector<Rgb> wanted;
    for (std::size_t y = 0; y < fine.height; y += coarse_stride)
        for (std::size_t x = 0; x < fine.width; x += coarse_stride)
            for (std::size_t k = 0; k < colours; ++k) wanted.push_back(all[(y * fine.width + x) * colours + k]);
    EXPECT_EQ(some, wanted);
    EXPECT_EQ(some.size(), 4 * 3 * colours);
}

TEST(SerialRun, SaysWhenAKindRehearsesUnannounced) {
    auto kinds = standard_nodes();
    kinds.push_back(test::learner());
    kinds.back().run.rehearses = false;
    const Registry registry(std::move(kinds));
    const auto network = network_of(learning_graph(registry), registry);
    SerialRun run(*network);
    try {
        run.prepare("", nullptr);
        FAIL() << "it rehearsed";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("Learner 'learned', preparing: it asks for a rehearsal"));
    }
}

TEST(Recipes, DependOnWhatANodeAsksAndOnNothingAboveIt) {
    const auto registry = test::with_learner();
    const auto graph = learning_graph(registry);
    auto other_film = graph, other_rays = graph;
    other_film.nodes[3].params["samples"] = Value{64.0};
    other_rays.nodes[1].params["samples"] = Value{64.0};
    const Recipes a(graph, "scene"), b(other_film, "scene"), c(other_rays, "scene"), d(graph, "another scene");
    EXPECT_EQ(a.of(2, 0, false), b.of(2, 0, false));
    EXPECT_NE(a.of(2, 0, true), b.of(2, 0, true)) << "a rehearsal sees the whole graph";
    EXPECT_NE(a.of(2, 0, false), c.of(2, 0, false));
    EXPECT_NE(a.of(2, 0, false), d.of(2, 0, false));
    EXPECT_NE(a.of(2, 0, false), a.of(2, 1, false));
}

TEST(Recipes, DependOnWhatTheGraphChangesAboutTheScene) {
    const auto registry = test::with_learner();
    const auto graph = learning_graph(registry);
    const auto changed = [&](const char* param, Value value) {
        auto other = graph;
        for (auto& node : other.nodes)
            if (node.kind == "Scene") node.params[param] = value;
        return Recipes(other, "scene").of(2, 0, false);
    };
    const Hash plain = Recipes(graph, "scene").of(2, 0, false);
    EXPECT_NE(changed("material", Value{std::string("clay")}), plain);
    EXPECT_NE(changed("groups", Value{Table{{}, {{"key", Value{std::string("spot")}}}}}), plain);
    EXPECT_EQ(changed("camera", Value{Table{{}, {{"fov", Value{30.0}}}}}), plain) << "who looks changes nothing";
}

/// A job whose picture is lit by photons, of a scene that stays in memory.
class PhotonJob {
public:
    PhotonJob() {
        Graph graph{"test.lua", {}};
        graph.nodes = {
            node("scene", "Scene", {Value{std::string("none.pbrt")}}),
            node("photons", "PhotonMap", {}, {{"photons", Value{2000.0}}, {"paths", Value{std::string("all")}}}),
            node("image", "RayTracer", {Value{NodeRef{"photons"}}},
                 {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{4.0}, Value{4.0}}, {}}}}}),
        };
        job_.graph = check(graph, registry_);
        job_.isa = "avx2";
        job_.width = job_.height = 4;
    }
    Job& job() { return job_; }
    // How many results are kept anew when the nodes prepare for this scene.
    std::size_t prepared_anew(const SceneData& scene) {
        LoadedScene loaded{scene};
        const MadeFrom made = made_from(job_, registry_, loaded);
        const auto network = build_network(job_, registry_, std::move(loaded));
        const std::size_t before = cache_.results.size();
        SerialRun(*network).prepare(made, &cache_);
        return cache_.results.size() - before;
    }

private:
    Registry registry_ = test::with_learner();
    Job job_;
    MemoryCache cache_;
};

TEST(Recipes, LetPhotonsServeUnderAnotherCameraExposureAndFile) {
    PhotonJob photons;
    SceneData scene = test::furnace(0.5f, 1);
    ASSERT_GT(photons.prepared_anew(scene), 0u);
    scene.camera.to_world.m[0][3] += 0.25;
    scene.film.scale = 2;
    photons.job().scene = "another.pbrt";
    EXPECT_EQ(photons.prepared_anew(scene), 0u);
    photons.job().width = 8;
    EXPECT_EQ(photons.prepared_anew(scene), 0u) << "the picture is larger";
}

TEST(Recipes, HavePhotonsShotAnewWhereLightGoesOtherWays) {
    PhotonJob photons;
    const SceneData scene = test::furnace(0.5f, 1);
    ASSERT_GT(photons.prepared_anew(scene), 0u);
    const auto anew = [&](const std::function<void(SceneData&)>& change) {
        SceneData other = scene;
        change(other);
        return photons.prepared_anew(other);
    };
    EXPECT_GT(anew([](SceneData& other) { other.textures[0].scale.r = 0.25f; }), 0u);
    EXPECT_GT(anew([](SceneData& other) { other.lights.push_back(PointLight{{0, 0, 0}, {1, 1, 1}}); }), 0u);
    EXPECT_GT(anew([](SceneData& other) { other.shapes.push_back(other.shapes.front()); }), 0u);
    photons.job().seed = 7;
    EXPECT_GT(photons.prepared_anew(scene), 0u);
}

TEST(SerialRun, PreparesOnceAndTakesTheRestFromTheCache) {
    const auto registry = test::with_learner();
    const auto network = network_of(learning_graph(registry), registry);
    const Tile tile{0, 0, 24, 16, 0, 4};
    MemoryCache cache;
    SerialRun first(*network);
    first.prepare("", &cache);
    const auto picture = first.render(tile);
    EXPECT_EQ(cache.results.size(), 5u) << "three maps and two rehearsals";
    const auto questions = first.counters().local_questions;

    SerialRun second(*network);
    second.prepare("", &cache);
    EXPECT_EQ(second.counters().local_questions, 0u) << "nothing was asked again";
    EXPECT_EQ(second.render(tile), picture);
    EXPECT_GT(questions, second.counters().local_questions);

    SerialRun watched(*network);
    std::vector<PrepareProgress> told;
    watched.watch([&](const PrepareProgress& progress) { told.push_back(progress); });
    watched.prepare("");
    EXPECT_EQ(told.front(), (PrepareProgress{told[0].node, 1, 1, 0, 0}));
    EXPECT_EQ(told.at(1).total, 9u) << "nine shards come first";
    EXPECT_EQ(told.at(9).done, 8u);

    SerialRun unprepared(*network);
    EXPECT_NE(unprepared.render(tile), picture) << "what was prepared counts";
}

}  // namespace
}  // namespace lightnet::prepared_test
