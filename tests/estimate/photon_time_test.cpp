// Times of photons, and whose count near one of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "core/base/math/sampling.hpp"
#include "core/estimate/photon_shooter.hpp"
#include "core/estimate/photon_spread.hpp"
#include "core/estimate/photon_tree.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::photon_time_test {
namespace {

using namespace test;

constexpr Vec3 up{0, 1, 0};

Photon photon_at(Vec3 position, PhotonTime when) {
    Photon photon(position, {1, 1, 1}, up, up);
    photon.put_time(when);
    return photon;
}

TEST(PhotonTime, TakesATenthOfADegreeOfWhereLightComesFrom) {
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const auto part = [&](unsigned k) { return float(mix(7 + 3 * i + k) >> 40) / float(1 << 23) - 1; };
        const Vec3 d = normalize({part(0), part(1), part(2)});
        Photon photon({}, {}, d, up, 200);
        const std::uint32_t instant = i % PhotonTime::instants;
        photon.put_time({instant, i % 3 == 0});
        EXPECT_EQ(photon.time().instant, instant);
        EXPECT_EQ(photon.time().on_what_moves, i % 3 == 0);
        EXPECT_EQ(Photon::group_in(photon.surface), 200u);
        EXPECT_LT(length(photon.towards_light() - d), 0.0035f);  // 0.2°, where the octahedron is stretched most
    }
}

TEST(PhotonTime, IsATimeOfItsOwnInstant) {
    for (std::uint32_t instant = 0; instant < PhotonTime::instants; ++instant)
        EXPECT_EQ(PhotonTime::instant_of(PhotonTime::middle_of(instant)), instant);
    EXPECT_EQ(PhotonTime::instant_of(shutter_closes), PhotonTime::instants - 1);
}

TEST(PhotonWindow, EndsWhereTheShutterOpensAndCloses) {
    const auto middle = PhotonWindow::around(256, 0.25f), first = PhotonWindow::around(0, 0.25f),
               last = PhotonWindow::around(511, 0.25f);
    EXPECT_EQ(middle.first, 192u);
    EXPECT_EQ(middle.count, 129u);
    EXPECT_EQ(first.count, 65u);
    EXPECT_EQ(last.count, 65u);
    EXPECT_TRUE(first.has(0) && first.has(64) && !first.has(65));
    EXPECT_TRUE(last.has(511) && last.has(447) && !last.has(446));
    EXPECT_TRUE(PhotonWindow::around(300, 2).whole());
    EXPECT_EQ(PhotonWindow::around(300, 0).count, 1u);
}

TEST(PhotonWindow, IsFoundInATreeAlone) {
    std::vector<Photon> photons;
    for (std::uint32_t i = 0; i < 5120; ++i)
        photons.push_back(
            photon_at({float(mix(i) >> 40) / float(1 << 24), 0, float(mix(i + 9999) >> 40) / float(1 << 24)},
                      {i % PhotonTime::instants, true}));
    const PhotonTree tree(photons);
    Nearest scratch;
    for (const std::uint32_t instant : {0u, 3u, 100u, 511u}) {
        const PhotonWindow when = PhotonWindow::around(instant, 0.1f);
        const auto found = tree.find({{0.5f, 0, 0.5f}, up, 2, 0, when}, scratch);
        EXPECT_EQ(found.size(), 10 * when.count);
        for (const auto& item : found) EXPECT_TRUE(when.has(tree[item.index].time().instant));
    }
}

/// A plate of 0.2 m that goes by 2 m, over a floor that stands still. The sun is above them.
SceneData plate_that_goes() {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0));
    add(data, quad({-1.1f, 1, -0.1f}, {0, 0, 0.2f}, {0.2f, 0, 0}), diffuse(data, 0.5f));
    data.motion.shapes.push_back({1, {quad({0.9f, 1, -0.1f}, {0, 0, 0.2f}, {0.2f, 0, 0})}});
    data.lights.push_back(DirectionalLight{{0, -1, 0}, {2, 2, 2}});
    return data;
}

float middle_of_plate(PhotonTime when) { return -1 + 2 * part_of_shutter(when.time()); }

TEST(PhotonShooter, SaysWhenPhotonsCameAndToWhatMoves) {
    const Scene scene(plate_that_goes());
    std::vector<Photon> photons;
    PhotonShooter(scene, PhotonPaths::all, 3).shoot(0, 200000, 1, Aim(), photons);
    std::set<std::uint32_t> instants;
    std::size_t on_plate = 0;
    for (const Photon& photon : photons) {
        const bool is_on_plate = photon.position.y > 0.5f;
        ASSERT_EQ(photon.time().on_what_moves, is_on_plate);
        instants.insert(photon.time().instant);
        if (!is_on_plate) continue;
        ++on_plate;
        ASSERT_LT(std::fabs(photon.position.x - middle_of_plate(photon.time())), 0.1001f);
    }
    EXPECT_EQ(instants.size(), PhotonTime::instants);
    EXPECT_GT(on_plate, 20u);
}

// Elsewhere the plate is only at other times: from there a disc would seem to lie on nothing.
TEST(PhotonSpread, LooksForSurfaceAtThePhotonsTime) {
    const Scene scene(plate_that_goes());
    std::vector<Photon> photons;
    for (std::uint32_t instant = 0; instant < PhotonTime::instants; ++instant) {
        const PhotonTime when{instant, true};
        photons.push_back(photon_at({middle_of_plate(when), 1, 0}, when));
    }
    PhotonSpread(scene, 0.05f).spread(photons, 7);
    for (const Photon& photon : photons) ASSERT_EQ(photon.flux.g, 1);
}

}  // namespace
}  // namespace lightnet::photon_time_test
