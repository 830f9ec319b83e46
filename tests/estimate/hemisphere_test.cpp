// Irradiance and its gradients, beside light that is known.
#include <gtest/gtest.h>

#include "core/base/math/sampling.hpp"
#include "core/base/unwanted.hpp"
#include "core/estimate/hemisphere.hpp"
#include "core/estimate/irradiance_octree.hpp"

#include <atomic>
#include <cmath>
#include <functional>

namespace lightnet::hemisphere_test {
namespace {

using Sky = std::function<GatherResult(Vec3 origin, Vec3 direction)>;

IrradianceRecord record_of(Vec3 position, Vec3 normal, std::size_t rays, const Sky& sky, Key key = 1) {
    const Hemisphere hemisphere(rays);
    std::vector<GatherRay> rays_of_point;
    hemisphere.add_rays(position, normal, key, 0, rays_of_point);
    std::vector<GatherResult> seen;
    for (const GatherRay& ray : rays_of_point) seen.push_back(sky(ray.ray.origin, ray.ray.direction));
    return hemisphere.record(position, normal, seen);
}

// A ceiling at height 1 whose radiance changes with where it is, smoothly.
GatherResult ceiling(Vec3 origin, Vec3 direction) {
    if (direction.y <= 1e-4f) return {{}, 1e30f};
    const float way = (1 - origin.y) / direction.y;
    const float x = origin.x + way * direction.x, z = origin.z + way * direction.z;
    return {{1 / (1 + (x - 0.6f) * (x - 0.6f) + z * z), 1, 0.5f + 0.5f * x / (1 + x * x)}, way};
}

// Light that a third of all directions bring, by chance: of n rays, its relative standard deviation is √(2 / n).
TEST(Hemisphere, TellsTheNoiseOfItsRaysFromTwoLooksAround) {
    const std::size_t count = Hemisphere(384).size();
    Key next = 5;
    const auto look = [&] {
        std::vector<GatherResult> found(count, GatherResult{{}, 1});
        for (auto& one : found) {
            next = mix(next + 1);
            if (next % 3 == 0) one.light = {2, 2, 2};
        }
        return found;
    };
    double noise = 0;
    for (int trial = 0; trial < 100; ++trial) noise += double{Hemisphere::noise(look(), look())} / 100;
    EXPECT_NEAR(noise, std::sqrt(2 / double(count)), 0.02 * noise);
}

TEST(Hemisphere, FindsNoNoiseInWhatDiffersFromCellToCellAlone) {
    std::vector<GatherResult> sky;
    for (int i = 0; i < 100; ++i) sky.push_back({{float(i), 1, 0}, 1});
    EXPECT_EQ(Hemisphere::noise(sky, sky), 0);
    const std::vector<GatherResult> night(100, GatherResult{{}, 1});
    EXPECT_EQ(Hemisphere::noise(night, night), 0);
}

TEST(Hemisphere, SumsUpAnEvenSkyToPi) {
    for (const std::size_t rays : {8, 100, 512, 5000}) {
        const auto record = record_of({}, {0, 1, 0}, rays, [](Vec3, Vec3) { return GatherResult{{1, 2, 0}, 3}; });
        EXPECT_NEAR(record.irradiance.r, pi, 1e-3f);
        EXPECT_NEAR(record.irradiance.g, 2 * pi, 1e-3f);
        EXPECT_NEAR(record.distance, 3, 1e-3f);
        for (std::size_t colour = 0; colour < 3; ++colour)
            EXPECT_NEAR(length(record.moved[colour]), 0, 1e-3f) << "it is the same everywhere";
    }
}

// Differences of irradiances that are estimated by the same, many directions.
TEST(Hemisphere, KnowsHowIrradianceChangesWhenThePointMoves) {
    const Vec3 up{0, 1, 0}, at{0.1f, 0, 0.2f};
    const auto record = record_of(at, up, 40000, ceiling);
    constexpr float step = 0.1f;
    for (const Vec3 direction : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, normalize(Vec3{1, 0, -1})}) {
        const auto ahead = record_of(at + direction * step, up, 40000, ceiling);
        const auto behind = record_of(at - direction * step, up, 40000, ceiling);
        const Rgb change = (ahead.irradiance - behind.irradiance) / (2 * step);
        EXPECT_NEAR(dot(record.moved[0], direction), change.r, 0.05f);
        EXPECT_NEAR(dot(record.moved[2], direction), change.b, 0.05f);
    }
    EXPECT_GT(length(record.moved[0]), 0.3f) << "there is something to be found";
}

TEST(Hemisphere, KnowsHowIrradianceChangesWhenTheSurfaceTurns) {
    const Vec3 up{0, 1, 0}, at{0.1f, 0, 0.2f};
    // All around, so that nothing comes in over the horizon.
    const auto sky = [](Vec3, Vec3 d) { return GatherResult{{std::max(0.0f, d.y), 2 + d.x, 2 + d.z + d.x * d.y}, 1}; };
    const auto record = record_of(at, up, 40000, sky);
    constexpr float angle = 0.05f;
    for (const Vec3 sideways : {Vec3{1, 0, 0}, Vec3{0, 0, 1}}) {
        const Vec3 one = normalize(up + sideways * std::tan(angle)), other = normalize(up - sideways * std::tan(angle));
        const Rgb change =
            (record_of(at, one, 40000, sky).irradiance - record_of(at, other, 40000, sky).irradiance) / (2 * angle);
        const Vec3 axis = cross(up, sideways);
        EXPECT_NEAR(dot(record.turned[0], axis), change.r, 0.04f);
        EXPECT_NEAR(dot(record.turned[1], axis), change.g, 0.04f);
        EXPECT_NEAR(dot(record.turned[2], axis), change.b, 0.04f);
    }
    EXPECT_GT(length(record.turned[1]), 1.0f);
}

TEST(Hemisphere, GuessesBetterWithGradientsThanWithout) {
    const Vec3 up{0, 1, 0};
    const auto here = record_of({0, 0, 0}, up, 20000, ceiling);
    const Vec3 there{0.2f, 0, -0.1f};
    const auto exact = record_of(there, up, 20000, ceiling).irradiance;
    EXPECT_LT(std::fabs(here.at(there, up).r - exact.r), 0.3f * std::fabs(here.irradiance.r - exact.r));
}

IrradianceRecord plain(Vec3 at, float brightness, float distance) {
    return {at, {0, 1, 0}, {brightness, brightness, brightness}, distance, distance, {}, {}};
}
const Box box{{-2, -2, -2}, {2, 2, 2}};

TEST(IrradianceOctree, AnswersWithinReachOnly) {
    const std::vector<IrradianceRecord> records{plain({0, 0, 0}, 3, 1)};
    const IrradianceOctree tree(records, {0.2f, 0.01f, 1}, box);
    const Vec3 up{0, 1, 0};
    ASSERT_TRUE(tree.irradiance({0.1f, 0, 0}, up, 1));
    EXPECT_FLOAT_EQ(tree.irradiance({0.1f, 0, 0}, up, 1)->g, 3);
    EXPECT_FALSE(tree.irradiance({0.21f, 0, 0}, up, 1));
    EXPECT_TRUE(tree.irradiance({0.21f, 0, 0}, up, IrradianceOctree::most_stretch));
    EXPECT_FALSE(tree.irradiance({0.1f, 0, 0}, {1, 0, 0}, 1)) << "a wall is no floor";
    EXPECT_FALSE(tree.irradiance({0, -0.15f, 0}, up, 1)) << "the record sees nothing of what is below it";
}

TEST(IrradianceOctree, FindsEveryRecordThatReachesAPoint) {
    std::vector<IrradianceRecord> records;
    for (std::uint32_t i = 0; i < 500; ++i) {
        const auto part = [&](unsigned k) { return float(mix(11 + 3 * i + k) >> 40) / float(1 << 23) - 1; };
        records.push_back(plain({part(0), 0, part(1)}, 1, 0.3f + 0.2f * part(2)));
    }
    const IrradianceOctree tree(records, {0.5f, 0.001f, 10}, box);
    for (float x = -1; x < 1; x += 0.07f) EXPECT_TRUE(tree.covers({x, 0, 0.3f * x}, {0, 1, 0}));
    const IrradianceOctree none({}, {}, box);
    EXPECT_FALSE(none.covers({0, 0, 0}, {0, 1, 0}));
}

// Next to an edge distances are short, and gradients mostly noise; records still reach as far as the least spacing.
TEST(IrradianceOctree, DoesNotFollowAGradientFartherThanItHolds) {
    auto record = plain({0, 0, 0}, 1, 0.01f);
    for (Vec3& moved : record.moved) moved = {100, 0, 0};
    const IrradianceOctree tree(std::vector{record}, {0.25f, 0.1f, 1}, box);
    for (const float x : {-0.09f, 0.09f}) {
        const auto found = tree.irradiance({x, 0, 0}, {0, 1, 0}, 1);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->g, 1, 0.25f);
        EXPECT_EQ(found->g > 1, x > 0) << "it is followed as far as that";
    }
}

TEST(IrradianceOctree, IsNotBuiltWhenNobodyWantsItAnyMore) {
    const std::atomic<bool> unwanted = true;
    const LookingAt looking(&unwanted);
    const std::vector<IrradianceRecord> some{plain({0, 0, 0}, 1, 4), plain({-0.01f, 0, 0}, 1, 0.4f)};
    EXPECT_THROW(IrradianceOctree(some, {0.1f, 0.001f, 10}, box), Cancelled);
}

TEST(IrradianceOctree, DoesNotTrustARecordMoreThanItsNeighbours) {
    // Alone, the one that sees nothing near reaches far; beside one that sees something near, it doesn't.
    const Vec3 up{0, 1, 0}, away{0.3f, 0, 0};
    const std::vector<IrradianceRecord> alone{plain({0, 0, 0}, 1, 4)};
    EXPECT_TRUE(IrradianceOctree(alone, {0.1f, 0.001f, 10}, box).covers(away, up));
    const std::vector<IrradianceRecord> both{plain({0, 0, 0}, 1, 4), plain({-0.01f, 0, 0}, 1, 0.4f)};
    EXPECT_FALSE(IrradianceOctree(both, {0.1f, 0.001f, 10}, box).covers(away, up));
}

}  // namespace
}  // namespace lightnet::hemisphere_test
