// Choosing one of many lights.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/unwanted.hpp"
#include "core/scene/lamps/light_tree.hpp"

namespace lightnet::light_tree_test {
namespace {

// `count` of them, scattered; the sixth is dark.
std::vector<LightBounds> scattered_lights(std::uint32_t count) {
    std::vector<LightBounds> lights;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(8, i);
        const Vec3 at = sphere(samples.next_2d()) * 3, turn = sphere(samples.next_2d());
        const bool all_around = i % 3 == 0;
        lights.push_back({at, at + Vec3{0.1f, 0.3f, 0}, turn, all_around ? -1.0f : 1.0f, 0,
                          i == 5 ? 0 : 0.1f + samples.next(), i % 4 == 1});
    }
    return lights;
}

/// How many lights: as few as are looked at one by one, more, and so many that all cores sort them.
class LightTrees : public testing::TestWithParam<std::uint32_t> {};

TEST_P(LightTrees, ChooseAsOftenAsTheySay) {
    const auto lights = scattered_lights(GetParam());
    const LightTree tree(lights);
    for (const LitPoint from : {LitPoint({0, 0, 0}), LitPoint({3, 0, 0}), LitPoint({-50, 20, 9}),
                                LitPoint({0, -2, 0}, {0, 1, 0}), LitPoint({4, 0, 0}, {-0.6f, 0, 0.8f})}) {
        std::vector<double> count(lights.size());
        double none = 0;  // where a node may shine on the point, and none of its lights does
        for (std::uint32_t i = 0; i < 1 << 16; ++i) {
            float u = (float(i) + 0.5f) / (1 << 16);
            const auto choice = tree.choose(from, u);
            if (!choice) {
                none += 0x1p-16;
                continue;
            }
            ASSERT_GE(u, 0);
            ASSERT_LT(u, 1);
            ASSERT_NEAR(choice->chance / tree.chance(from, choice->light), 1, 1e-4f);
            count[choice->light] += 0x1p-16;
        }
        double all = 0;
        for (std::uint32_t i = 0; i < lights.size(); ++i) {
            EXPECT_NEAR(count[i], tree.chance(from, i), 1e-3);
            all += tree.chance(from, i);
        }
        EXPECT_NEAR(all + none, 1, 1e-3);
        EXPECT_LT(none, lights.size() < 100 ? 1e-9 : 0.5);
        EXPECT_EQ(count[5], 0);
    }
}

TEST_P(LightTrees, ChooseForManyPointsAsForEach) {
    const LightTree tree(scattered_lights(GetParam()));
    for (const std::size_t points : {1, 3, 8, 9, 32}) {
        std::vector<LitPoint> from;
        std::vector<float> places;
        for (std::uint32_t i = 0; i < points; ++i) {
            Samples samples(14, i);
            const Vec3 at = sphere(samples.next_2d()) * 4;
            from.push_back(i % 3 == 0 ? LitPoint(at) : LitPoint(at, sphere(samples.next_2d())));
            places.push_back(samples.next());
        }
        auto alone = places;
        std::vector<LightChoice> chosen(points);
        tree.choose(from, places, chosen);
        std::vector<LampMet> met;
        for (std::size_t i = 0; i < points; ++i) met.push_back({from[i], chosen[i].light, 1});
        std::vector<float> chances(points);
        tree.chances(met, chances);
        for (std::size_t i = 0; i < points; ++i) EXPECT_EQ(chances[i], tree.chance(from[i], chosen[i].light));
        for (std::size_t i = 0; i < points; ++i) {
            const auto one = tree.choose(from[i], alone[i]);
            ASSERT_EQ(one.has_value(), chosen[i].chance > 0);
            if (!one) continue;
            EXPECT_EQ(one->light, chosen[i].light);
            EXPECT_EQ(one->chance, chosen[i].chance);
            EXPECT_EQ(alone[i], places[i]);
        }
    }
}

/// As LightTrees, of more lights, too.
class LargerLightTrees : public LightTrees {};

TEST_P(LargerLightTrees, ReachEveryLightThatShinesOnThePoint) {
    std::vector<LightBounds> lights;
    for (std::uint32_t i = 0; i < GetParam(); ++i) {
        Samples samples(9, i);
        const Vec3 at = sphere(samples.next_2d()) * 3;
        lights.push_back({at, at, sphere(samples.next_2d()), 1, i % 2 ? 0.0f : 0.8f, 1, false});
    }
    const LightTree tree(lights);
    for (std::uint32_t k = 0; k < 200; ++k) {
        const Vec3 from = sphere(Samples(10, k).next_2d()) * (0.05f * float(k));
        for (std::uint32_t i = 0; i < lights.size(); ++i) {
            const bool lit = dot(normalize(from - lights[i].low), lights[i].axis) > lights[i].cos_reach;
            ASSERT_TRUE(!lit || tree.chance(LitPoint(from), i) > 0);
        }
    }
}

// Boxes, some of which the plane of the surface cuts: whatever has a corner above it can light it.
TEST_P(LargerLightTrees, LeaveOutNothingThatIsAboveTheSurface) {
    std::vector<LightBounds> lights;
    for (std::uint32_t i = 0; i < GetParam(); ++i) {
        Samples samples(11, i);
        const Vec3 at = sphere(samples.next_2d()) * (3 * samples.next());
        const Vec2 size = samples.next_2d();
        lights.push_back({at, at + Vec3{size.x, size.y, 0.1f} * 0.5f, {0, 0, 1}, -1, 0, 1, false});
    }
    const LightTree tree(lights);
    std::size_t left_out = 0;
    for (std::uint32_t k = 0; k < 200; ++k) {
        const Vec3 place = sphere(Samples(12, k).next_2d()) * 0.5f, normal = sphere(Samples(13, k).next_2d());
        for (std::uint32_t i = 0; i < lights.size(); ++i) {
            const auto& [low, high, axis, spread, reach, intensity, two_sided] = lights[i];
            const Vec3 corner{normal.x > 0 ? high.x : low.x, normal.y > 0 ? high.y : low.y,
                              normal.z > 0 ? high.z : low.z};
            const float chance = tree.chance({place, normal}, i);
            ASSERT_TRUE(dot(corner - place, normal) <= 0 || chance > 0);
            left_out += chance == 0;
        }
    }
    EXPECT_GT(left_out, 200u * GetParam() / 3);
}

const auto as_name = [](const auto& count) { return std::to_string(count.param) + "Lights"; };
INSTANTIATE_TEST_SUITE_P(Of, LightTrees, testing::Values(7, 20, 33, 34, 80, 40000), as_name);
INSTANTIATE_TEST_SUITE_P(Of, LargerLightTrees, testing::Values(30, 300), as_name);

TEST(LightTree, IsNotBuiltWhenNobodyWantsItAnyMore) {
    const std::atomic<bool> unwanted = true;
    const LookingAt looking(&unwanted);
    for (const std::uint32_t count : {100u, 40'000u}) EXPECT_THROW(LightTree{scattered_lights(count)}, Cancelled);
}

TEST(LightTree, OfNoLightsChoosesNone) {
    for (const LightTree& tree :
         {LightTree(), LightTree(std::vector<LightBounds>{}), LightTree(std::vector<LightBounds>(3))}) {
        float u = 0.5f;
        EXPECT_FALSE(tree.choose(LitPoint({0, 0, 0}), u));
    }
}

TEST(LightTree, PrefersWhatStandsAboveToWhatIsSeenFromTheSide) {
    const LightTree tree({{{0, 1, 0}, {0, 1, 0}, {0, 0, 1}, -1, 0, 1, false},
                          {{0.8f, 0.6f, 0}, {0.8f, 0.6f, 0}, {0, 0, 1}, -1, 0, 1, false},
                          {{0, -1, 0}, {0, -1, 0}, {0, 0, 1}, -1, 0, 1, false}});
    const LitPoint floor({0, 0, 0}, {0, 1, 0});
    EXPECT_NEAR(tree.chance(floor, 0), 1 / 1.6, 1e-3);
    EXPECT_NEAR(tree.chance(floor, 1), 0.6 / 1.6, 1e-3);
    EXPECT_EQ(tree.chance(floor, 2), 0);
    EXPECT_NEAR(tree.chance(LitPoint({0, 0, 0}), 2), 1 / 3.0, 1e-3);
}

TEST(LightTree, BearsLightsInOnePlace) {
    const LightTree tree(std::vector<LightBounds>(1000, {{1, 1, 1}, {1, 1, 1}, {0, 0, 1}, -1, 0, 2, false}));
    float u = 0.7f;
    const auto choice = tree.choose(LitPoint({0, 0, 0}), u);
    ASSERT_TRUE(choice);
    EXPECT_NEAR(choice->chance, 1e-3f, 1e-6f);
}

}  // namespace
}  // namespace lightnet::light_tree_test
