// How lamps are called, format by format, and how they are sorted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/data/identity.hpp"
#include "core/scene/data/lamp_names.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::lamp_names_reader_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// "name/other (what)" of each lamp.
std::vector<std::string> names(const SceneData& scene) {
    std::vector<std::string> all;
    for (const auto& lamp : lamps_of(scene)) {
        std::string text;
        for (const auto& name : lamp.names) text += (text.empty() ? "" : "/") + name;
        all.push_back(text + " (" + lamp.what + ")" + (lamp.count > 1 ? " x" + std::to_string(lamp.count) : ""));
    }
    return all;
}

SceneData four_lamps() {
    return read_mitsuba(
        "<bsdf type='diffuse' id='white'/>"
        "<shape type='rectangle' id='ceiling'><ref id='white'/><emitter type='area' id='panel'/></shape>"
        "<emitter type='spot' id='spot.left'/><emitter type='spot'/><emitter type='directional'/>"
        "<emitter type='constant'/>");
}

TEST(LampNames, OfMitsubaAreIdsOfEmittersAndShapes) {
    EXPECT_THAT(names(four_lamps()), ElementsAre("panel/ceiling/white (shape)", "spot.left (spot)", "spot (spot)",
                                                 "sun (sun)", "environment (environment)"));
}

TEST(LampNames, OfPbrtAreParametersMaterialsAndFiles) {
    const SceneData scene =
        read_as("scene.pbrt",
                "WorldBegin\n"
                "LightSource \"point\" \"string name\" \"bulb\"\n"
                "LightSource \"spot\"\n"
                "AttributeBegin\nAttribute \"light\" \"string name\" \"key\"\n"
                "AreaLightSource \"diffuse\"\nMakeNamedMaterial \"glow\" \"string type\" \"diffuse\"\n"
                "NamedMaterial \"glow\"\nShape \"sphere\"\nShape \"sphere\"\nAttributeEnd\n"
                "AreaLightSource \"diffuse\"\nShape \"sphere\"\n");
    EXPECT_THAT(names(scene), ElementsAre("key/glow (shape) x2", "lamp (shape)", "bulb (point)", "spot (spot)"));
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(LampNames, OfGltfAreThoseOfNodes) {
    // a triangle besides, as a scene needs one
    const SceneData scene = read_as("scene.gltf", R"({"asset":{"version":"2.0"},
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","name":"Light.001"}]}},
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "nodes":[{"name":"Key","extensions":{"KHR_lights_punctual":{"light":0}}},
                 {"extensions":{"KHR_lights_punctual":{"light":0}}},{"mesh":0}],
        "scenes":[{"nodes":[0,1,2]}]})");
    EXPECT_THAT(names(scene), ElementsAre("Key (point)", "Light.001 (point)"));
}

TEST(LampNames, OfObjAreObjectsAndMaterials) {
    MemoryFiles files;
    files.add("lamp.mtl", "newmtl glow\nKe 1 1 1\n");
    const SceneData scene =
        read_as("scene.obj", "mtllib lamp.mtl\no shade\nusemtl glow\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", files);
    EXPECT_THAT(names(scene), ElementsAre("shade/glow (shape)"));
}

TEST(LampNames, SortThemIntoGroupsAndARest) {
    SceneData scene = four_lamps();
    const Hash before = identity_of(scene);
    EXPECT_THAT(sort_lamps(scene, {{"key", {"spot*"}}, {"sky", {"environment", "sun"}}}), IsEmpty());
    EXPECT_THAT(scene.groups, ElementsAre("key", "sky", "rest"));
    std::vector<std::uint32_t> groups;
    for (const auto& lamp : lamps_of(scene)) groups.push_back(lamp.group);
    EXPECT_THAT(groups, ElementsAre(2, 0, 0, 1, 1));
    EXPECT_EQ(identity_of(scene), before) << "what was kept of a scene stays good";
}

TEST(LampNames, ThatAreWrongAreToldWithThoseThatThereAre) {
    SceneData scene = four_lamps();
    const auto wrong = sort_lamps(scene, {{"key", {"spto"}}, {"fill", {"panel"}}, {"top", {"ceiling", "moon"}}});
    ASSERT_EQ(wrong.size(), 3u);
    EXPECT_EQ(wrong[0], "lamp 'panel' is in two groups, 'fill' and 'top'");
    EXPECT_EQ(wrong[1], "group 'key': there is no lamp called 'spto' (did you mean 'spot'?)");
    EXPECT_THAT(wrong[2],
                HasSubstr("group 'top': there is no lamp called 'moon' (there is: ceiling, environment, panel"));
}

}  // namespace
}  // namespace lightnet::test::lamp_names_reader_test
