// Light that leaves lamps: where it goes to, and that none gets lost.
#include <gtest/gtest.h>

#include "core/base/math/sampling.hpp"
#include "core/estimate/photon_shooter.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::photon_shooter_test {
namespace {

using namespace test;

constexpr std::size_t ways = 40000;

std::vector<Photon> shot(const Scene& scene, PhotonPaths paths, const Aim& aim = {}, Key key = 5) {
    std::vector<Photon> photons;
    PhotonShooter(scene, paths, key).shoot(0, ways, 1.0 / ways, aim, photons);
    return photons;
}

double flux(const std::vector<Photon>& photons) {
    double sum = 0;
    for (const auto& photon : photons) sum += photon.flux.g;
    return sum;
}

// A closed box with a lamp in it.
SceneData closed_room(float albedo) {
    SceneData data;
    add(data, room(), diffuse(data, albedo));
    add(data, quad({0.4f, 0.9f, 0.4f}, {0.2f, 0, 0}, {0, 0, 0.2f}), diffuse(data, 0)).emission =
        AreaEmission{{3, 3, 3}, true};
    return data;
}

// A glass ball over a floor, under a lamp that is small and far.
SceneData ball_and_floor() {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0.5f));
    add(data, ball({0, 0.6f, 0}, 0.4f), material(data, DielectricMaterial{}));
    add(data, quad({-0.1f, 4, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}), diffuse(data, 0)).emission =
        AreaEmission{{100, 100, 100}, false};
    return data;
}

TEST(PhotonShooter, LandsAllPowerOnTheWallsOfAClosedRoom) {
    const Scene scene(closed_room(0));
    const double power = 2 * 0.04 * double(pi) * 3;  // both sides of the lamp
    const auto photons = shot(scene, PhotonPaths::all);
    EXPECT_EQ(photons.size(), ways);
    EXPECT_NEAR(flux(photons), power, 1e-4 * power);  // each carries the same
    EXPECT_TRUE(shot(scene, PhotonPaths::indirect).empty()) << "black walls send nothing on";
}

// A skylight over a black floor, and a board above the half of it, on which nothing of the sky is seen from below.
TEST(PhotonShooter, ComesThroughPortalsAloneAndNotThroughWhatStandsBeforeThem) {
    const auto room_under = [](bool board) {
        SceneData data;
        add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), diffuse(data, 0));
        if (board) add(data, quad({-50, 2.001f, 0}, {0, 0, 50}, {100, 0, 0}), diffuse(data, 0));
        EnvironmentData sky;
        sky.radiance = {3, 3, 3};
        sky.portal = Portal{{0, 2, -0.5f}, {0, 0, 1}, {1, 0, 0}};
        data.environments = {sky};
        return Scene(data);
    };
    const double power = 3 * double(pi);  // times its area
    const double open = flux(shot(room_under(false), PhotonPaths::all));
    EXPECT_NEAR(open / power, 1, 0.02);
    const auto half = shot(room_under(true), PhotonPaths::all);
    EXPECT_NEAR(flux(half) / power, 0.5, 0.02);
    for (const Photon& photon : half) ASSERT_LT(photon.position.y, 1);
}

// Each wall passes half of what it gets on: P + P/2 + P/4 + …, but for what the black lamp takes.
TEST(PhotonShooter, LandsWhatTheGeometricSeriesSays) {
    const Scene scene(closed_room(0.5f));
    const double later = flux(shot(scene, PhotonPaths::indirect)), first = flux(shot(scene, PhotonPaths::all)) - later;
    const double power = 2 * 0.04 * double(pi) * 3;
    EXPECT_NEAR(first, power, 0.01 * power);
    EXPECT_LT(later, power) << "the lamp takes some";
    EXPECT_GT(later, 0.9 * power);
}

TEST(PhotonShooter, DoesNotSqueezeLightThatGoesThroughGlass) {
    SceneData data;
    DielectricMaterial glass;
    add(data, room(), diffuse(data, 0));
    add(data, ball({0.5f, 0.5f, 0.5f}, 0.3f), material(data, glass));
    add(data, ball({0.5f, 0.5f, 0.5f}, 0.1f), diffuse(data, 0)).emission = AreaEmission{{1, 1, 1}, false};
    const Scene scene(data);
    const double power = 4 * double(pi) * 0.01 * double(pi);
    EXPECT_NEAR(flux(shot(scene, PhotonPaths::caustic)), power, 0.02 * power)
        << "all light gets out of the glass, or back to the black lamp";
}

TEST(PhotonShooter, FindsTheSameCausticWhereverItAims) {
    const Scene scene(ball_and_floor());
    std::vector<Trial> trials;
    PhotonShooter(scene, PhotonPaths::caustic, 9).attempt(0, 65536, Aim(), trials);
    const Aim aim(trials);
    EXPECT_GT(aim.cells(), 8u);
    const auto even = shot(scene, PhotonPaths::caustic), aimed = shot(scene, PhotonPaths::caustic, aim);
    EXPECT_GT(aimed.size(), 10 * even.size()) << "that is what aiming is for";
    const double error = 4 * flux(even) / std::sqrt(double(even.size()));
    EXPECT_NEAR(flux(aimed), flux(even), error);
}

TEST(Aim, IsADensityOverAllNumbers) {
    std::vector<Trial> trials;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        Samples samples(3, i);
        const Vec2 a = samples.next_2d(), b = samples.next_2d();
        if (a.x < 0.3f && b.y > 0.6f) trials.push_back({{samples.next(), a.x, a.y, b.x, b.y}, 1, 1});
    }
    const Aim aim(trials);
    double volume = 0, useful = 0, squares = 0;
    constexpr std::uint32_t count = 20000;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(4, i);
        const auto choice = aim.choose(samples);
        volume += choice.weight / count;
        useful += choice.numbers[1] < 0.3f && choice.numbers[4] > 0.6f ? choice.weight / count : 0;
        squares += double{choice.weight} * choice.weight / count;
        for (const float number : choice.numbers) {
            EXPECT_GE(number, 0);
            EXPECT_LT(number, 1);
        }
    }
    EXPECT_NEAR(volume, 1, 4 * std::sqrt(squares / count));
    EXPECT_NEAR(useful, 0.12, 0.005);
}

}  // namespace
}  // namespace lightnet::photon_shooter_test
