// What photon maps answer at points in media, beside light that is known, and beside paths.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "tests/support/small_media.hpp"
#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::beams_test {
namespace {

using namespace test;

Value number(double value) { return Value{value}; }
Value word(const char* text) { return Value{std::string(text)}; }

// A lamp in the fog, seen by a camera that looks past it. So little is scattered that nothing is twice.
TEST(PhotonBeams, OfAPointLightAreAsBrightAsOneScatteringSays) {
    constexpr float extinction = 0.3f, albedo = 0.005f, g = 0.4f;
    SceneData data;
    data.media.push_back(fog({extinction, extinction, extinction}, {albedo, albedo, albedo}, g));
    data.around = 0;
    add(data, quad({-9, -9, -6}, {18, 0, 0}, {0, 18, 0}), diffuse(data, 0));
    data.lights.push_back(PointLight{{0, 1, 0}, {5, 5, 5}});
    data.camera = camera({0, 0, 3}, {0, 0, 0}, 0.02f);
    data.camera_given = true;
    const PhaseFunction phase = data.media[0].phase;
    double expected = 0;
    constexpr int steps = 100000;
    constexpr double end = 9;  // metres to the wall
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * end / steps, z = 3 - t, d = std::sqrt(1 + z * z);
        expected += extinction * albedo * phase.density(float(z / d)) * 5 / (d * d) * std::exp(-extinction * (t + d)) *
                    end / steps;
    }
    SmallNetwork network(std::move(data), 16, 16);
    network.add("map", "PhotonMap", {},
                {{"paths", word("all")}, {"photons", number(1000)}, {"beams", number(30000)}, {"aim", Value{false}}});
    EXPECT_NEAR(mean_of(network.picture(128)), expected, 0.03 * expected);
    SmallNetwork& progressive = network.add(
        "maps", "ProgressivePhotonMapping", {},
        {{"paths", word("all")}, {"photons", number(1000)}, {"beams", number(4000)}, {"radius", number(0.15)}});
    EXPECT_NEAR(mean_of(progressive.picture(128)), expected, 0.03 * expected);
}

// A room full of fog, with a lamp at its ceiling: all of its light, by paths and by a map.
SceneData foggy_room(const Medium& medium) {
    SceneData data;
    add(data, room(), diffuse(data, 0.6f));
    add(data, quad({0.3f, 0.9f, 0.3f}, {0.4f, 0, 0}, {0, 0, 0.4f}), diffuse(data, 0)).emission =
        AreaEmission{{3, 3, 3}, true};
    data.media.push_back(medium);
    data.around = 0;
    data.camera = camera({0.5f, 0.5f, 0.05f}, {0.5f, 0.4f, 1}, 60);
    data.camera_given = true;
    return data;
}

TEST(PhotonBeams, BringToARoomFullOfFogWhatPathsBring) {
    for (const Medium& medium :
         {fog({1, 1, 1}, {0.8f, 0.8f, 0.8f}, 0.5f), fog({0.5f, 1.5f, 3}, {1, 0.7f, 0.9f}), lumps(4, 0.9f)}) {
        SmallNetwork network(foggy_room(medium), 32, 32);
        network.add("direct", "DirectLighting")
            .add("bounce", "PathTracing")
            .add("paths", "Combine", {"direct", "bounce"});
        const auto exact = network.picture(128);
        network.add("map", "PhotonMap", {},
                    {{"paths", word("all")}, {"photons", number(200000)}, {"beams", number(100000)}});
        const auto mapped = network.picture(32);
        Rgb sum, wanted;
        for (std::size_t i = 0; i < exact.size(); ++i) sum += mapped[i], wanted += exact[i];
        EXPECT_NEAR(sum.r, wanted.r, 0.03 * wanted.r);
        EXPECT_NEAR(sum.g, wanted.g, 0.03 * wanted.g);
        EXPECT_NEAR(sum.b, wanted.b, 0.03 * wanted.b);
    }
}

// A room without lamps, in which something glows: all of its light, by paths and by a map.
SceneData room_with_fire(Medium fire, bool fills_all) {
    fire.emission.value = {4, 2, 1};
    SceneData data = foggy_room(fire);
    data.shapes.back().emission.reset();
    if (fills_all) return data;
    data.around = Query::no_medium;
    add(data, ball({0.6f, 0.4f, 0.6f}, 0.2f), material(data, NoMaterial{})).media = MediumSides{0, Query::no_medium};
    return data;
}

TEST(PhotonMaps, GetTheLightThatFireEmits) {
    Medium flames = lumps(4, 0.5f);
    auto hot = std::make_shared<VolumeGrid>();
    hot->size = {2, 2, 2};
    hot->values = {1, 0, 0, 0, 0, 0.5f, 0, 0};
    flames.emission.grid = hot;
    const std::pair<Medium, bool> fires[] = {
        {fog({1, 2, 4}, {0.5f, 0.2f, 0}), false}, {lumps(4, 0.5f), false}, {flames, true}};
    for (const auto& [fire, fills_all] : fires) {
        SmallNetwork network(room_with_fire(fire, fills_all), 20, 20);
        network.add("seen", "DirectLighting");  // there are no lamps: what the eye sees of the fire itself
        const auto seen = network.picture(256);
        network.add("paths", "PathTracing");
        const auto exact = network.picture(256);
        network.add("map", "PhotonMap", {},
                    {{"paths", word("all")}, {"photons", number(50000)}, {"beams", number(30000)}});
        const auto mapped = network.picture(24);
        network.add("others", "PhotonMap", {},
                    {{"paths", word("diffuse")}, {"photons", number(50000)}, {"beams", number(30000)}});
        const auto others = network.picture(24);
        Rgb sum, wanted, later;
        for (std::size_t i = 0; i < exact.size(); ++i)
            sum += mapped[i] - seen[i], wanted += exact[i] - seen[i], later += others[i] - seen[i];
        EXPECT_NEAR(sum.r, wanted.r, 0.03 * wanted.r);
        EXPECT_NEAR(sum.g, wanted.g, 0.03 * wanted.g);
        EXPECT_NEAR(sum.b, wanted.b, 0.03 * wanted.b);
        // Each map is off by a hundredth or so; without what media emit tens of hundredths would be missing.
        EXPECT_NEAR(later.g, sum.g, 0.05 * sum.g) << "what media emit counts as scattered by them";
    }
}

TEST(FinalGather, SeesWhatFireEmitsAsPathsDo) {
    SmallNetwork network(room_with_fire(fog({1, 2, 4}, {0.5f, 0.2f, 0}), false), 20, 20);
    network.add("paths", "PathTracing", {}, {{"paths", word("all")}});
    const double exact = mean_of(network.picture(256));
    network.add("gathered", "FinalGather", {"paths"});
    EXPECT_NEAR(mean_of(network.picture(256)), exact, 0.02 * exact);
    network.add("seen", "DirectLighting");
    EXPECT_LT(mean_of(network.picture(256)), 0.9 * exact) << "or this says nothing";
}

// Under a glass ball in fog. Paths find the lamp through the glass, as it is large; direct light does not.
TEST(PhotonBeams, OfGlassAreTheLightThatPathsFindThroughIt) {
    SceneData data;
    add(data, ball({0, 0, 0}, 0.5f), material(data, DielectricMaterial{}));
    add(data, quad({-0.7f, 2, -0.7f}, {0, 0, 1.4f}, {1.4f, 0, 0}), diffuse(data, 0)).emission =
        AreaEmission{{10, 10, 10}, true};
    add(data, quad({-3, -1.6f, -3}, {0, 0, 6}, {6, 0, 0}), diffuse(data, 0));
    data.media.push_back(fog({0.05f, 0.05f, 0.05f}, {0.02f, 0.02f, 0.02f}));
    data.around = 0;
    data.camera = camera({0, -1, 3}, {0, -1, 0}, 12);
    data.camera_given = true;
    SmallNetwork network(std::move(data), 24, 24);
    const double exact = [&] {
        network.add("bounce", "PathTracing");
        return mean_of(network.picture(4096));
    }();
    network.add("map", "PhotonMap", {},
                {{"photons", number(10000)}, {"beams", number(200000)}, {"radius", number(0.03)}});
    const double mapped = mean_of(network.picture(256));
    EXPECT_GT(exact, 0);
    EXPECT_NEAR(mapped, exact, 0.05 * exact);
    network.add("none", "PhotonMap", {}, {{"photons", number(10000)}, {"beams", number(0)}});
    EXPECT_LT(mean_of(network.picture(16)), 1e-3 * exact);
}

}  // namespace
}  // namespace lightnet::beams_test
