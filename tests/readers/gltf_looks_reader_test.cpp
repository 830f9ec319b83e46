// glTF's materials that go beyond metal and roughness.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gltf_text.hpp"

namespace lightnet::test::gltf_looks_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string map = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x40\x20\x81", 4);

SceneData with(const std::string& extensions) {
    return read_as("a.glb",
                   triangle_text().file(
                       R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
        "images":[{"uri":"p.hdr"}],"textures":[{"source":0}],"materials":[{"extensions":{)" +
                       extensions + "}}],"),
                   {{"p.hdr", map}});
}
float red_of(const SceneData& scene, std::optional<TextureId> texture) {
    return look_up(scene.textures, texture.value(), {}).r;
}

TEST(GltfAnisotropy, IsReadWithItsTurnAndTexture) {
    const auto scene = with(
        R"("KHR_materials_anisotropy":{"anisotropyStrength":0.6,"anisotropyRotation":0.5,"anisotropyTexture":{"index":0}})");
    const auto& grooves = model_of<PrincipledMaterial>(scene).grooves;
    EXPECT_EQ(grooves.strength, 0.6f);
    EXPECT_FLOAT_EQ(grooves.along.x, std::cos(0.5f));
    EXPECT_FLOAT_EQ(grooves.along.y, std::sin(0.5f));
    EXPECT_FLOAT_EQ(look_up(scene.textures, grooves.texture.value(), {}).b, 0.25f);
}

// PAM, of one pixel: its colours are sRGB, its alpha is not
TEST(GltfGloss, IsReadWithItsTexture) {
    const std::string pixel = std::string("P7\nWIDTH 1\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n") +
                              std::string("\xff\xbc\x00\x33", 4);
    const auto scene =
        read_as("a.glb",
                triangle_text().file(
                    R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
        "images":[{"uri":"p.pam"}],"textures":[{"source":0}],"materials":[{"extensions":{"KHR_materials_pbrSpecularGlossiness":
        {"specularFactor":[0.04,0.04,0.04],"glossinessFactor":0.5,"specularGlossinessTexture":{"index":0}}}}],)"),
                {{"p.pam", pixel}});
    const auto& model = model_of<PrincipledMaterial>(scene);
    EXPECT_FLOAT_EQ(model.roughness.u, 1);
    EXPECT_FLOAT_EQ(red_of(scene, model.roughness.texture), 1 - 0.5f * 0.2f);
    EXPECT_FLOAT_EQ(model.specular_colour.r, 1);
    EXPECT_FLOAT_EQ(red_of(scene, model.specular_colour_texture), 1);
    EXPECT_NEAR(look_up(scene.textures, *model.specular_colour_texture, {}).g, 0.503f, 1e-3f);
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("left out")));
}

TEST(GltfIridescence, IsReadWithItsThickness) {
    const auto scene = with(
        R"("KHR_materials_iridescence":{"iridescenceFactor":0.5,"iridescenceIor":1.8,"iridescenceThicknessMinimum":200,
        "iridescenceThicknessMaximum":600,"iridescenceTexture":{"index":0},"iridescenceThicknessTexture":{"index":0}})");
    const auto& film = model_of<PrincipledMaterial>(scene).film;
    EXPECT_EQ(film.share, 0.5f);
    EXPECT_EQ(film.eta, 1.8f);
    EXPECT_EQ(film.least, 200);
    EXPECT_EQ(film.most, 600);
    EXPECT_FLOAT_EQ(red_of(scene, film.share_texture), 1) << "its red";
    EXPECT_FLOAT_EQ(red_of(scene, film.thickness_texture), 0.5f) << "its green";
    EXPECT_EQ(model_of<PrincipledMaterial>(with(R"("KHR_materials_iridescence":{"iridescenceFactor":1})")).film.most,
              400);
}

TEST(GltfDispersion, SpreadsTheIndexAsAbbesNumberSays) {
    const auto glass = [](const std::string& thickness) {
        return with(R"("KHR_materials_ior":{"ior":1.8},"KHR_materials_transmission":{"transmissionFactor":1},
            "KHR_materials_dispersion":{"dispersion":5},"KHR_materials_volume":{"thicknessFactor":)" +
                    thickness + "}");
    };
    const auto solid = glass("1");
    EXPECT_FLOAT_EQ(model_of<PrincipledMaterial>(solid).dispersion, 0.8f * 0.025f * 5);
    EXPECT_THAT(warnings_of(solid), HasSubstr("KHR_materials_dispersion is approximated by three indices"));
    EXPECT_THAT(warnings_of(glass("0")), Not(HasSubstr("approximated"))) << "panes bend nothing";
}

TEST(GltfDiffuseTransmission, IsReadWithItsColour) {
    const auto scene = with(R"("KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":0.25,
        "diffuseTransmissionColorFactor":[1,0.5,0],"diffuseTransmissionColorTexture":{"index":0},"diffuseTransmissionTexture":{"index":0}})");
    const auto& leaf = model_of<PrincipledMaterial>(scene).translucence;
    EXPECT_EQ(leaf.share, 0.25f);
    EXPECT_EQ(leaf.colour, (Rgb{1, 0.5f, 0}));
    EXPECT_EQ(red_of(scene, leaf.share_texture), 1) << "an image without alpha";
    EXPECT_TRUE(leaf.colour_texture);
    EXPECT_EQ(model_of<PrincipledMaterial>(scene).transparency(), Transparency::sheet);
}

TEST(GltfClearcoat, HasANormalMapOfItsOwn) {
    const auto scene =
        with(R"("KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatNormalTexture":{"index":0,"scale":0.5}})");
    const auto& coat = model_of<PrincipledMaterial>(scene).coat_normal;
    EXPECT_TRUE(coat.own);
    ASSERT_TRUE(coat.map);
    EXPECT_EQ(coat.map->scale, 0.5f);
    EXPECT_FLOAT_EQ(red_of(scene, coat.map->texture), 1);
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("clear coat")));
}

TEST(GltfExtensions, OfMaterialsMayBeRequired) {
    for (const char* name : {"KHR_materials_anisotropy", "KHR_materials_iridescence", "KHR_materials_dispersion",
                             "KHR_materials_diffuse_transmission", "KHR_materials_variants", "KHR_mesh_quantization"})
        EXPECT_EQ(triangle_text().errors(
                      std::string(R"("extensionsRequired":[")") + name + R"("],"extensionsUsed":[")" + name +
                      R"("],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"),
                  "");
}

SceneData seen_by(const std::string& cameras) {
    return read_as(
        "a.glb",
        triangle_text().file(
            R"("nodes":[{"mesh":0},{"camera":0,"translation":[0,0,5]},{"camera":1}],"scenes":[{"nodes":[0,1,2]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"cameras":[)" +
            cameras + "],"));
}

// the triangle lies 5 before the first camera
TEST(GltfCameras, SeeNothingBeforeAndBeyondTheirPlanes) {
    const auto scene = seen_by(R"({"type":"perspective","perspective":{"yfov":1,"znear":6,"zfar":9}},
        {"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0,"zfar":9}})");
    EXPECT_EQ(scene.camera.nearest, 6);
    EXPECT_EQ(scene.cameras.at(0).camera.nearest, 6);
    EXPECT_EQ(scene.cameras.at(1).camera.nearest, 0) << "where nothing is cut, rays begin at the eye";
    EXPECT_GT(scene.camera.farthest, 1e30f);
    const auto near = seen_by(R"({"type":"perspective","perspective":{"yfov":1,"znear":1,"zfar":4}},
        {"type":"perspective","perspective":{"yfov":1,"znear":1}})");
    EXPECT_EQ(near.camera.farthest, 4);
    EXPECT_GT(near.cameras.at(1).camera.farthest, 1e30f) << "without zfar it sees for ever";
}

TEST(GltfSpots, ReachHalfOfAllDirections) {
    const auto spot = [](const std::string& cone) {
        return read_as("a.glb",
                       triangle_text().file(R"("nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}}}],
            "scenes":[{"nodes":[0,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"extensionsUsed":["KHR_lights_punctual"],
            "extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{)" +
                                            cone + "}}]}},"));
    };
    const auto half = spot(R"("innerConeAngle":0.5,"outerConeAngle":1.5707963267948966)");
    EXPECT_FLOAT_EQ(std::get<SpotLight>(half.lights.at(0)).outer, 1.5707963f);
    EXPECT_THAT(half.warnings, IsEmpty());
    const auto wider = spot(R"("outerConeAngle":2)");
    EXPECT_FLOAT_EQ(std::get<SpotLight>(wider.lights.at(0)).outer, 1.5707963f);
    EXPECT_THAT(warnings_of(wider), HasSubstr("a spot of glTF reaches 90 degrees at most, π/2: its light ends there"));
    EXPECT_THAT(warnings_of(spot(R"("innerConeAngle":1,"outerConeAngle":0.5)")), HasSubstr("ends sharply"));
}

}  // namespace
}  // namespace lightnet::test::gltf_looks_reader_test
