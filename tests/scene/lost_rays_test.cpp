// Rays that can't be traced meet nothing, and are told of; no number ends the process.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <limits>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/unwanted.hpp"
#include "core/scene/geometry/lost_rays.hpp"
#include "core/scene/reach.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::lost_rays_test {
namespace {

using namespace test;

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr std::array bad_numbers{nan, inf, -inf, 3e38f, -3e38f, 1e19f, 2e18f};

class Counting final : public LostRays {
public:
    void lost() override { ++count; }
    int count = 0;
};

// A wall, a ball, a disk and two instances, one of which is small.
SceneData one_of_each() {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    add(data, quad({-1, -1, 3}, {2, 0, 0}, {0, 2, 0}), grey);
    add(data, ball({0, 0, 5}, 1), grey);
    add(data, Quadric{}, grey);
    add(data, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), grey);
    data.objects.push_back({"part", {3}});
    Matrix small;
    for (std::size_t i = 0; i < 3; ++i) small.m[i][i] = 1e-3;
    small.m[2][3] = 2;
    Matrix far;
    far.m[2][3] = 20;
    data.instances = {{0, small}, {0, far}};
    return data;
}

std::vector<Ray> bad_rays() {
    std::vector<Ray> rays{{{0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 1}, nan}};
    for (const float number : bad_numbers)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Ray from{{0, 0, 0}, {0, 0, 1}}, towards{{0, 0, 0}, {0, 0, 1}};
            from.origin[axis] = number;
            towards.direction[axis] = number;
            rays.push_back(from), rays.push_back(towards);
        }
    return rays;
}

TEST(LostRays, MeetNothingAndAreToldOf) {
    const Scene scene(one_of_each());
    Counting counting;
    const TellingOfLostRays telling(counting);
    int told = 0;
    for (const Ray& ray : bad_rays()) {
        EXPECT_FALSE(scene.intersect(ray));
        EXPECT_FALSE(scene.occluded(ray));
        EXPECT_EQ(counting.count, told += 2);
    }
}

TEST(LostRays, ChangeNothingForThoseBesideThemInAPacket) {
    const Scene scene(one_of_each());
    const Ray good{{0.1f, 0.2f, -5}, {0, 0, 1}};
    const auto alone = scene.intersect(good);
    ASSERT_TRUE(alone);
    Counting counting;
    const TellingOfLostRays telling(counting);
    for (const Ray& bad : bad_rays())
        for (const std::size_t count : {1u, 3u, 4u, 5u, 8u, 11u, 16u}) {
            std::vector<Ray> rays(count, good);
            rays[count / 2] = bad;
            std::vector<std::optional<Hit>> hits(count);
            std::vector<std::uint8_t> hidden(count);
            counting.count = 0;
            scene.intersect(rays, hits);
            scene.occluded(rays, hidden);
            EXPECT_EQ(counting.count, 2);
            for (std::size_t i = 0; i < count; ++i) {
                EXPECT_EQ(hits[i].has_value(), i != count / 2);
                EXPECT_EQ(hidden[i] != 0, i != count / 2);
                if (hits[i]) {
                    EXPECT_EQ(hits[i]->distance, alone->distance);
                }
            }
        }
}

// Callers leave lanes empty so; a lamp that lies where the surface is has no way to it.
TEST(LostRays, AreNotThoseThatEndWhereTheyBegin) {
    const Scene scene(one_of_each());
    Counting counting;
    const TellingOfLostRays telling(counting);
    EXPECT_FALSE(scene.occluded(Ray{{0, 0, 0}, {nan, 0, 0}, 0}));
    EXPECT_EQ(counting.count, 0);
}

TEST(LostRays, AreNotThoseOfScenesWithinReach) {
    SceneData data = one_of_each();
    add(data, ball({0, 0, 5e14f}, 1e14f), 0);
    const Scene scene(std::move(data));
    Counting counting;
    const TellingOfLostRays telling(counting);
    EXPECT_TRUE(scene.intersect(Ray{{0, 0, -9e14f}, {0, 0, 1}}));
    EXPECT_EQ(counting.count, 0);
}

TEST(LostRays, HaveNoSurfaceNearTheirBeginning) {
    const Scene scene(one_of_each());
    for (const float number : bad_numbers) {
        EXPECT_FALSE(scene.nearest({0, number, 0}, {}, 1));
        EXPECT_FALSE(scene.nearest({0, 0, 0}, {}, number));
    }
}

TEST(Reach, OfAnInstanceEndsWhereEmbreeCanNotInvertIt) {
    for (const double scale : {1e-30, 1e-14, 0.0, 1e14, 1e30}) {
        SceneData data = one_of_each();
        for (std::size_t i = 0; i < 3; ++i) data.instances[0].to_world.m[i][i] = scale;
        EXPECT_FALSE(out_of_reach(data, "s").empty()) << scale;
        if (scale < 1) {
            EXPECT_THROW(Scene{std::move(data)}, Error) << scale;
        }
    }
    EXPECT_TRUE(out_of_reach(one_of_each(), "s").empty());
}

TEST(Unwanted, RaysEndTheWorkThatTracesThem) {
    const Scene scene(one_of_each());
    std::atomic<bool> stop{false};
    const LookingAt looking(&stop);
    const auto many = [&] {
        for (int i = 0; i < 3000; ++i) scene.intersect(Ray{{0, 0, -5}, {0, 0, 1}});
    };
    EXPECT_NO_THROW(many());
    stop = true;
    EXPECT_THROW(many(), Cancelled);
    SceneData moved = one_of_each();  // or the trees of the scene before would serve
    moved.instances[0].to_world.m[0][3] += 1;
    EXPECT_THROW(Scene{moved}, Cancelled) << "trees, too";
}

}  // namespace
}  // namespace lightnet::lost_rays_test
