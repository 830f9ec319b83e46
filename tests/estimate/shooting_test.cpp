#include "core/estimate/shooting.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/support/small_scenes.hpp"

namespace lightnet::shooting_test {
namespace {

using namespace test;

/// Loops.
class InOneThread final : public Services {
public:
    std::vector<Query> rehearse(std::uint32_t) override { return {}; }
    void say(const std::string&) override {}
    void doing(const std::string&, std::uint64_t, std::uint64_t) override {}
    void look() const override {}

protected:
    Bytes map_bytes(std::size_t count, const Shard& work) override {
        std::vector<std::vector<std::byte>> shards(count);
        for (std::size_t i = 0; i < count; ++i) work(i, shards[i]);
        return join_shards(shards);
    }
    std::shared_ptr<const void> once_any(const Make& make) override {
        OneBuilder alone;
        return make(alone);
    }
};

// Light paths that a map decides to send on a machine with so much memory, when its error asks for more than fit.
std::uint64_t emitted_with(const Scene& scene, std::uint64_t memory) {
    const Node node{"map",
                    "PhotonMap",
                    {},
                    {{"photons", Value{0.0}},
                     {"paths", Value{"all"}},
                     {"aim", Value{false}},
                     {"memory", Value{0.0}},
                     {"error", Value{0.0001}}},
                    {}};
    const NodeContext here(node, {}, scene, 1, {.whereabouts = [=] { return Whereabouts{.memory = memory}; }});
    Shooting shooting = Shooting::with_error(here);
    InOneThread services;
    const auto aim = take_aim(services, scene, shooting);
    take_spread(services, scene, shooting, *aim, 50, 0.1f);
    return shooting.emitted;
}

TEST(Shooting, LooksForCausticsOnlyWhereSomethingCouldMakeThem) {
    SceneData data;
    add(data, quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), diffuse(data, 0.5f));
    EXPECT_FALSE(may_keep_any(Scene(data), PhotonPaths::caustic));
    EXPECT_TRUE(may_keep_any(Scene(data), PhotonPaths::diffuse));
    add(data, quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), mirror(data, 0.9f));
    EXPECT_TRUE(may_keep_any(Scene(data), PhotonPaths::caustic));
}

TEST(Shooting, SendsAsManyPhotonsOnEveryMachine) {
    const Scene scene(furnace(0.5f, 1));
    const auto few = emitted_with(scene, std::uint64_t{1} << 30);
    EXPECT_GT(few, 1'000'000u);
    EXPECT_EQ(emitted_with(scene, std::uint64_t{256} << 30), few) << "or hosts would not agree on a picture";
}

}  // namespace
}  // namespace lightnet::shooting_test
