// Kinds of light paths: what paths bring is told apart, and is the same light.
#include "core/scene/path_kinds.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::path_kinds_test {
namespace {

using namespace test;

constexpr std::size_t at(PathKind kind) { return static_cast<std::size_t>(kind); }

SmallNetwork::Params all_paths() { return {{"paths", Value{std::string("all")}}, {"samples", Value{4.0}}}; }

/// A floor, a lamp above it, and whatever else a test adds.
SceneData lit_floor() {
    SceneData data;
    data.camera = camera({0, 1.5f, 3}, {0, 0.2f, 0}, 40);
    data.camera_given = true;
    add(data, quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}), diffuse(data, 0.5f));
    add(data, quad({-0.3f, 3, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), diffuse(data, 0)).emission =
        AreaEmission{{10, 10, 10}, true};
    return data;
}

struct Found {
    LightByKind kinds{};
    double all = 0;  // of the picture, without what is seen of the lamp
    double part(PathKind kind) const { return kinds[at(kind)] / std::accumulate(kinds.begin(), kinds.end(), 0.0); }
};

Found found_in(const SceneData& data) {
    SmallNetwork network(data, 24, 24);
    network.add("paths", "PathTracing", {}, all_paths());
    Found found;
    PathKindWatch watch;
    for (const Rgb& pixel : network.pictures(16).at("paths")) found.all += double{luminance(pixel)};
    found.kinds = watch.take();
    return found;
}

TEST(PathKinds, AreDirectOnABareFloor) { EXPECT_GT(found_in(lit_floor()).part(PathKind::direct), 0.999); }

TEST(PathKinds, AreSoftBetweenWalls) {
    auto data = lit_floor();
    add(data, quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}), diffuse(data, 0.5f));
    const auto found = found_in(data);
    EXPECT_GT(found.part(PathKind::soft), 0.02);
    EXPECT_NEAR(found.part(PathKind::soft) + found.part(PathKind::direct), 1, 1e-6);
}

TEST(PathKinds, AreCausticsBelowGlass) {
    auto data = lit_floor();
    add(data, ball({0, 0.7f, 0}, 0.5f), material(data, DielectricMaterial{}));
    EXPECT_GT(found_in(data).part(PathKind::caustic), 0.05);
}

TEST(PathKinds, AreMirroredWhereAMirrorShowsALitWall) {
    auto data = lit_floor();
    add(data, quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}), mirror(data, 0.9f));
    add(data, quad({-1, 0, 1}, {0, 0, -2}, {0, 2, 0}), diffuse(data, 0.8f));
    EXPECT_GT(found_in(data).part(PathKind::mirrored), 0.01);
}

TEST(PathKinds, AreShiningOnVarnish) {
    auto data = lit_floor();
    data.materials[data.shapes[0].material].model =
        CoatedDiffuseMaterial{colour(data, {0.1f, 0.1f, 0.1f}), 1.5f, {0.1f, 0.1f}};
    add(data, quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}), diffuse(data, 0.5f));
    EXPECT_GT(found_in(data).part(PathKind::shining), 0.005);
}

// Nobody who watches changes the picture, but for the last bits.
TEST(PathKinds, LeaveTheLightAsItIs) {
    auto data = lit_floor();
    add(data, ball({0, 0.7f, 0}, 0.5f), material(data, DielectricMaterial{}));
    SmallNetwork network(data, 24, 24);
    network.add("paths", "PathTracing", {}, all_paths());
    const auto alone = network.picture(16);
    PathKindWatch watch;
    const auto watched = network.picture(16);
    ASSERT_EQ(alone.size(), watched.size());
    for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_NEAR(watched[i].g, alone[i].g, 1e-5f * (1 + alone[i].g)) << i;
}

}  // namespace
}  // namespace lightnet::path_kinds_test
