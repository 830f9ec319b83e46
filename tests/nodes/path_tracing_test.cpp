// Rooms whose light is known exactly.
#include <gtest/gtest.h>

#include "core/base/math/sampling.hpp"
#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::path_tracing_test {
namespace {

using namespace test;

// In a closed room of albedo ρ whose walls emit 1, all is 1 + ρ + ρ² + … = 1 / (1 - ρ) bright. The bound is four
// standard deviations of the mean: one run in 16,000 would fail by chance, and the run is always the same one.
class Furnace : public testing::TestWithParam<float> {};

TEST_P(Furnace, IsAsBrightAsTheSeriesSays) {
    const float albedo = GetParam();
    const Scene scene(furnace(albedo, 1));
    Rig rig(scene);
    const auto renderer = rig.path_tracer();
    const auto [mean, error] = measure(*renderer, 24, 64);
    EXPECT_NEAR(mean, 1 / (1 - albedo), 4 * error + 1e-5);
    EXPECT_LT(error * (1 - albedo), 5e-3) << "the bound says too little";
}

TEST_P(Furnace, IsAsBrightWithoutRouletteAndWithDepthLimitAsTheFiniteSeriesSays) {
    const float albedo = GetParam();
    const Scene scene(furnace(albedo, 1));
    Rig rig(scene);
    // emission, direct light, and light by way of up to 3 surfaces
    const auto renderer = rig.path_tracer({}, {{"max_depth", Value{3.0}}, {"roulette_depth", Value{100.0}}});
    const auto [mean, error] = measure(*renderer, 24, 32);
    double series = 0;
    for (int i = 0; i <= 4; ++i) series += std::pow(double{albedo}, i);
    EXPECT_NEAR(mean, series, 4 * error + 1e-5);
    EXPECT_LT(error / series, 5e-3);
}

INSTANTIATE_TEST_SUITE_P(Albedo, Furnace, testing::Values(0.5f, 0.8f));

// Everything white under a white sky is as bright as the sky, whatever it is made of.
TEST(WhiteSky, HidesAnythingThatLosesNothing) {
    SceneData data;
    data.environments.push_back({{1, 1, 1}});
    data.film.width = data.film.height = 24;
    data.camera = camera({0, 2, 6}, {0, 0.5f, 0}, 40);
    data.camera_given = true;
    add(data, quad({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}), diffuse(data, 1));
    add(data, ball({-1.2f, 1, 0}, 0.9f), material(data, DielectricMaterial{}));
    add(data, ball({1.2f, 1, 0}, 0.9f), material(data, CoatedDiffuseMaterial{colour(data, {1, 1, 1})}));
    DielectricMaterial pane;
    pane.thin = true;
    add(data, ball({0, 0.5f, 1.5f}, 0.4f), material(data, pane));
    const Scene scene(data);
    Rig rig(scene);
    const auto [mean, error] = measure(*rig.path_tracer(), 24, 64);
    EXPECT_NEAR(mean, 1, 4 * error + 1e-3);  // the chain of reflections inside glass is cut at some depth
    EXPECT_LT(error, 5e-3);
}

// Two suns that fill half of the sky each are a white sky, before which white things can't be seen.
TEST(WhiteSky, MadeOfTwoSunsHidesAnythingThatLosesNothing) {
    SceneData data;
    for (const float side : {-1.0f, 1.0f})
        data.lights.push_back(DirectionalLight{{side, 0, 0}, Rgb{1, 1, 1} * pi, {}, pi / 2});
    data.film.width = data.film.height = 24;
    data.camera = camera({0, 2, 6}, {0, 0.5f, 0}, 40);
    data.camera_given = true;
    add(data, quad({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}), diffuse(data, 1));
    add(data, ball({-1.2f, 1, 0}, 0.9f), material(data, DielectricMaterial{}));
    add(data, ball({1.2f, 1, 0}, 0.9f), material(data, CoatedDiffuseMaterial{colour(data, {1, 1, 1})}));
    const Scene scene(data);
    Rig rig(scene);
    const auto [mean, error] = measure(*rig.path_tracer(), 24, 64);
    EXPECT_NEAR(mean, 1, 4 * error + 1e-3);
    EXPECT_LT(error, 5e-3);
}

// A block of coloured glass, without reflections, before a bright wall: what is left is exp(-absorption × way).
class ColouredGlass : public testing::TestWithParam<float> {
protected:
    // Two metres thick; its surface has that roughness
    Scene block() const {
        SceneData data;
        DielectricMaterial air;
        air.eta = 1;
        if (GetParam() > 0) {
            air.eta = 1.0001f;
            air.roughness.u = air.roughness.v = GetParam();
        }
        const auto glass = material(data, air);
        data.materials[glass].absorption = {0.1f, 0.5f, 1};
        add(data, quad({-50, -50, 1}, {100, 0, 0}, {0, 100, 0}), glass);
        add(data, quad({-50, -50, -1}, {0, 100, 0}, {100, 0, 0}), glass);
        add(data, quad({-50, -50, -4}, {100, 0, 0}, {0, 100, 0}), diffuse(data, 0)).emission =
            AreaEmission{{1, 1, 1}, true};
        data.camera = camera({0, 0, 5}, {0, 0, 0}, 1);
        data.camera_given = true;
        return Scene(std::move(data));
    }
    static void expect_beer(const Renderer& renderer) {
        Rgb sum;
        const auto pixels = picture(renderer, 16, 16, 64);
        for (const Rgb& pixel : pixels) sum += pixel / float(pixels.size());
        EXPECT_NEAR(sum.r, std::exp(-0.2f), 0.01f);
        EXPECT_NEAR(sum.g, std::exp(-1.0f), 0.01f);
        EXPECT_NEAR(sum.b, std::exp(-2.0f), 0.01f);
    }
};

TEST_P(ColouredGlass, LeavesWhatBeersLawSays) {
    const Scene scene = block();
    Rig rig(scene);
    expect_beer(*rig.path_tracer());
}

TEST_P(ColouredGlass, LeavesWhatBeersLawSaysWhenOneNodeFollowsAllPaths) {
    const Scene scene = block();
    Rig rig(scene);
    rig.add("PathTracing", "paths", {}, {{"paths", Value{"all"}}});
    expect_beer(*rig.renderer("paths"));
}

INSTANTIATE_TEST_SUITE_P(Roughness, ColouredGlass, testing::Values(0.0f, 0.05f));

// A small lamp inside of a large ball of coloured air, seen on a diffuse floor in it.
TEST(ColouredGlass, WeakensLampsThatAreInside) {
    const auto brightness = [](Rgb absorption) {
        SceneData data;
        DielectricMaterial air;
        air.eta = 1;
        const auto glass = material(data, air);
        data.materials[glass].absorption = absorption;
        add(data, ball({0, 0, 0}, 20), glass);
        add(data, quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}), diffuse(data, 0)).emission = AreaEmission{{9, 9, 9}, true};
        data.camera = camera({0.3f, 40, 0.2f}, {0.3f, 3, 0.5f}, 0.1f);
        data.camera_given = true;
        const Scene scene(data);
        Rig rig(scene);
        rig.add("AmbientOcclusion", "nothing");
        return picture(*rig.renderer("nothing"), 2, 2, 4)[0].g;
    };
    // the lamp is seen through what lies between the ball's top and itself
    EXPECT_NEAR(brightness({0.1f, 0.1f, 0.1f}), 9 * std::exp(-0.1f * (std::sqrt(399.0f) - 3)), 0.02f);
    EXPECT_NEAR(brightness({}), 9, 1e-3f);
}

std::unique_ptr<Renderer> all_paths(Rig& rig, double samples) {
    rig.add("PathTracing", "paths", {}, {{"paths", Value{"all"}}, {"samples", Value{samples}}});
    return rig.renderer("paths");
}

TEST_P(Furnace, IsAsBrightWhenOneNodeFollowsAllPaths) {
    const float albedo = GetParam();
    const Scene scene(furnace(albedo, 1));
    Rig rig(scene);
    const auto [mean, error] = measure(*all_paths(rig, 2), 24, 32);
    EXPECT_NEAR(mean, 1 / (1 - albedo), 4 * error + 1e-5);
    EXPECT_LT(error * (1 - albedo), 5e-3);
}

// Two directions share what they see of the sky half and half; together they must see all of it.
TEST(WhiteSky, HidesAnythingWhenOneNodeFollowsAllPaths) {
    SceneData data;
    data.environments.push_back({{1, 1, 1}});
    data.film.width = data.film.height = 24;
    data.camera = camera({0, 2, 6}, {0, 0.5f, 0}, 40);
    data.camera_given = true;
    add(data, quad({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}), diffuse(data, 1));
    add(data, ball({-1.2f, 1, 0}, 0.9f), material(data, DielectricMaterial{}));
    add(data, ball({1.2f, 1, 0}, 0.9f), material(data, CoatedDiffuseMaterial{colour(data, {1, 1, 1})}));
    const Scene scene(data);
    Rig rig(scene);
    const auto [mean, error] = measure(*all_paths(rig, 1), 24, 64);
    EXPECT_NEAR(mean, 1, 4 * error + 1e-3);
    EXPECT_LT(error, 5e-3);
}

// A ball on the floor in a room with a lamp and a sky through the open roof: both ways must agree.
TEST(PathTracing, FindsAllThatDirectAndIndirectLightAddUpTo) {
    SceneData data;
    data.environments.push_back({{0.5f, 0.5f, 0.5f}});
    data.film.width = data.film.height = 24;
    data.camera = camera({0, 2, 6}, {0, 0.5f, 0}, 40);
    data.camera_given = true;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0.7f));
    add(data, ball({0.5f, 1, 0}, 0.9f), diffuse(data, 0.5f));
    add(data, ball({-2, 3, 0}, 0.3f), diffuse(data, 0)).emission = AreaEmission{{20, 20, 20}, false};
    const Scene scene(data);
    Rig apart(scene, 1), together(scene, 2);
    const auto first = measure(*apart.path_tracer(), 24, 64);
    const auto all = picture(*all_paths(together, 1), 24, 24, 64), sum = picture(*apart.path_tracer(), 24, 24, 64);
    double difference = 0, squares = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double d = double{all[i].g} - sum[i].g;
        difference += d;
        squares += d * d;
    }
    const double n = double(all.size()), mean = difference / n;
    const double error = std::sqrt((squares / n - mean * mean) / n);
    EXPECT_NEAR(mean, 0, 4 * error);
    EXPECT_LT(error, 0.01 * first.mean) << "the bound says too little";
}

// Noise of independent samples: twice as many halve the variance. Stratified ones may do better, never worse.
TEST(PathTracing, HalvesItsVarianceWithTwiceTheSamples) {
    const Scene scene(furnace(0.8f, 1));
    Rig one(scene, 1), two(scene, 1);
    const double few = measure(*all_paths(one, 1), 32, 8).error, many = measure(*all_paths(two, 1), 32, 16).error;
    EXPECT_LT(many * many, few * few * 0.5 * 1.3);
    EXPECT_GT(many, 0);
}

TEST(PathTracing, LeavesDirectLightToOthers) {
    SceneData data;
    add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), diffuse(data, 0.6f));
    data.environments.push_back({{2, 2, 2}});
    const Scene scene(data);
    Rig rig(scene);
    const Query question{.u = 0.5f, .outgoing = {0, 1, 0}};
    std::vector<Rgb> answers(1);
    rig.add("PathTracing", "bounce").light(std::span(&question, 1), answers);
    EXPECT_TRUE(is_black(answers[0]));
}

// A lamp seen in a mirror lights the floor: no direct light, so it counts as indirect.
TEST(PathTracing, CountsLightByWayOfMirrors) {
    SceneData data;
    const auto black = diffuse(data, 0);
    add(data, quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), diffuse(data, 0.5f));
    add(data, quad({-50, 10, -50}, {100, 0, 0}, {0, 0, 100}), mirror(data, 0.8f));
    add(data, quad({-200, -5, -200}, {0, 0, 400}, {400, 0, 0}), black).emission = AreaEmission{{1, 1, 1}, false};
    const Scene scene(data);
    Rig rig(scene);
    const Query question{.v = 0.5f, .outgoing = {0, 1, 0}};
    ASSERT_NEAR(length(scene.surface(question).position), 0, 1e-5f);
    std::vector<Query> questions(4096, question);
    for (std::uint32_t i = 0; i < questions.size(); ++i) questions[i].sample = i;
    std::vector<Rgb> direct(questions.size()), bounce(questions.size());
    rig.add("DirectLighting", "direct").light(questions, direct);
    rig.add("PathTracing", "bounce").light(questions, bounce);
    double sum = 0;
    for (std::size_t i = 0; i < questions.size(); ++i) {
        EXPECT_TRUE(is_black(direct[i]));
        sum += bounce[i].g;
    }
    // the mirror's square, less what the floor itself hides: near 0.5 × 0.8
    EXPECT_NEAR(sum / double(questions.size()), 0.4, 0.02);
}

TEST(PathTracing, GivesTheSameBytesTwice) {
    const Scene scene(furnace(0.5f, 1));
    Rig first(scene, 3), second(scene, 3), other(scene, 4);
    const auto a = picture(*first.path_tracer(), 8, 8, 4), b = picture(*second.path_tracer(), 8, 8, 4);
    EXPECT_EQ(a, b);
    EXPECT_NE(a, picture(*other.path_tracer(), 8, 8, 4));
}

}  // namespace
}  // namespace lightnet::path_tracing_test
