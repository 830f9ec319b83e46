// Edits of lamps and materials, made again and again of one scene.
#include "core/readers/part_edits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/scene/data/identity.hpp"

namespace lightnet::part_edits_test {
namespace {

using testing::HasSubstr;

SceneData room() {
    SceneData scene;
    scene.textures = {{{0.5f, 0.5f, 0.5f}, {}, false}, {{0.9f, 0.1f, 0.1f}, {}, false}};
    scene.materials = {{"wall", DiffuseMaterial{0}},
                       {"tin", ConductorMaterial{{0, 0, TextureId(1)}, {0.1f, 0.2f, {}}}},
                       {"wall", DiffuseMaterial{1}},
                       {"both", MixtureMaterial{0, 1, 0}}};
    for (std::uint32_t i = 0; i < 3; ++i) {
        auto& shape = scene.shapes.emplace_back();
        shape.geometry = Sphere{{float(i), 0, 0}, 0.4f, false, {}};
        shape.material = i;
    }
    scene.shapes[2].emission = AreaEmission{{1, 2, 3}};
    scene.shapes[2].emission->label.name = "panel";
    PointLight bulb;
    bulb.strength() = {4, 4, 4};
    bulb.label.name = "bulb";
    scene.lights = {bulb};
    scene.environments.resize(1);
    scene.environments[0].radiance = {1, 1, 1};
    return scene;
}

Hash hash_of(SceneData scene) { return identity_of(scene); }

SceneData edited(const PartEdits& edits) {
    SceneData scene = room();
    edit_parts(edits, scene, {"g.lua", 3});
    return scene;
}

std::string error_of(const PartEdits& edits) {
    SceneData scene = room();
    try {
        edit_parts(edits, scene, {"g.lua", 3});
    } catch (const UserError& error) {
        EXPECT_EQ(hash_of(scene), hash_of(room())) << "it is as it was";
        return error.what();
    }
    return {};
}

const PartEdits many{{{"panel", {2, 1, 0.5f}}, {"b*", {3, 3, 3}}, {"environment", {0, 1, 0}}},
                     {{"wall", {0.2f, 0.3f, 0.4f}}, {"tin", {1, 0.8f, 0.5f}}},
                     {{"tin", {0.7f, 0.7f, 0.7f}}},
                     2};

TEST(PartEdits, ChangeLampsByTheirNames) {
    const SceneData scene = edited(many);
    EXPECT_EQ(scene.shapes[2].emission->radiance, (Rgb{2, 2, 1.5f}));
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).intensity, (Rgb{12, 12, 12}));
    EXPECT_EQ(scene.environments[0].radiance, (Rgb{0, 2, 0}));
}

TEST(PartEdits, ChangeAllMaterialsOfAName) {
    const SceneData scene = edited(many);
    for (const std::size_t wall : {0u, 2u}) {
        const auto& paint = std::get<DiffuseMaterial>(scene.materials[wall].model);
        EXPECT_EQ(scene.textures[paint.reflectance].scale, (Rgb{0.2f, 0.3f, 0.4f}));
    }
    const auto& tin = std::get<ConductorMaterial>(scene.materials[1].model);
    EXPECT_EQ(scene.textures[*tin.metal.reflectance].scale, (Rgb{1, 0.8f, 0.5f}));
    EXPECT_EQ(tin.roughness.u, 0.7f);
    EXPECT_EQ(tin.roughness.v, 0.7f);
}

TEST(PartEdits, AreOfTheSceneAsItWasBeforeTheFirst) {
    SceneData scene = room();
    const PartEdits none, dark{{{"*", {0, 0, 0}}}}, less{{{"panel", {0.5f, 0.5f, 0.5f}}}, {{"tin", {0, 1, 0}}}};
    for (const auto& edits : {many, dark, less, many, none}) {
        edit_parts(edits, scene, {});
        EXPECT_EQ(hash_of(scene), hash_of(edited(edits)));
    }
    EXPECT_EQ(hash_of(scene), hash_of(room()));
}

TEST(PartEdits, SayWhatTheyCannotChange) {
    EXPECT_THAT(error_of({{{"pannel", {}}}}), HasSubstr("g.lua:3: 'lamps': there is no lamp called 'pannel'"));
    EXPECT_THAT(error_of({{}, {{"tina", {}}}}),
                HasSubstr("'colours': there is no material called 'tina' (did you mean"));
    EXPECT_THAT(error_of({{}, {{"both", {}}}}), HasSubstr("'colours': material 'both' is mixture, which has none"));
    EXPECT_THAT(error_of({{}, {}, {{"wall", {}}}}),
                HasSubstr("'roughness': material 'wall' is diffuse, which has none"));
}

TEST(PartEdits, AreNotMadeAgainWhereSomethingMoves) {
    SceneData scene = room();
    EXPECT_FALSE(may_be_edited(scene)) << "nobody knows what it was";
    edit_parts({}, scene, {});
    EXPECT_TRUE(may_be_edited(scene));
    scene.motion.lights.push_back({0, {scene.lights[0]}});
    EXPECT_FALSE(may_be_edited(scene));
}

}  // namespace
}  // namespace lightnet::part_edits_test
