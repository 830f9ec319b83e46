// Maps of photons, and what is gathered from them, beside light that is known.
#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::photon_map_test {
namespace {

using namespace test;

Value number(double value) { return Value{value}; }
Value word(const char* text) { return Value{std::string(text)}; }

// A floor under a light from far away: irradiance 2, albedo 0.5.
SceneData lit_floor() {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0.5f));
    data.lights.push_back(DirectionalLight{{0, -1, 0}, {2, 2, 2}});
    data.camera = camera({0, 3, 3}, {0, 0, 0}, 30);
    data.camera_given = true;
    return data;
}

// A glass ball over a floor, under a small lamp.
SceneData ball_and_floor() {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0.5f));
    add(data, ball({0, 0.6f, 0}, 0.4f), material(data, DielectricMaterial{}));
    add(data, quad({-0.3f, 3, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), diffuse(data, 0)).emission =
        AreaEmission{{20, 20, 20}, true};
    data.camera = camera({0.8f, 1.2f, 1.6f}, {0, 0, 0}, 25);
    data.camera_given = true;
    return data;
}

TEST(PhotonMap, SeesAPlaneAsBrightAsTheSunMakesIt) {
    SmallNetwork network(lit_floor(), 16, 16);
    network.add("map", "PhotonMap", {}, {{"paths", word("all")}, {"photons", number(100000)}, {"gather", number(200)}});
    const double exact = 0.5 * 2 / 3.14159265358979;
    EXPECT_NEAR(mean_of(network.picture(1)), exact, 0.02 * exact);
}

// All of the sun is above the horizon, so only its middle counts.
TEST(PhotonMap, SeesAPlaneAsBrightAsAWideSunMakesIt) {
    SceneData data = lit_floor();
    data.lights = {DirectionalLight{normalize({1, -1, 0}), {2, 2, 2}, {}, 0.4f}};
    SmallNetwork network(std::move(data), 16, 16);
    network.add("map", "PhotonMap", {}, {{"paths", word("all")}, {"photons", number(100000)}, {"gather", number(200)}});
    const double exact = 0.5 * 2 / 3.14159265358979 * std::sqrt(0.5);
    EXPECT_NEAR(mean_of(network.picture(1)), exact, 0.02 * exact);
}

// What is small, and far from all else: of a few photons hardly any lie there, and these tell of discs that reach far
// beyond it. Many have small ones, so they must not bring light for large ones.
TEST(PhotonMap, SeesASmallPlateAsBrightAsTheSunMakesItHoweverManyPhotonsThereAre) {
    SceneData data = lit_floor();
    add(data, quad({-0.05f, 3, -0.05f}, {0, 0, 0.1f}, {0.1f, 0, 0}), diffuse(data, 0.5f));
    data.camera = camera({0, 4, 0.001f}, {0, 3, 0}, 5);
    SmallNetwork network(std::move(data), 32, 32);
    network.add("map", "PhotonMap", {},
                {{"paths", word("all")}, {"photons", number(1600000)}, {"aim", Value{false}}, {"gather", number(50)}});
    const double exact = 0.5 * 2 / 3.14159265358979;
    EXPECT_NEAR(mean_of(network.picture(1)), exact, 0.1 * exact);
}

// Narrower than the discs in which photons are counted, and as far from one another.
SceneData lit_slats() {
    SceneData data;
    for (int i = -4; i < 4; ++i)
        add(data, quad({0.2f * float(i), 0, -1}, {0, 0, 2}, {0.1f, 0, 0}), diffuse(data, 0.5f));
    data.lights.push_back(DirectionalLight{{0, -1, 0}, {2, 2, 2}});
    data.camera = camera({0, 3, 0.5f}, {0, 0, 0}, 35);
    data.camera_given = true;
    return data;
}

TEST(PhotonMap, SeesSlatsAsBrightAsTheSunMakesThem) {
    SmallNetwork mapped(lit_slats(), 24, 24), exact(lit_slats(), 24, 24);
    mapped.add("map", "PhotonMap", {}, {{"paths", word("all")}, {"photons", number(40000)}, {"gather", number(200)}});
    exact.add("direct", "DirectLighting");
    const double seen = mean_of(exact.picture(16));
    EXPECT_NEAR(mean_of(mapped.picture(16)), seen, 0.03 * seen);
}

// Twice as exact: four times as many.
TEST(PhotonMap, HasAsManyPhotonsAsTheErrorWants) {
    const auto density = [](double error) {
        SmallNetwork network(lit_floor(), 8, 8);
        network.add("map", "PhotonMap", {}, {{"paths", word("all")}, {"error", number(error)}})
            .add("density", "PhotonDensity", {}, {{"of", Value{NodeRef{"map"}}}})
            .lit_by("map")
            .show({"density"});
        return mean_of(network.pictures(1).at("density"));
    };
    const double few = density(0.04);
    EXPECT_NEAR(density(0.02), 4 * few, 0.4 * few);
}

TEST(PhotonMap, FindsTheCausticThatPathTracingFinds) {
    SmallNetwork mapped(ball_and_floor(), 24, 24), traced(ball_and_floor(), 24, 24);
    // The floor sees nothing but the lamp and the ball, so that all indirect light is the caustic and its echoes.
    mapped.add("map", "PhotonMap", {}, {{"photons", number(100000)}, {"radius", number(0.1)}});
    traced.add("paths", "PathTracing", {}, {{"max_depth", number(8)}, {"samples", number(16)}});
    const double caustic = mean_of(mapped.picture(4)), all = mean_of(traced.picture(160));
    EXPECT_NEAR(caustic, all, 0.04 * all);
}

/// A plate of 0.4 m that goes by its own length under the sun, with nothing around it.
SceneData plate_under_the_sun() {
    SceneData data = lit_floor();
    data.materials.clear();
    data.shapes.clear();
    add(data, quad({-0.4f, 1, -0.2f}, {0, 0, 0.4f}, {0.4f, 0, 0}), diffuse(data, 0.5f));
    data.motion.shapes.push_back({0, {quad({0, 1, -0.2f}, {0, 0, 0.4f}, {0.4f, 0, 0})}});
    data.camera = camera({0, 3, 0.0001f}, {0, 1, 0}, 45);
    return data;
}

// Its radiance times the part of the plane at its height that it covers, as it never leaves what is seen.
double light_of_plate() {
    const double side = 2 * 2 * std::tan(45 * 3.14159265358979 / 360);
    return 0.5 * 2 / 3.14159265358979 * 0.4 * 0.4 / (side * side);
}

SmallNetwork plate_seen_by(const char* kind, SmallNetwork::Params params) {
    SmallNetwork network(plate_under_the_sun(), 32, 32);
    params["paths"] = word("all");
    network.add("map", kind, {}, std::move(params));
    return network;
}

// Photons lie where it has been, too. Within a sixteenth of the time it goes by a sixteenth of its length, and loses a
// quarter of that over its edges.
TEST(PhotonMap, SeesWhatMovesAsBrightAsTheSunMakesIt) {
    const auto network = plate_seen_by("PhotonMap", {{"photons", number(400000)}, {"gather", number(50)}});
    const double exact = light_of_plate();
    EXPECT_NEAR(mean_of(network.picture(64)), exact, 0.04 * exact);
}

TEST(PhotonIrradiance, SeesWhatMovesAsBrightAsTheSunMakesIt) {
    auto network = plate_seen_by("PhotonMap", {{"photons", number(400000)}, {"gather", number(50)}});
    network.add("quick", "PhotonIrradiance", {}, {{"of", Value{NodeRef{"map"}}}}).lit_by("quick");
    const double exact = light_of_plate();
    EXPECT_NEAR(mean_of(network.picture(64)), exact, 0.04 * exact);
}

TEST(ProgressivePhotonMapping, SeesWhatMovesAsBrightAsTheSunMakesIt) {
    const auto network =
        plate_seen_by("ProgressivePhotonMapping", {{"photons", number(40000)}, {"radius", number(0.05)}});
    const double exact = light_of_plate();
    EXPECT_NEAR(mean_of(network.picture(64)), exact, 0.04 * exact);
}

// The light of the map itself, in steps.
TEST(PhotonIrradiance, IsAsBrightAsTheMapThatItTakes) {
    for (const char* paths : {"all", "diffuse"}) {
        SmallNetwork network(furnace(0.5f, 1), 24, 24);
        network.add("map", "PhotonMap", {}, {{"paths", word(paths)}, {"photons", number(20000)}})
            .add("quick", "PhotonIrradiance", {}, {{"of", Value{NodeRef{"map"}}}})
            .lit_by("map")
            .show({"quick"});
        const auto pictures = network.pictures(4);
        const double map = mean_of(pictures.at("map"));
        EXPECT_NEAR(mean_of(pictures.at("quick")), map, 0.02 * map);
    }
}

TEST(PhotonIrradiance, ServesACacheLikeTheMap) {
    const auto soft = [](bool quick) {
        SmallNetwork network(furnace(0.5f, 1), 24, 24);
        network.add("map", "PhotonMap", {}, {{"paths", word("all")}, {"photons", number(20000)}});
        if (quick) network.add("records", "PhotonIrradiance", {}, {{"of", Value{NodeRef{"map"}}}});
        network.add("soft", "IrradianceCache", {quick ? "records" : "map"}, {{"rays", number(64)}});
        return mean_of(network.picture(2));
    };
    const double map = soft(false);
    EXPECT_NEAR(soft(true), map, 0.02 * map);
}

TEST(PhotonMap, SaysThatItNeedsMoreMemoryThanItMayHave) {
    SmallNetwork network(lit_floor(), 4, 4);
    network.add("map", "PhotonMap", {}, {{"paths", word("all")}, {"photons", number(100000)}, {"memory", number(1)}});
    try {
        network.picture(1);
        FAIL() << "3 MB fit into 1";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(),
                    testing::MatchesRegex(
                        "PhotonMap 'map', preparing: 6.... photons take 3 MB, more than its 'memory' allows.*"));
    }
}

TEST(PhotonMap, HasSharperCausticsTheMorePhotonsItHas) {
    const auto picture = [](double photons) {
        SmallNetwork network(ball_and_floor(), 24, 24);
        network.add("map", "PhotonMap", {}, {{"photons", number(photons)}, {"gather", number(50)}});
        return network.picture(4);
    };
    const auto reference = picture(4e5);
    const auto error = [&](double photons) {
        const auto some = picture(photons);
        double sum = 0;
        for (std::size_t i = 0; i < some.size(); ++i) sum += std::fabs(some[i].g - reference[i].g);
        return sum;
    };
    EXPECT_LT(error(40000), 0.6 * error(2000));
}

TEST(ProgressivePhotonMapping, FindsTheCausticThatPathTracingFinds) {
    SmallNetwork mapped(ball_and_floor(), 24, 24), traced(ball_and_floor(), 24, 24);
    mapped.add("map", "ProgressivePhotonMapping", {}, {{"photons", number(20000)}, {"radius", number(0.05)}});
    traced.add("paths", "PathTracing", {}, {{"max_depth", number(8)}, {"samples", number(16)}});
    const double caustic = mean_of(mapped.picture(16)), all = mean_of(traced.picture(160));
    EXPECT_NEAR(caustic, all, 0.04 * all);
}

// With α = 2/3 the root of the mean square error falls with the third root of the samples: to 0.63 for four times as
// many. The mean over seeds of its square is taken, so that luck has little to say.
TEST(ProgressivePhotonMapping, ComesNearerToWhatPathTracingFindsWithEveryPass) {
    SmallNetwork traced(ball_and_floor(), 16, 16);
    traced.add("paths", "PathTracing", {}, {{"max_depth", number(8)}, {"samples", number(64)}});
    const auto exact = traced.picture(256);
    const auto error = [&](std::uint32_t samples) {
        double sum = 0;
        for (const std::uint64_t seed : {1, 2, 3}) {
            SmallNetwork mapped(ball_and_floor(), 16, 16);
            mapped.add("map", "ProgressivePhotonMapping", {}, {{"photons", number(1000)}, {"radius", number(0.15)}});
            const auto picture = mapped.picture(samples, seed);
            for (std::size_t i = 0; i < exact.size(); ++i) sum += std::pow(picture[i].g - exact[i].g, 2);
        }
        return std::sqrt(sum);
    };
    const double first = error(16), second = error(64), third = error(256);
    EXPECT_LT(second, 0.8 * first);
    EXPECT_LT(third, 0.8 * second);
}

// Discs of .3 of the room's size lie off each wall at all of its edges. All light, by way of one wall or more, is
// ρ / (1 - ρ) bright.
TEST(ProgressivePhotonMapping, LosesNoLightInCorners) {
    SmallNetwork mapped(furnace(0.5f, 1), 16, 16);
    mapped.add("maps", "ProgressivePhotonMapping", {},
               {{"paths", word("all")}, {"photons", number(12000)}, {"radius", number(0.3)}});
    EXPECT_NEAR(mean_of(mapped.picture(16)) - 1, 1, 0.02);  // without what the renderer sees shine
}

// Whoever asks for the light of all surfaces once more gets the maps of the pass whose picture it is made for. In a
// closed room of albedo ρ whose walls emit 1, that is ρ / (1 - ρ) bright when a map of all light is asked.
TEST(ProgressivePhotonMapping, ServesThoseWhoGatherItInEveryPass) {
    const Value radius = number(0.05), photons = number(12000), all = word("all");
    SmallNetwork gathered(furnace(0.5f, 1), 16, 16), cached(furnace(0.5f, 1), 16, 16);
    gathered.add("maps", "ProgressivePhotonMapping", {}, {{"paths", all}, {"photons", photons}, {"radius", radius}})
        .add("gathered", "FinalGather", {"maps"}, {{"rays", number(4)}});
    EXPECT_NEAR(mean_of(gathered.picture(40)) - 1, 0.5, 0.02);  // without what the renderer sees shine
    cached.add("maps", "ProgressivePhotonMapping", {}, {{"paths", all}, {"photons", photons}, {"radius", radius}})
        .add("soft", "IrradianceCache", {"maps"}, {{"rays", number(64)}});
    EXPECT_NEAR(mean_of(cached.picture(40)) - 1, 0.5, 0.02);
}

// In a closed room of albedo ρ whose walls emit 1, light that met one wall or more is ρ / (1 - ρ) bright; by way of
// one more wall ρ² / (1 - ρ) is left of what a map of all light says.
TEST(FinalGather, SeesTheFurnaceThroughAMap) {
    SmallNetwork network(furnace(0.5f, 1), 16, 16);
    network
        .add("map", "PhotonMap", {},
             {{"paths", word("all")}, {"photons", number(200000)}, {"gather", number(40)}, {"radius", number(0.05)}})
        .add("gathered", "FinalGather", {"map"}, {{"rays", number(16)}});
    EXPECT_NEAR(mean_of(network.picture(4)) - 1, 0.5, 0.02);  // without what the renderer sees shine
}

TEST(FinalGather, IsOneStepOfPathTracing) {
    SmallNetwork gathered(furnace(0.8f, 1), 16, 16);
    gathered.add("all", "PathTracing", {}, {{"paths", word("all")}}).add("step", "FinalGather", {"all"});
    EXPECT_NEAR(mean_of(gathered.picture(400)) - 1, 0.8 * 0.8 / 0.2, 0.02);
}

}  // namespace
}  // namespace lightnet::photon_map_test
