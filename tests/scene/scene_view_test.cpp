// Views of a scene: whoever declares what it reads sees that, and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/scene_media.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::scene_view_test {
namespace {

using testing::HasSubstr;

SceneData ball_under_a_lamp() {
    SceneData data;
    test::add(data, test::ball({0, 0, 0}, 1), test::diffuse(data, 0.5f));
    data.lights = {PointLight{{0, 0, 5}, {1, 1, 1}}};
    return data;
}

Query of_the_ball() {
    Query query;
    query.u = query.v = 0.25f;
    query.outgoing = {0, 0, 1};
    return query;
}

/// All ways to read something of a scene, with the parts that each needs.
struct Read {
    const char* name;
    SceneParts parts;
    std::function<void(const Scene&)> read;
};

std::vector<Read> reads_of_geometry() {
    const SceneParts geometry = ScenePart::geometry;
    const Ray ray{{0, 0, 5}, {0, 0, -1}};
    return {{"intersect", geometry, [=](const Scene& scene) { scene.intersect(ray); }},
            {"occluded", geometry, [=](const Scene& scene) { scene.occluded(ray); }},
            {"many rays", geometry,
             [=](const Scene& scene) {
                 std::vector<std::optional<Hit>> hits(1);
                 scene.intersect(std::span(&ray, 1), hits);
             }},
            {"many shadow rays", geometry,
             [=](const Scene& scene) {
                 std::vector<std::uint8_t> hidden(1);
                 scene.occluded(std::span(&ray, 1), hidden);
             }},
            {"nearest", geometry,
             [](const Scene& scene) {
                 scene.nearest({0, 0, 1}, {0, 0, 1}, 0.1f);
             }},
            {"hit", geometry, [](const Scene& scene) { scene.hit(of_the_ball()); }},
            {"surface", geometry, [](const Scene& scene) { scene.surface(of_the_ball()); }},
            {"bounds", geometry, [](const Scene& scene) { scene.bounds(); }},
            {"radius", geometry, [](const Scene& scene) { scene.radius(); }},
            {"moves", geometry | ScenePart::lamps, [](const Scene& scene) { scene.moves(); }},
            {"column_shapes", geometry | ScenePart::materials, [](const Scene& scene) { scene.column_shapes(); }},
            {"shapes", geometry | ScenePart::lamps | ScenePart::names, [](const Scene& scene) { scene.all<Shape>(); }},
            {"objects", geometry | ScenePart::names, [](const Scene& scene) { scene.all<Object>(); }},
            {"instances", geometry | ScenePart::names, [](const Scene& scene) { scene.all<Instance>(); }}};
}

std::vector<Read> reads_of_light() {
    const SceneParts lamps = ScenePart::lamps;
    const Ray ray{{0, 0, 5}, {0, 0, 1}};
    return {{"lights", lamps, [](const Scene& scene) { scene.lights(); }},
            {"may_shine", lamps, [=](const Scene& scene) { scene.may_shine(ray); }},
            {"lobes", ScenePart::materials, [](const Scene& scene) { scene.lobes({}); }},
            {"bsdf", ScenePart::materials, [](const Scene& scene) { scene.bsdf({}); }},
            {"materials", ScenePart::materials | ScenePart::names, [](const Scene& scene) { scene.all<Material>(); }},
            {"has_media", ScenePart::media, [](const Scene& scene) { scene.has_media(); }},
            {"fly", ScenePart::media,
             [=](const Scene& scene) {
                 scene.media().fly(ray, {1, 1, 1}, {});
             }},
            {"transmittance", ScenePart::media, [=](const Scene& scene) { scene.media().transmittance(ray, {}); }}};
}

std::vector<Read> reads_of_the_eye() {
    return {{"camera", ScenePart::camera, [](const Scene& scene) { scene.camera(); }},
            {"seen_from", ScenePart::camera, [](const Scene& scene) { scene.seen_from(); }},
            {"film", ScenePart::film, [](const Scene& scene) { scene.film(); }},
            {"size", whole_scene, [](const Scene& scene) { scene.size(); }},
            {"data", whole_scene, [](const Scene& scene) { scene.data(); }}};
}

std::vector<Read> all_reads() {
    std::vector<Read> all;
    for (auto& some : {reads_of_geometry(), reads_of_light(), reads_of_the_eye()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

SceneParts without(SceneParts parts, ScenePart one) {
    SceneParts rest;
    for (const ScenePart part : all_scene_parts)
        if (part != one && parts.contain(part)) rest |= part;
    return rest;
}

// What is wrong with a read, of a scene of which only these parts are in view.
std::string refusal(const Scene& scene, SceneParts in_view, const Read& read) {
    const Scene view(scene, SceneView{.parts = in_view});
    try {
        read.read(view);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(SceneView, LetsReadWhatIsInView) {
    const Scene scene(ball_under_a_lamp());
    for (const Read& read : all_reads()) EXPECT_EQ(refusal(scene, read.parts, read), "") << read.name;
}

TEST(SceneView, TrapsEachReadOfWhatIsNot) {
    const Scene scene(ball_under_a_lamp());
    for (const Read& read : all_reads())
        for (const ScenePart part : all_scene_parts) {
            if (!read.parts.contain(part)) continue;
            EXPECT_THAT(refusal(scene, without(whole_scene, part), read), HasSubstr("it reads " + to_string(part)))
                << read.name;
        }
}

TEST(SceneView, SaysWhatIsMissingAndWhatWasDeclared) {
    const Scene scene(ball_under_a_lamp());
    const Read camera = reads_of_the_eye().front();
    EXPECT_EQ(refusal(scene, ScenePart::geometry | ScenePart::lamps, camera),
              "scene: it reads camera, and its kind declares that it reads geometry, lamps: name camera in the kind's "
              "'reads', too");
    EXPECT_THAT(refusal(scene, {}, camera), HasSubstr("declares that it reads nothing"));
}

TEST(SceneView, SharesLampsWhereTheSameAreLookedFor) {
    const Scene scene(ball_under_a_lamp());
    const Scene view(scene, SceneView{.parts = scene_of_light});
    const auto whole = scene.lights().sample(LitPoint(Vec3{0, 0, 2}), 0.5f, {}),
               seen = view.lights().sample(LitPoint(Vec3{0, 0, 2}), 0.5f, {});
    ASSERT_TRUE(whole && seen);
    EXPECT_EQ(whole->radiance, seen->radiance);
}

TEST(SceneParts, AreNamedInTheirOrder) {
    EXPECT_EQ(to_string(ScenePart::names | ScenePart::camera), "camera, names");
    EXPECT_EQ(to_string(SceneParts()), "nothing");
    EXPECT_EQ(to_string(whole_scene), "everything");
}

TEST(SceneParts, MakeUpTheWholeScene) {
    SceneParts all;
    for (const ScenePart part : all_scene_parts) all |= part;
    EXPECT_EQ(all, whole_scene);
}

}  // namespace
}  // namespace lightnet::scene_view_test
