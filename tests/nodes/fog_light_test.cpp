// Light in fog, beside what can be worked out without a renderer.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/small_media.hpp"
#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::fog_light_test {
namespace {

using namespace test;

constexpr double pi = std::numbers::pi;

Value number(double value) { return Value{value}; }
Value word(const char* text) { return Value{std::string(text)}; }

std::array<double, 3> channels(Rgb c) { return {c.r, c.g, c.b}; }

// A camera that looks from (0, 0, 3) along -z, at next to one direction only.
void look_along_z(SceneData& data) {
    data.camera = camera({0, 0, 3}, {0, 0, 0}, 0.02f);
    data.camera_given = true;
}

// A border of media: a box.
void add_box(SceneData& data, Vec3 low, Vec3 high, MediumSides media) {
    Mesh box = room();
    for (Vec3& p : box.positions)
        p = {low.x + (high.x - low.x) * p.x, low.y + (high.y - low.y) * p.y, low.z + (high.z - low.z) * p.z};
    box.flip_normals = !box.flip_normals;
    add(data, box, material(data, NoMaterial{})).media = media;
}

Rgb mean_colour_of(const std::vector<Rgb>& pixels) {
    Rgb sum;
    for (const Rgb& pixel : pixels) sum += pixel;
    return sum / float(pixels.size());
}

void expect_near(Rgb found, std::array<double, 3> expected, double tolerance, const std::string& what) {
    const auto values = channels(found);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(values[c], expected[c], tolerance * expected[c]) << what << ", channel " << c;
}

// Direct light, of what the eye's ray passes.
Rgb direct_light(SceneData data, std::uint32_t samples = 128) {
    SmallNetwork network(std::move(data), 16, 16);
    network.add("direct", "DirectLighting");
    return mean_colour_of(network.picture(samples));
}

// ∫ of what is scattered once towards the eye, between two places on its ray that fog fills. arriving(z, extinction):
// ∫ radiance × phase function over directions, dimmed.
using Arriving = std::function<double(double, double)>;
std::array<double, 3> scattered_once(const Medium& fog, double from, double to, const Arriving& arriving) {
    std::array<double, 3> all{};
    constexpr int steps = 4000;
    for (std::size_t c = 0; c < 3; ++c) {
        const double extinction = channels(fog.extinction.value)[c], albedo = channels(fog.albedo.value)[c];
        for (int i = 0; i < steps; ++i) {
            const double t = (i + 0.5) * (from - to) / steps, z = from - t;
            all[c] += extinction * albedo * std::exp(-extinction * t) * arriving(z, extinction) * (from - to) / steps;
        }
    }
    return all;
}

Medium coloured(PhaseFunction phase) {
    Medium medium = fog({0.1f, 0.4f, 0.9f}, {0.9f, 0.5f, 0.2f});
    phase.normalise();
    medium.phase = std::move(phase);
    return medium;
}

// A lamp in coloured fog that fills everything.
TEST(FogOfColour, ScattersALampsLightOnceByEveryPhaseFunction) {
    using Law = PhaseFunction::Law;
    const PhaseFunction forward{Law::henyey_greenstein, 0.9f}, backward{Law::henyey_greenstein, -0.7f},
        table{Law::tabulated, 0, {0.2f, 0.1f, 0.4f, 1, 3}};
    const PhaseFunction blend{Law::blend, 0, {0.3f, 0.7f}, {forward, {Law::rayleigh}}};
    for (const PhaseFunction& phase :
         {PhaseFunction{}, forward, backward, PhaseFunction{Law::rayleigh}, table, blend}) {
        SceneData data;
        data.media.push_back(coloured(phase));
        data.around = 0;
        data.lights.push_back(PointLight{{0, 1, 0}, {5, 5, 5}});
        look_along_z(data);
        const Medium medium = data.media[0];
        const auto expected = scattered_once(medium, 3, -60, [&](double z, double extinction) {
            const double d = std::sqrt(1 + z * z);
            return medium.phase.density(float(z / d)) * 5 / (d * d) * std::exp(-extinction * d);
        });
        expect_near(direct_light(std::move(data)), expected, 0.02, "law " + std::to_string(int(phase.law)));
    }
}

TEST(FogInABox, IsLitByTheSunAndBySpots) {
    SceneData data;
    data.media.push_back(coloured({PhaseFunction::Law::henyey_greenstein, 0.5f}));
    const Medium medium = data.media[0];
    add_box(data, {-50, -1, -50}, {50, 1, 50}, {0, Query::no_medium});
    look_along_z(data);
    SceneData sunny = data;
    sunny.lights.push_back(DirectionalLight{{0, -1, 0}, {2, 2, 2}});
    const auto expected = scattered_once(
        medium, 3, -50, [&](double, double extinction) { return medium.phase.density(0) * 2 * std::exp(-extinction); });
    expect_near(direct_light(std::move(sunny)), expected, 0.02, "sun");
    SpotLight spot;
    spot.position = {0, 2, 0}, spot.axis = {0, -1, 0}, spot.intensity = {9, 9, 9};
    spot.inner = spot.outer = float(pi / 6);
    data.lights.push_back(spot);
    const auto lit = scattered_once(medium, 3, -50, [&](double z, double extinction) {
        const double d = std::sqrt(4 + z * z);
        if (2 / d < std::cos(pi / 6)) return 0.0;
        return medium.phase.density(float(z / d)) * 9 / (d * d) * std::exp(-extinction * d / 2);  // half of it in fog
    });
    expect_near(direct_light(std::move(data), 512), lit, 0.02, "spot");
}

// A square that shines downwards, in the fog and above it.
TEST(FogUnderALamp, IsAsBrightAsTheLampLooksFromEachPlace) {
    for (const bool in_fog : {true, false}) {
        SceneData data;
        data.media.push_back(coloured({PhaseFunction::Law::henyey_greenstein, 0.5f}));
        const Medium medium = data.media[0];
        const double share = in_fog ? 1 : 0.5;  // of the way from the lamp
        add_box(data, {-50, -50, -50}, {50, in_fog ? 50.0f : 0.5f, 50}, {0, Query::no_medium});
        add(data, quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}), diffuse(data, 0)).emission =
            AreaEmission{{4, 4, 4}, false};
        look_along_z(data);
        const auto expected = scattered_once(medium, 3, -50, [&](double z, double extinction) {
            constexpr int side = 8;
            double sum = 0;
            for (int i = 0; i < side * side; ++i) {
                const double x = (i % side + 0.5) / side - 0.5, along = z - ((i / side + 0.5) / side - 0.5);
                const double d = std::sqrt(x * x + 1 + along * along);
                sum += medium.phase.density(float(along / d)) * 4 / (d * d * d) * std::exp(-extinction * d * share) /
                       (side * side);
            }
            return sum;
        });
        expect_near(direct_light(std::move(data)), expected, 0.02, in_fog ? "in fog" : "above it");
    }
}

// From within a ball of fog the way to its surface is another in each direction.
TEST(FogInABall, IsLitByTheSkyAroundIt) {
    for (const bool mapped : {false, true}) {
        SceneData data;
        data.environments.push_back({{2, 2, 2}});
        if (mapped)
            data.environments[0].image = std::make_shared<const Image>(8, 4, std::vector<Rgb>(32, Rgb{1, 1, 1}));
        data.media.push_back(coloured({}));
        const Medium medium = data.media[0];
        add(data, ball({0, 0, 0}, 1), material(data, NoMaterial{})).media = MediumSides{0, Query::no_medium};
        look_along_z(data);
        auto expected = scattered_once(medium, 1, -1, [&](double z, double extinction) {
            constexpr int steps = 64;
            double sum = 0;
            for (int i = 0; i < steps; ++i) {
                const double cosine = (i + 0.5) * 2 / steps - 1;
                sum += std::exp(-extinction * (std::sqrt(1 - z * z * (1 - cosine * cosine)) - z * cosine)) / steps;
            }
            return 2 * sum;
        });
        for (std::size_t c = 0; c < 3; ++c) expected[c] += 2 * std::exp(-2 * channels(medium.extinction.value)[c]);
        expect_near(direct_light(std::move(data)), expected, 0.01, mapped ? "map" : "even");
    }
}

// A lamp in fog, seen from outside through the fog around it and that in a box around the lamp.
TEST(LampInFog, ShinesThroughOneMediumInAnother) {
    SceneData data;
    data.media.push_back(fog({0.2f, 0.1f, 0.05f}, {0, 0, 0}));
    data.media.push_back(fog({0.3f, 0.6f, 1}, {0, 0, 0}));
    data.around = 0;
    add_box(data, {-1, -1, -1}, {1, 1, 1}, {1, 0});
    add(data, quad({-0.5f, -0.5f, -0.5f}, {1, 0, 0}, {0, 1, 0}), diffuse(data, 0)).emission =
        AreaEmission{{4, 4, 4}, false};
    look_along_z(data);
    expect_near(direct_light(std::move(data), 4),
                {4 * std::exp(-0.2 * 2 - 0.3 * 1.5), 4 * std::exp(-0.1 * 2 - 0.6 * 1.5), 4 * std::exp(-0.05 * 2 - 1.5)},
                1e-3, "seen");
}

// Grids of extinction and of albedo that stand differently.
TEST(FogOfTwoGrids, ScattersWhatBothSay) {
    Medium medium = fog({1, 2, 0.5f}, {0.9f, 0.8f, 0.7f});
    const auto grid = [](std::array<std::uint32_t, 3> size, int factor) {
        VolumeGrid made;
        made.size = size;
        for (std::size_t i = 0; i < made.points(); ++i) made.values.push_back(float((int(i) * factor + 1) % 5) / 4);
        return std::make_shared<const VolumeGrid>(made);
    };
    const auto place = [](Vec3 low, float side) {
        Matrix to_grid;
        for (std::size_t axis = 0; axis < 3; ++axis)
            to_grid.m[axis][axis] = 1 / double(side), to_grid.m[axis][3] = -double(low[axis]) / double(side);
        return to_grid;
    };
    medium.extinction.grid = grid({3, 4, 5}, 7);
    medium.extinction.to_grid = place({-1, -1, -1}, 2);
    medium.albedo.grid = grid({2, 3, 4}, 3);
    medium.albedo.to_grid = place({-0.7f, -0.4f, -1.6f}, 3);
    std::swap(medium.albedo.to_grid.m[0], medium.albedo.to_grid.m[1]);
    SceneData data;
    data.media.push_back(medium);
    add_box(data, {-1, -1, -1}, {1, 1, 1}, {0, Query::no_medium});
    data.lights.push_back(PointLight{{0, 2, 0}, {5, 5, 5}});
    look_along_z(data);
    const auto optical = [&](Vec3 from, Vec3 to, std::size_t c) {
        constexpr int steps = 200;
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            const Vec3 at = from + (to - from) * ((float(i) + 0.5f) / steps);
            if (at.y < 1) sum += channels(medium.extinction.at(at))[c] / steps;
        }
        return sum * double(length(to - from));
    };
    std::array<double, 3> expected{};
    constexpr int steps = 200;
    for (std::size_t c = 0; c < 3; ++c)
        for (int i = 0; i < steps; ++i) {
            const Vec3 at{0, 0, 1 - (float(i) + 0.5f) * 2 / steps};
            const double d2 = 4 + double(at.z) * double(at.z);
            const double scattering =
                channels(medium.extinction.at(at))[c] *
                channels(medium.albedo.value * medium.albedo.grid->at(transform_point(medium.albedo.to_grid, at)))[c];
            expected[c] += scattering * 5 / d2 / (4 * pi) *
                           std::exp(-optical({0, 0, 1}, at, c) - optical(at, {0, 2, 0}, c)) * 2 / steps;
        }
    expect_near(direct_light(std::move(data), 512), expected, 0.02, "two grids");
}

// Chandrasekhar's H for isotropic scattering: 1/H(μ) = √(1-ω) + ω/2 ∫ μ' H(μ') / (μ + μ') dμ'.
double chandrasekhar(double albedo, double mu) {
    constexpr int points = 400;
    std::vector<double> h(points, 1);
    const auto at = [&](double cosine) {
        double sum = 0;
        for (int i = 0; i < points; ++i) {
            const double other = (i + 0.5) / points;
            sum += other * h[std::size_t(i)] / (cosine + other) / points;
        }
        return 1 / (std::sqrt(1 - albedo) + albedo / 2 * sum);
    };
    for (int round = 0; round < 60; ++round) {
        std::vector<double> next(points);
        for (int i = 0; i < points; ++i) next[std::size_t(i)] = at((i + 0.5) / points);
        h = next;
    }
    return at(mu);
}

// What half of all space gives back of light that arrives evenly, 1 - √(1-ω) H(μ): Chandrasekhar 1960, "Radiative
// Transfer".
TEST(DeepFog, GivesBackWhatChandrasekharSays) {
    for (const double mu : {1.0, 0.5}) {
        SceneData data;
        data.environments.push_back({{1, 1, 1}});
        data.media.push_back(fog({1, 1, 1}, {0.95f, 0.8f, 0.4f}));
        add_box(data, {-300, -300, -60}, {300, 300, 0}, {0, Query::no_medium});
        const double across = std::sqrt(1 - mu * mu);
        data.camera = camera({float(5 * across), 0, float(5 * mu)}, {0, 0, 0}, 0.02f);
        data.camera_given = true;
        SmallNetwork network(std::move(data), 16, 16);
        network.add("direct", "DirectLighting")
            .add("bounce", "PathTracing")
            .add("light", "Combine", {"direct", "bounce"});
        std::array<double, 3> expected{};
        for (std::size_t c = 0; c < 3; ++c) {
            const double albedo = std::array{0.95, 0.8, 0.4}[c];
            expected[c] = 1 - std::sqrt(1 - albedo) * chandrasekhar(albedo, mu);
        }
        expect_near(mean_colour_of(network.picture(128)), expected, 0.015, "μ = " + std::to_string(mu));
    }
}

// Glass of the index of air around fog is no glass.
TEST(FogBehindGlassOfAir, LooksLikeFogBehindNothing) {
    const auto light_of = [](AnyMaterial border) {
        SceneData data;
        data.environments.push_back({{1, 1, 1}});
        data.media.push_back(fog({1, 2, 4}, {0.9f, 0.8f, 0.7f}, 0.5f));
        add(data, ball({0, 0, 0}, 1), material(data, std::move(border))).media = MediumSides{0, Query::no_medium};
        data.camera = camera({0, 0, 4}, {0, 0, 0}, 20);
        data.camera_given = true;
        SmallNetwork network(std::move(data), 16, 16);
        network.add("direct", "DirectLighting")
            .add("bounce", "PathTracing")
            .add("light", "Combine", {"direct", "bounce"});
        return mean_colour_of(network.picture(256));
    };
    DielectricMaterial solid, pane;
    solid.eta = pane.eta = 1;
    pane.thin = true;
    const auto expected = channels(light_of(NoMaterial{}));
    expect_near(light_of(solid), expected, 0.01, "solid");
    expect_near(light_of(pane), expected, 0.01, "pane");
}

// A room with panes that reflect nothing, in fog and out of it.
SceneData room_with_panes(bool panes, bool foggy, int lamp) {
    SceneData data;
    add(data, room(), diffuse(data, 0.6f));
    if (lamp == 0)
        add(data, quad({0.3f, 0.95f, 0.3f}, {0.4f, 0, 0}, {0, 0, 0.4f}), diffuse(data, 0)).emission =
            AreaEmission{{3, 3, 3}, false};
    if (lamp == 1) data.lights.push_back(PointLight{{0.5f, 0.6f, 0.5f}, {1, 1, 1}});
    if (lamp >= 2) {  // by an open wall
        std::get<Mesh>(data.shapes[0].geometry).triangles.resize(10);
        data.environments.push_back({{1, 1, 1}});
        if (lamp == 3)
            data.environments[0].image = std::make_shared<const Image>(8, 4, std::vector<Rgb>(32, Rgb{1, 1, 1}));
    }
    DielectricMaterial pane;
    pane.eta = 1;
    pane.thin = true;
    for (const float height : {0.9f, 0.8f, 0.5f, 0.4f})
        if (panes) add(data, quad({0, height, 0}, {0, 0, 1}, {1, 0, 0}), material(data, pane));
    if (panes) add(data, quad({0, 0, 0.99f}, {0, 1, 0}, {1, 0, 0}), material(data, pane));
    if (foggy) {
        data.media.push_back(fog({1, 1, 1}, {0.8f, 0.8f, 0.8f}, 0.5f));
        data.around = 0;
    }
    data.camera = camera({0.5f, 0.5f, 0.05f}, {0.5f, 0.4f, 1}, 60);
    data.camera_given = true;
    return data;
}

double light_of_room(bool panes, bool foggy, int lamp, int depth, bool all) {
    SmallNetwork network(room_with_panes(panes, foggy, lamp), 16, 16);
    if (!all) network.add("direct", "DirectLighting");
    network.add("bounce", "PathTracing", {}, {{"max_depth", number(depth)}, {"paths", word(all ? "all" : "indirect")}});
    if (!all) network.add("light", "Combine", {"direct", "bounce"});
    return mean_of(network.picture(256));
}

// Panes that light passes straight are not counted, and lamps are found through them.
TEST(PathsThroughPanes, BringAsMuchAsWithoutThem) {
    for (int lamp = 0; lamp < 4; ++lamp)
        for (const bool foggy : {false, true})
            for (const int depth : {0, 1, 2}) {
                if (foggy && lamp > 0) continue;  // the sky is too far away, and near a point its light has no end
                if (depth == 2 && lamp > 0) continue;
                const double expected = light_of_room(false, foggy, lamp, depth, false);
                const std::string what = "depth " + std::to_string(depth) + ", lamp " + std::to_string(lamp);
                EXPECT_NEAR(light_of_room(true, foggy, lamp, depth, false), expected, 0.02 * expected) << what << foggy;
                if (depth > 0) continue;
                EXPECT_NEAR(light_of_room(true, foggy, lamp, depth, true), expected, 0.02 * expected) << what << foggy;
            }
}

// Of a lamp straight above two panes of glass arrives what Fresnel says.
TEST(PathsThroughPanes, FindAPointLightAsBrightAsGlassLeavesIt) {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0.6f));
    DielectricMaterial pane;
    pane.thin = true;
    for (const float height : {2.0f, 2.5f})
        add(data, quad({-5, height, -5}, {0, 0, 10}, {10, 0, 0}), material(data, pane));
    data.lights.push_back(PointLight{{0, 3, 0}, {9, 9, 9}});
    data.camera = camera({0.01f, 1, 0}, {0, 0, 0}, 0.1f);
    data.camera_given = true;
    SmallNetwork network(std::move(data), 4, 4);
    network.add("direct", "DirectLighting");
    EXPECT_EQ(mean_of(network.picture(4)), 0) << "by way of glass is not direct";
    network.add("bounce", "PathTracing", {}, {{"max_depth", number(1)}});
    const double lost = 0.04, left = 1 - 2 * lost / (1 + lost);
    // and what the lower pane sends back of what the floor scatters, about .077 × .6
    EXPECT_NEAR(mean_of(network.picture(64)), 0.6 / pi * left * left, 0.02 * 0.6 / pi);
}

// A cache asked about points in fog goes on by its rays.
TEST(IrradianceCaches, ScatterInFogWhatTheyGather) {
    SceneData data = room_with_panes(false, true, 0);
    SmallNetwork network(std::move(data), 16, 16);
    network.add("direct", "DirectLighting").add("bounce", "PathTracing").add("paths", "Combine", {"direct", "bounce"});
    const double exact = mean_of(network.picture(256));
    network.add("cache", "IrradianceCache", {"paths"}).add("cached", "Combine", {"direct", "cache"});
    const double cached = mean_of(network.picture(256));
    EXPECT_NEAR(cached, exact, 0.03 * exact);
}

}  // namespace
}  // namespace lightnet::fog_light_test
