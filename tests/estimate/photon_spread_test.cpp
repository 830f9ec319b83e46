// Discs around photons: how much of them is surface.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/estimate/photon_spread.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::photon_spread_test {
namespace {

using namespace test;

constexpr Vec3 up{0, 1, 0};
constexpr float radius = 0.2f;

PhotonSpread spread_over(const Scene& scene) { return {scene, radius}; }

// What many photons at one place bring, each of which brought 1.
double brought_at(const Scene& scene, Vec3 position) {
    std::vector<Photon> photons(4000, Photon(position, {1, 1, 1}, up, up));
    spread_over(scene).spread(photons, 7);
    double sum = 0;
    for (const Photon& photon : photons) sum += photon.flux.g;
    return sum / double(photons.size());
}

SceneData unit_floor() {
    SceneData data;
    add(data, quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), diffuse(data, 0.5f));
    return data;
}

TEST(PhotonSpread, ChangesNothingInTheMiddleOfAFloor) {
    EXPECT_EQ(brought_at(Scene(unit_floor()), {0.5f, 0, 0.5f}), 1);
}

TEST(PhotonSpread, GivesBackWhatDiscsLoseAtEdgesAndCorners) {
    const Scene scene(unit_floor());
    EXPECT_NEAR(brought_at(scene, {1e-4f, 0, 0.5f}), 2, 0.1);
    EXPECT_NEAR(brought_at(scene, {1e-4f, 0, 1e-4f}), 4, 0.25);
}

TEST(PhotonSpread, CountsNoFloorBelowABox) {
    SceneData data = unit_floor();
    add(data, quad({0.5f, 0.01f, 0}, {0, 0, 1}, {0.5f, 0, 0}), diffuse(data, 0.5f));
    add(data, quad({0.5f, 0.01f, 0}, {0, 0, 1}, {0, 0.3f, 0}), diffuse(data, 0.5f));
    EXPECT_NEAR(brought_at(Scene(data), {0.499f, 0, 0.5f}), 2, 0.15);
}

// Else it would be given away twice: here, and by leaking there, where others see it.
TEST(PhotonSpread, CountsThePartOfTheFloorBehindAThinWallThatIsOpen) {
    SceneData data = unit_floor();
    add(data, quad({0.5f, 0, 0}, {0, 0, 1}, {0, 1, 0}), diffuse(data, 0.5f));
    const double tall = brought_at(Scene(data), {0.499f, 0, 0.5f});
    EXPECT_GT(tall, 1.1);
    EXPECT_LT(tall, 1.6);
    SceneData leg = unit_floor();
    add(leg, quad({0.5f, 0, 0.49f}, {0, 0, 0.02f}, {0, 1, 0}), diffuse(leg, 0.5f));
    EXPECT_LT(brought_at(Scene(leg), {0.499f, 0, 0.5f}), 1.15);
}

TEST(PhotonSpread, MakesNoSpotsOfPhotonsInNarrowGaps) {
    const auto between_walls = [](float height) {
        SceneData data = unit_floor();
        for (const float side : {0.49f, 0.51f})
            add(data, quad({side, 0, 0}, {0, 0, 1}, {0, height, 0}), diffuse(data, 0.5f));
        for (const float side : {0.0f, 0.51f})  // of massive walls
            add(data, quad({side, 0.01f, 0}, {0, 0, 1}, {0.49f, 0, 0}), diffuse(data, 0.5f));
        return data;
    };
    const double tight = brought_at(Scene(between_walls(0.2f)), {0.5f, 0, 0.5f});
    EXPECT_GT(tight, 5);
    EXPECT_LE(tight, 12);
    SceneData covered = between_walls(0.03f);
    add(covered, quad({0.49f, 0.03f, 0}, {0, 0, 1}, {0.02f, 0, 0}), diffuse(covered, 0.5f));
    EXPECT_EQ(brought_at(Scene(covered), {0.5f, 0, 0.5f}), 1);
}

TEST(PhotonSpread, TellsWhichPartOfTheLightMissesItsSurface) {
    const Scene scene(unit_floor());
    std::vector<Photon> photons(4000, Photon({0.5f, 0, 0.5f}, {1, 1, 1}, up, up));
    photons.insert(photons.end(), 4000, Photon({1e-4f, 0, 0.5f}, {3, 3, 3}, up, up));
    const auto sums = spread_over(scene).missed(photons, 3);
    EXPECT_NEAR(sums.missed / sums.all, 0.375, 0.01);
}

// Of sixteen times as many photons, as many lie in discs of a quarter of the radius.
TEST(PhotonSpread, HasSmallerDiscsTheMorePhotonsThereWillBe) {
    const Scene scene(unit_floor());
    std::vector<Photon> even;
    for (int i = 0; i < 64; ++i)
        for (int k = 0; k < 64; ++k)
            even.emplace_back(Vec3{(float(i) + 0.5f) / 64, 0, (float(k) + 0.5f) / 64}, Rgb{1, 1, 1}, up, up);
    const auto pilot = std::make_shared<const PhotonTree>(std::span<const Photon>(even));
    const auto missed = [&](double times) {
        const auto sums = PhotonSpread(scene, pilot, 64, times, 1).missed(even, 3);
        return sums.missed / sums.all;
    };
    EXPECT_NEAR(missed(16), missed(1) / 4, 0.1 * missed(1));
}

}  // namespace
}  // namespace lightnet::photon_spread_test
