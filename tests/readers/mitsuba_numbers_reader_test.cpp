// What Mitsuba takes as one number of a texture of colours.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/textures/look_up.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_numbers_reader_test {
namespace {

const Material& material_of(const SceneData& scene) { return scene.materials[scene.shapes[0].material]; }

TEST(MitsubaNumbers, OfColoursAreTheirLuminance) {
    const MemoryFiles files{{"c.hdr", "#?RADIANCE\n\n-Y 1 +X 1\n" + std::string("\x80\x40\0\x81", 4)}};  // 1, 1/2, 0
    const auto texture = [](const std::string& name) {
        return "<texture name='" + name + "' type='bitmap'><string name='filename' value='c.hdr'/></texture>";
    };
    const auto number = [&](const std::string& bsdf, const auto& of, const char* version = "3.0.0") {
        const auto scene = read_as(
            "scene.xml",
            std::string("<scene version='") + version + "'><shape type='sphere'>" + bsdf + "</shape></scene>", files);
        return look_up(scene.textures, of(scene), {{0.5f, 0.5f}}).r;
    };
    const auto opacity = [](const SceneData& scene) { return *material_of(scene).opacity; };
    const auto share = [](const SceneData& scene) { return model_of<MixtureMaterial>(scene).amount; };
    const auto metallic = [](const SceneData& scene) { return model_of<BurleyMaterial>(scene).metallic; };
    const auto rough = [](const SceneData& scene) { return *model_of<ConductorMaterial>(scene).roughness.texture; };
    const std::string two = "<bsdf type='diffuse'/><bsdf type='diffuse'/></bsdf>";
    const std::string mask = "<bsdf type='mask'>" + texture("opacity") + "<bsdf type='diffuse'/></bsdf>";
    constexpr float luminance = 0.2126f + 0.7152f / 2;
    EXPECT_NEAR(number(mask, opacity), luminance, 1e-5f);
    EXPECT_NEAR(number("<bsdf type='blendbsdf'>" + texture("weight") + two, share), luminance, 1e-5f);
    EXPECT_NEAR(number("<bsdf type='blendbsdf'><rgb name='weight' value='1, .5, 0'/>" + two, share), luminance, 1e-5f);
    EXPECT_NEAR(number("<bsdf type='principled'>" + texture("metallic") + "</bsdf>", metallic), luminance, 1e-5f);
    EXPECT_NEAR(number("<bsdf type='roughconductor'>" + texture("alpha") + "</bsdf>", rough), luminance, 1e-5f);
    const std::string squares =
        "<bsdf type='mask'><texture name='opacity' type='checkerboard'><rgb name='color0' value='1, .5, 0'/>"
        "<rgb name='color1' value='1, .5, 0'/></texture><bsdf type='diffuse'/></bsdf>";
    EXPECT_NEAR(number(squares, opacity), luminance, 1e-5f);
    EXPECT_NEAR(number(mask, opacity, "0.6.0"), 0.5f, 1e-5f);  // there it is their mean
    const std::string scaled =
        "<bsdf type='mask'><texture name='opacity' type='scale'><float name='scale' value='.5'/>" + texture("value") +
        "</texture><bsdf type='diffuse'/></bsdf>";
    EXPECT_NEAR(number(scaled, opacity), luminance / 2, 1e-5f);
}

TEST(MitsubaNumbers, OfColoursOfMeshesAreTheirLuminance) {
    std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\n";
    for (const char* name : {"x", "y", "z", "color_r", "color_g", "color_b"})
        ply += std::string("property float ") + name + "\n";
    ply += "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (const char* place : {"0 0", "1 0", "0 1"}) ply += std::string(place) + " 0 1 .5 0\n";
    const auto scene = read_mitsuba(
        "<shape type='ply'><string name='filename' value='m.ply'/><bsdf type='mask'>"
        "<texture name='opacity' type='mesh_attribute'><string name='name' value='vertex_color'/></texture>"
        "<bsdf type='diffuse'/></bsdf></shape>",
        {{"m.ply", ply + "3 0 1 2\n"}});
    TexturePlace place{{0, 0}};
    place.vertex_colour = {1, 0.5f, 0};
    const Rgb opacity = look_up(scene.textures, material_of(scene).opacity.value(), place);
    EXPECT_NEAR(opacity.r, 0.2126f + 0.7152f / 2, 1e-5f);
}

TEST(MitsubaColours, ThatNothingCanHaveAreNamed) {
    const auto said = [](const std::string& value) {
        return warnings_of(
            read_mitsuba_bsdf("<bsdf type='diffuse'><rgb name='reflectance' value='" + value + "'/></bsdf>"));
    };
    EXPECT_THAT(said("0, .5, 1"), testing::Not(testing::HasSubstr("reflect")));
    EXPECT_THAT(said("0, .5, 2"), testing::HasSubstr("'reflectance' is above 1"));
    EXPECT_THAT(said("0, .5, -1"), testing::HasSubstr("<rgb> has a negative component: 0 is taken"));
    const auto lamp = read_mitsuba(
        "<shape type='rectangle'><emitter type='area'><rgb name='radiance' value='-1, 1, 2'/></emitter></shape>");
    EXPECT_EQ(lamp.shapes.at(0).emission->radiance, (Rgb{0, 1, 2}));
}

TEST(MitsubaNumbers, MayBeWholeAndBooleansInBigLetters) {
    const auto scene = read_mitsuba(
        "<shape type='sphere'><boolean name='flip_normals' value='TRUE'/><bsdf type='blendbsdf'>"
        "<integer name='weight' value='1'/><bsdf type='diffuse'/><bsdf type='diffuse'/></bsdf></shape>");
    EXPECT_EQ(colour_of(scene, model_of<MixtureMaterial>(scene).amount).r, 1);
}

TEST(MitsubaConductor, HasItsTexturesOfIndicesInsideOfAnother) {
    const MemoryFiles files{{"p.hdr", "#?RADIANCE\n\n-Y 1 +X 1\n" + std::string("\x80\x40\0\x81", 4)}};
    const auto scene = read_mitsuba_bsdf(
        "<bsdf type='conductor'><texture name='eta' type='bitmap'><string name='filename' value='p.hdr'/></texture>"
        "<float name='k' value='3'/><float name='ext_eta' value='1.5'/></bsdf>",
        files);
    const auto& metal = model_of<ConductorMaterial>(scene).metal;
    EXPECT_NEAR(look_up(scene.textures, metal.eta, {{0.5f, 0.5f}}).r, 1 / 1.5f, 1e-5f);
    EXPECT_NEAR(colour_of(scene, metal.k).r, 2, 1e-5f);
}

TEST(MitsubaPolarisation, IsLeftOutAndNamed) {
    const auto opacity = [](const std::string& type, const std::string& more = "") {
        const auto scene = read_mitsuba_bsdf("<bsdf type='" + type + "'>" + more + "</bsdf>");
        EXPECT_THAT(warnings_of(scene), testing::HasSubstr("no light is polarised"));
        return look_up(scene.textures, material_of(scene).opacity.value(), {{0.5f, 0.5f}}).r;
    };
    EXPECT_EQ(opacity("polarizer", "<float name='theta' value='30'/>"), 0.5f);
    EXPECT_EQ(opacity("circular"), 0.5f);
    EXPECT_EQ(opacity("retarder", "<float name='delta' value='90'/>"), 0);
    EXPECT_EQ(opacity("polarizer", "<float name='transmittance' value='.5'/>"), 0.75f);
    const auto plastic = read_mitsuba_bsdf("<bsdf type='pplastic'><float name='alpha' value='.3'/></bsdf>");
    EXPECT_EQ(model_of<CoatedDiffuseMaterial>(plastic).roughness.u, 0.3f);
    EXPECT_THAT(warnings_of(plastic), testing::HasSubstr("its light is not polarised"));
}

}  // namespace
}  // namespace lightnet::test::mitsuba_numbers_reader_test
