// Paths that are guided find the light that others find.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::guide_test {
namespace {

using namespace test;

Value word(const char* text) { return Value{std::string(text)}; }

SmallNetwork network_of(const SceneData& data, bool guided, const char* paths, const char* when = "always") {
    SmallNetwork network(data, 24, 24);
    SmallNetwork::Params params{{"paths", word(paths)}};
    if (guided) {
        network.add("guide", "Guide", {}, {{"paths", Value{14000.0}}, {"when", word(when)}});
        params["guide"] = Value{NodeRef{"guide"}};
    }
    return network.add("bounce", "PathTracing", {}, params);
}

struct Brightness {
    double mean = 0, error = 0;  // standard deviation of the mean over pictures with seeds of their own
};

Brightness measured(const SmallNetwork& network, std::uint32_t samples, int pictures) {
    double sum = 0, squares = 0;
    for (int seed = 1; seed <= pictures; ++seed) {
        double mean = 0;
        const auto pixels = network.picture(samples, std::uint64_t(seed));
        for (const Rgb& pixel : pixels) mean += pixel.g / double(pixels.size());
        sum += mean;
        squares += mean * mean;
    }
    const double n = pictures, mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
}

void expect_the_same(const SceneData& data, const char* paths) {
    const auto alone = measured(network_of(data, false, paths), 32, 12);
    const auto guided = measured(network_of(data, true, paths), 32, 12);
    EXPECT_NEAR(guided.mean, alone.mean, 4 * std::hypot(guided.error, alone.error)) << paths;
    EXPECT_LT(std::hypot(guided.error, alone.error) / alone.mean, 0.02) << "the bound says too little";
}

// A room with a lamp under its ceiling, behind a screen, and things that reflect in all ways.
SceneData room_with_a_screen(bool many_lamps) {
    SceneData data;
    data.camera = camera({0.5f, 0.5f, 0.95f}, {0.5f, 0.4f, 0}, 80);
    data.camera_given = true;
    add(data, room(), diffuse(data, 0.6f));
    const auto black = diffuse(data, 0);
    add(data, quad({0.3f, 0.95f, 0.1f}, {0.3f, 0, 0}, {0, 0, 0.3f}), black).emission = AreaEmission{{20, 20, 20}, true};
    if (many_lamps) add(data, ball({0.85f, 0.9f, 0.2f}, 0.03f), black).emission = AreaEmission{{50, 50, 50}, false};
    add(data, quad({0, 0.8f, 0}, {0.7f, 0, 0}, {0, 0, 1}), diffuse(data, 0.5f));
    add(data, ball({0.75f, 0.15f, 0.5f}, 0.15f), material(data, DielectricMaterial{}));
    add(data, ball({0.25f, 0.15f, 0.4f}, 0.15f), material(data, CoatedDiffuseMaterial{colour(data, {.7f, .7f, .7f})}));
    return data;
}

TEST(Guide, LeavesTheLightOfARoomAsItIs) {
    expect_the_same(room_with_a_screen(false), "indirect");
    expect_the_same(room_with_a_screen(false), "all");
    expect_the_same(room_with_a_screen(true), "indirect");
}

// Walls are varnished, and a sheet hangs before them that lets light through.
TEST(Guide, LeavesTheLightOfAGlossyRoomAsItIs) {
    auto data = room_with_a_screen(true);
    data.materials[data.shapes[0].material].model =
        CoatedDiffuseMaterial{colour(data, {0.7f, 0.6f, 0.6f}), 1.5f, {0.2f, 0.2f}};
    DiffuseMaterial sheet{colour(data, {0.4f, 0.4f, 0.3f})};
    sheet.transmittance = colour(data, {0.3f, 0.4f, 0.3f});
    add(data, quad({0.1f, 0.1f, 0.1f}, {0.6f, 0, 0}, {0, 0.5f, 0}), material(data, sheet));
    PrincipledMaterial plastic;
    plastic.base_colour = colour(data, {0.2f, 0.7f, 0.4f}), plastic.clearcoat = 0.5f;
    add(data, quad({0.1f, 0.02f, 0.3f}, {0, 0, 0.5f}, {0.5f, 0, 0}), material(data, plastic));
    expect_the_same(data, "all");
}

TEST(Guide, LeavesAFurnaceAsBrightAsTheSeriesSays) {
    const auto [mean, error] = measured(network_of(furnace(0.8f, 1), true, "all"), 32, 8);
    EXPECT_NEAR(mean, 1 / (1 - 0.8), 4 * error + 1e-3);
    EXPECT_LT(error, 0.02);
}

TEST(Guide, LeavesWhatIsWhiteUnderAWhiteSkyAsBrightAsTheSky) {
    SceneData data;
    data.environments.push_back({{1, 1, 1}});
    data.camera = camera({0, 2, 6}, {0, 0.5f, 0}, 40);
    data.camera_given = true;
    add(data, quad({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}), diffuse(data, 1));
    add(data, ball({1.2f, 1, 0}, 0.9f), material(data, CoatedDiffuseMaterial{colour(data, {1, 1, 1})}));
    const auto [mean, error] = measured(network_of(data, true, "all"), 64, 8);
    EXPECT_NEAR(mean, 1, 4 * error + 2e-3);
    EXPECT_LT(error, 0.01);
}

TEST(Guide, ChangesNothingWhereItsTrialsSayThatItDoesNotPay) {
    const auto data = furnace(0.5f, 1);  // all directions are alike
    const auto guided = network_of(data, true, "indirect", "worthwhile"), alone = network_of(data, false, "indirect");
    EXPECT_EQ(guided.picture(16), alone.picture(16));
    EXPECT_NE(network_of(data, true, "indirect").picture(16), alone.picture(16));
}

// 14000 paths are learnt from: as many as a tenth of the picture's are a lot, unless there is much noise.
TEST(Guide, IsNotLearntWhereThePictureIsTooSmallForIt) {
    const auto data = room_with_a_screen(false);
    const auto picture_of = [&](double paths, const char* when) {
        SmallNetwork network(data, 24, 24);
        network.add("guide", "Guide", {}, {{"paths", Value{14000.0}}, {"when", word(when)}, {"picture", Value{paths}}});
        return network.add("bounce", "PathTracing", {}, {{"guide", Value{NodeRef{"guide"}}}}).picture(16);
    };
    const auto alone = network_of(data, false, "indirect").picture(16);
    EXPECT_EQ(picture_of(50000, "worthwhile"), alone);
    EXPECT_NE(picture_of(50000, "always"), alone);
    EXPECT_EQ(picture_of(1e9, "worthwhile"), picture_of(0, "worthwhile")) << "what learning costs counts for nothing";
}

TEST(GuideRadiance, ShowsWhatTheGuideTakesToArrive) {
    auto network = network_of(furnace(0.5f, 1), true, "indirect");
    network.add("known", "GuideRadiance", {}, {{"of", Value{NodeRef{"guide"}}}}).lit_by("bounce").show({"known"});
    double sum = 0;
    const auto pixels = network.pictures(16).at("known");
    for (const Rgb& pixel : pixels) sum += pixel.g / double(pixels.size());
    EXPECT_GT(sum, 0.5) << "what other walls scatter is 1 in the end, and something of what they emit is learnt, too";
    EXPECT_LT(sum, 2.5);
}

}  // namespace
}  // namespace lightnet::guide_test
