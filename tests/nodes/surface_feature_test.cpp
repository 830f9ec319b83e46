#include <gmock/gmock.h>

#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::surface_feature_test {
namespace {

using namespace test;

// A wall at z = 0, of that albedo, seen from 2 before it.
SceneData wall(float albedo, float mirrored = 0) {
    SceneData data;
    add(data, quad({-100, -100, 0}, {200, 0, 0}, {0, 200, 0}),
        mirrored > 0 ? mirror(data, mirrored) : diffuse(data, albedo));
    data.camera = camera({0, 0, 2}, {0, 0, 0}, 60);
    data.camera_given = true;
    return data;
}

std::map<std::string, std::vector<Rgb>> features_of(SceneData data) {
    SmallNetwork network(std::move(data), 4, 4);
    std::vector<std::string> names;
    for (const char* of : {"albedo", "normal", "depth"}) {
        network.add(of, "SurfaceFeature", {}, {{"of", Value{std::string(of)}}});
        names.emplace_back(of);
    }
    network.add("direct", "DirectLighting").lit_by("direct").show(names);
    return network.pictures(4);
}

TEST(SurfaceFeature, TellsOfTheSurfaceThatIsSeen) {
    const auto features = features_of(wall(0.25f));
    EXPECT_NEAR(features.at("albedo")[5].g, 0.25f, 1e-5f);
    EXPECT_NEAR(features.at("normal")[5].b, 1, 1e-5f);
    EXPECT_GT(features.at("depth")[5].r, 2);
}

TEST(SurfaceFeature, TellsNothingOfMirrorsThatShowNothing) {
    const auto features = features_of(wall(0, 0.5f));
    for (const auto& [name, pixels] : features) EXPECT_EQ(pixels[5], Rgb{}) << name;
}

TEST(SurfaceFeature, TellsThroughMirrorsByWhatTheyReflect) {
    SceneData data = wall(0, 0.5f);
    add(data, quad({-100, -100, 4}, {0, 200, 0}, {200, 0, 0}), diffuse(data, 0.8f));  // behind the eye
    const auto features = features_of(std::move(data));
    EXPECT_NEAR(features.at("albedo")[5].g, 0.5f * 0.8f, 1e-3f);
    EXPECT_NEAR(features.at("normal")[5].b, -0.5f, 1e-3f);
}

TEST(SurfaceFeature, TellsOfATextureBehindGlassByWhatGetsThrough) {
    // a wall of two albedos behind a pane of a dielectric, which sends them on in proportion
    SceneData data = wall(0.2f);
    add(data, quad({0, -100, 0.01f}, {200, 0, 0}, {0, 200, 0}), diffuse(data, 0.8f));
    DielectricMaterial pane;
    pane.thin = true;
    add(data, quad({-100, -100, 1}, {200, 0, 0}, {0, 200, 0}), material(data, pane));
    SmallNetwork network(std::move(data), 8, 8);
    network.add("albedo", "SurfaceFeature", {}, {{"of", Value{std::string("albedo")}}});
    network.add("direct", "DirectLighting").lit_by("direct").show({"albedo"});
    const auto albedo = network.pictures(64).at("albedo");
    double left = 0, right = 0;
    for (std::size_t y = 0; y < 8; ++y) left += albedo[8 * y + 1].g / 8, right += albedo[8 * y + 6].g / 8;
    EXPECT_GT(left, 0.2 * 0.7);
    EXPECT_LT(left, 0.2);
    EXPECT_NEAR(right / left, 4, 0.5);  // of binomial noise .08: 512 samples, of which a tenth is reflected
}

}  // namespace
}  // namespace lightnet::surface_feature_test
