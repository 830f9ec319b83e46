// Reads of the scene that a node's kind has not declared end a run, and say which node reads what.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "core/base/error.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/light/light_op.hpp"
#include "core/run/serial/serial.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::declared_reads_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Looks at the camera where it is told to.
class Spy final : public LightOp {
public:
    explicit Spy(const NodeContext& here) : scene_(here.scene()), when_(here.text("when")) {
        if (when_ == "made") scene_.camera();
    }
    void prepare(Services&) override {
        if (when_ == "prepared") scene_.camera();
    }
    void light(std::span<const Query>, std::span<Rgb>) const override {
        if (when_ == "asked") scene_.camera();
    }

private:
    const Scene& scene_;
    std::string when_;
};

Kind spy(std::function<SceneParts(const Node&)> reads) {
    Kind kind;
    kind.name = "Spy";
    kind.help = "looks where it should not";
    kind.params = {{.name = "when", .type = ParamType::text, .help = "it looks"}};
    kind.light.paths = always({});
    kind.run.prepares = true;
    kind.reads = std::move(reads);
    kind.make_light = [](const NodeContext& here) { return std::make_unique<Spy>(here); };
    return kind;
}

// "" or what ends a run with such a node.
std::string end_of_run(const std::string& when, std::function<SceneParts(const Node&)> reads) {
    Registry registry{standard_nodes()};
    registry.add({spy(std::move(reads))});
    SceneData data;
    test::add(data, test::quad({-9, -9, 1}, {0, 18, 0}, {18, 0, 0}), test::diffuse(data, 0.5f));
    data.camera_given = true;
    const auto scene = std::make_shared<const Scene>(std::move(data), SceneOptions{.width = 2, .height = 2});
    const Value film{Table{{Value{2.0}, Value{2.0}}, {}}};
    const Graph graph{"test.lua",
                      {{"room", "Scene", {Value{std::string("none.pbrt")}}, {}, {}},
                       {"mole", "Spy", {}, {{"when", Value{when}}}, {}},
                       {"image",
                        "RayTracer",
                        {Value{NodeRef{"mole"}}},
                        {{"scene", Value{NodeRef{"room"}}}, {"film", film}, {"samples", Value{1.0}}},
                        {}}}};
    const Network network{check(graph, registry), registry, scene};
    try {
        SerialRun run(network);
        run.prepare("");
        run.render({0, 0, 2, 2, 0, 1, 1});
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

class DeclaredReads : public testing::TestWithParam<const char*> {};

TEST_P(DeclaredReads, HoldTheNodeToThem) {
    EXPECT_THAT(
        end_of_run(GetParam(), reading(scene_of_light)),
        AllOf(HasSubstr("'mole'"), HasSubstr("it reads camera"), HasSubstr("geometry, materials, lamps, media")));
}

TEST_P(DeclaredReads, LetItReadWhatTheyName) { EXPECT_EQ(end_of_run(GetParam(), reading(ScenePart::camera)), ""); }

TEST_P(DeclaredReads, AreEverythingWhereAKindSaysNothing) { EXPECT_EQ(end_of_run(GetParam(), {}), ""); }

TEST_P(DeclaredReads, MayDependOnTheNode) {
    const auto by_name = [](const Node& node) {
        return node.name == "mole" ? SceneParts() : SceneParts(ScenePart::camera);
    };
    EXPECT_THAT(end_of_run(GetParam(), by_name), HasSubstr("declares that it reads nothing"));
}

INSTANTIATE_TEST_SUITE_P(WhenItLooks, DeclaredReads, testing::Values("made", "prepared", "asked"),
                         [](const auto& when) { return std::string(when.param); });

TEST(ShippedKinds, DeclareWhatTheyRead) {
    for (const Kind& kind : standard_nodes()) EXPECT_TRUE(kind.reads) << kind.name;
}

}  // namespace
}  // namespace lightnet::declared_reads_test
