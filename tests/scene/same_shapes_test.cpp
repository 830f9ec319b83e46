// Scenes that follow each other, and what finds surfaces in them.
#include "core/scene/data/same_shapes.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::same_shapes_test {
namespace {

SceneData room(float albedo, float height = 1) {
    SceneData data;
    const auto matte = test::diffuse(data, albedo);
    test::add(data, test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), matte);
    test::add(data, test::quad({0, 0, height}, {1, 0, 0}, {0, 1, 0}), matte);
    test::add(data, Sphere{}, matte);
    return data;
}

TEST(SameShapes, AreToldFromOthers) {
    EXPECT_TRUE(have_same_shapes(room(0.5f), room(0.7f)));
    EXPECT_FALSE(have_same_shapes(room(0.5f), room(0.5f, 2)));
    auto padded = room(0.5f);
    std::get<Mesh>(padded.shapes[0].geometry).positions.emplace_back();
    EXPECT_TRUE(have_same_shapes(padded, room(0.5f))) << "a tree was built of it";
    auto fewer = room(0.5f);
    fewer.shapes.pop_back();
    EXPECT_FALSE(have_same_shapes(room(0.5f), fewer));
    auto other = room(0.5f);
    std::get<Mesh>(other.shapes[1].geometry).triangles.pop_back();
    EXPECT_FALSE(have_same_shapes(room(0.5f), other));
    auto cut_out = room(0.5f);
    cut_out.materials[0].opacity = test::colour(cut_out, {0.5f, 0.5f, 0.5f});
    EXPECT_FALSE(have_same_shapes(cut_out, cut_out)) << "more hangs on that than shapes";
    auto gone = room(0.5f);
    gone.materials[0].model = NoMaterial{};
    EXPECT_FALSE(have_same_shapes(room(0.5f), gone));
}

TEST(SameShapes, AreFoundByTheTreesOfASceneThatIsGone) {
    const Ray down{{0.25f, 0.25f, 5}, {0, 0, -1}, 1e9f};
    auto before = std::make_unique<const Scene>(room(0.5f));
    const auto expected = before->intersect(down);
    const Scene now(room(0.7f)), later(room(0.9f)), taller(room(0.5f, 2));
    ASSERT_TRUE(expected);
    const float before_offset = before->surface(*expected).offset;
    EXPECT_GT(before_offset, 0);
    auto wide = room(0.5f);
    for (Vec3& corner : std::get<Mesh>(wide.shapes[1].geometry).positions)
        corner = corner + (corner - Vec3{0, 0, 1}) * 9;
    const Scene wider(wide);
    EXPECT_GT(wider.surface(*wider.intersect(down)).offset, before_offset) << "nothing of other shapes is taken";
    before.reset();
    for (const Scene* scene : {&now, &later}) {
        const auto hit = scene->intersect(down);
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->geometry, expected->geometry);
        EXPECT_EQ(hit->distance, expected->distance);
        EXPECT_EQ(scene->surface(*hit).position.z, 1);
        EXPECT_EQ(scene->surface(*hit).offset, before_offset);
    }
    EXPECT_NE(now.bsdf(now.surface(*now.intersect(down))).lobes(), 0);
    EXPECT_FLOAT_EQ(taller.intersect(down)->distance, 3);
}

}  // namespace
}  // namespace lightnet::same_shapes_test
