// pbrt's materials and textures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/readers/common/spectra.hpp"
#include "core/scene/textures/look_up.hpp"
#include "core/scene/textures/noise.hpp"
#include "tests/support/pbrt_text.hpp"

namespace lightnet::test::pbrt_materials_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Two by two pixels, upper row 1 and 0.5, lower row 0.25 and 0.
MemoryFiles pictures() {
    return MemoryFiles{{"p.hdr", std::string("#?RADIANCE\n\n-Y 2 +X 2\n") +
                                     std::string("\x80\x80\x80\x81\x80\x80\x80\x80\x80\x80\x80\x7f\0\0\0\0", 16)}};
}

SceneData with(const std::string& material, MemoryFiles files = {}) {
    return read_world(material + "\n" + ball, std::move(files));
}

Texture reflectance(const std::string& textures, const std::string& type = "texture reflectance",
                    const std::string& value = "\"t\"") {
    const auto scene = with(textures + " Material \"diffuse\" \"" + type + "\" " + value, pictures());
    return scene.textures.at(model_of<DiffuseMaterial>(scene).reflectance);
}

/// The value of a diffuse reflectance, wherever it comes from.
Rgb value_at(const std::string& textures, Vec2 uv) {
    const auto scene = with(textures + " Material \"diffuse\" \"texture reflectance\" \"t\"", pictures());
    return look_up(scene.textures, model_of<DiffuseMaterial>(scene).reflectance, {uv});
}

TEST(PbrtMaterials, MayBeDiffuse) {
    const auto scene = with("Material \"diffuse\" \"rgb reflectance\" [ .1 .2 .3 ]");
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtMaterials, MayBeConductors) {
    const auto silver = with(
        "Material \"conductor\" \"float roughness\" 0.0025 \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" "
        "\"metal-Ag-k\"");
    const auto& model = model_of<ConductorMaterial>(silver);
    EXPECT_EQ(model.roughness.u, 0.0025f);
    EXPECT_EQ(model.roughness.v, 0.0025f);
    EXPECT_EQ(model.roughness.means, Roughness::Means::root);
    EXPECT_NEAR(colour_of(silver, model.metal.k).g, 3.122485f, 1e-6f);
    EXPECT_FALSE(model.metal.reflectance);
    EXPECT_THAT(silver.warnings, IsEmpty());
}

TEST(PbrtMaterials, MayHaveTwoRoughnessesAsTheyAre) {
    const auto scene =
        with("Material \"conductor\" \"float uroughness\" .1 \"float vroughness\" .2 \"bool remaproughness\" false");
    EXPECT_EQ(model_of<ConductorMaterial>(scene).roughness.u, 0.1f);
    EXPECT_EQ(model_of<ConductorMaterial>(scene).roughness.v, 0.2f);
    EXPECT_EQ(model_of<ConductorMaterial>(scene).roughness.means, Roughness::Means::alpha);
    EXPECT_NEAR(colour_of(scene, model_of<ConductorMaterial>(scene).metal.eta).r, 0.200438f, 1e-6f);  // copper
}

TEST(PbrtMaterials, MayBeConductorsOfAColour) {
    const auto scene = with("Material \"conductor\" \"rgb reflectance\" [ .9 .8 .7 ]");
    EXPECT_EQ(colour_of(scene, model_of<ConductorMaterial>(scene).metal.reflectance.value()), (Rgb{0.9f, 0.8f, 0.7f}));
}

TEST(PbrtMaterials, MayHaveSpectraInFiles) {
    MemoryFiles files{{"spds/x.spd", "300 2\n800 2\n"}};
    const auto scene =
        with("Material \"conductor\" \"spectrum eta\" \"spds/x.spd\" \"spectrum k\" [ 300 3 800 3 ]", files);
    EXPECT_NEAR(colour_of(scene, model_of<ConductorMaterial>(scene).metal.eta).b, 2, 1e-5f);
    EXPECT_NEAR(colour_of(scene, model_of<ConductorMaterial>(scene).metal.k).r, 3, 1e-5f);
}

TEST(PbrtMaterials, MayBeGlass) {
    const auto pane = with("Material \"thindielectric\" \"float eta\" 1.2");
    EXPECT_EQ(model_of<DielectricMaterial>(with("Material \"dielectric\"")).eta, 1.5f);
    EXPECT_EQ(model_of<DielectricMaterial>(with("Material \"dielectric\" \"float eta\" 1.33")).eta, 1.33f);
    EXPECT_EQ(model_of<DielectricMaterial>(pane).eta, 1.2f);
    EXPECT_TRUE(model_of<DielectricMaterial>(pane).thin);
    const auto named = with("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"");
    const auto solid = model_of<PrincipledMaterial>(named);
    EXPECT_EQ(solid.transmission, 1);
    EXPECT_FALSE(solid.thin);
    EXPECT_NEAR(solid.eta, 1.5185f, 2e-3f) << "in the middle";
    EXPECT_NEAR(solid.dispersion, 0.005f, 0.002f) << "half of what its index for blue is above that for red";
    EXPECT_THAT(warnings_of(named), HasSubstr("dispersion is approximated by three indices"));
    const auto plate = with("Material \"thindielectric\" \"spectrum eta\" \"glass-BK7\"");
    EXPECT_NEAR(model_of<DielectricMaterial>(plate).eta, 1.5185f, 1e-4f);
    EXPECT_THAT(warnings_of(plate), HasSubstr("dispersion is left out"));
}

TEST(PbrtMaterials, MayBeCoated) {
    const auto scene = with("Material \"coateddiffuse\" \"rgb reflectance\" [ .07 .09 .13 ] \"float roughness\" .01");
    EXPECT_EQ(model_of<CoatedDiffuseMaterial>(scene).roughness.u, 0.01f);
    EXPECT_EQ(model_of<CoatedDiffuseMaterial>(scene).eta, 1.5f);
    EXPECT_EQ(model_of<CoatedDiffuseMaterial>(scene).layer.thickness, 0.01f);
    EXPECT_EQ(model_of<CoatedDiffuseMaterial>(scene).layer.bounces, 5u);
    EXPECT_THAT(scene.warnings, IsEmpty());
    const auto thick = with("Material \"coateddiffuse\" \"float thickness\" .5 \"integer maxdepth\" 7");
    EXPECT_EQ(model_of<CoatedDiffuseMaterial>(thick).layer.thickness, 0.5f);
    EXPECT_EQ(model_of<CoatedDiffuseMaterial>(thick).layer.bounces, 4u);
}

TEST(PbrtMaterials, MayBeCoatedMetals) {
    const auto scene = with(
        "Material \"coatedconductor\" \"float interface.roughness\" .01 \"float conductor.roughness\" .04\n"
        "\"spectrum conductor.eta\" \"metal-Ag-eta\" \"spectrum conductor.k\" \"metal-Ag-k\" \"float interface.eta\" "
        "1.3");
    const auto& model = model_of<CoatedConductorMaterial>(scene);
    EXPECT_EQ(model.coat.u, 0.01f);
    EXPECT_EQ(model.roughness.v, 0.04f);
    EXPECT_EQ(model.coat_eta, 1.3f);
    EXPECT_EQ(colour_of(scene, model.metal.k), named_index("metal-Ag-k")->rgb);
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtMaterials, MayLetLightThroughEvenly) {
    const auto scene = with("Material \"diffusetransmission\" \"rgb transmittance\" [ .2 .4 .6 ] \"float scale\" .5");
    const auto& model = model_of<DiffuseMaterial>(scene);
    EXPECT_EQ(colour_of(scene, model.reflectance), (Rgb{0.125f, 0.125f, 0.125f}));
    EXPECT_EQ(colour_of(scene, model.transmittance.value()), (Rgb{0.1f, 0.2f, 0.3f}));
}

TEST(PbrtMaterials, Mix) {
    const auto scene = with(
        "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
        "MakeNamedMaterial \"b\" \"string type\" \"dielectric\"\n"
        "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" .25");
    const auto& mixture = model_of<MixtureMaterial>(scene);
    EXPECT_EQ(scene.materials[mixture.first].name, "a");
    EXPECT_EQ(scene.materials[mixture.second].name, "b");
    EXPECT_EQ(colour_of(scene, mixture.amount).r, 0.25f);
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtMaterials, MixOnlyWhatStandsAbove) {
    EXPECT_THAT(errors_of_world("Material \"mix\" \"string materials\" [ \"a\" \"a\" ] " + ball),
                HasSubstr("there is no material 'a' above"));
}

TEST(PbrtMaterials, MayHaveBumpsAndNormalMaps) {
    const auto scene = with(
        "Texture \"b\" \"float\" \"imagemap\" \"string filename\" \"p.hdr\"\n"
        "Material \"diffuse\" \"texture displacement\" \"b\" \"string normalmap\" \"p.hdr\"",
        pictures());
    const Material& material = scene.materials[scene.shapes[0].material];
    EXPECT_TRUE(material.bump_map);
    ASSERT_TRUE(material.normal_map);
    EXPECT_EQ(material.normal_map->green, NormalMap::Green::across);
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtMaterials, AreCutOutByTheAlphaOfAShape) {
    const auto scene = read_world("Shape \"sphere\" \"float alpha\" .25 Shape \"sphere\" \"float alpha\" 1");
    EXPECT_EQ(colour_of(scene, scene.materials[scene.shapes[0].material].opacity.value()).r, 0.25f);
    EXPECT_FALSE(scene.materials[scene.shapes[1].material].opacity);
}

TEST(PbrtMaterials, OfNothingLeaveShapesOut) {
    const auto scene = with("Material \"interface\"");
    EXPECT_THAT(scene.shapes, IsEmpty());
    EXPECT_THAT(warnings_of(scene), HasSubstr("only bounds media"));
}

TEST(PbrtMaterials, MayBeNamedBeforeTheyAreMade) {
    const auto scene =
        read_world("NamedMaterial \"glass\" " + ball + "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"");
    EXPECT_EQ(model_of<DielectricMaterial>(scene).eta, 1.5f);
    EXPECT_EQ(scene.materials[scene.shapes[0].material].name, "glass");
}

TEST(PbrtTextures, MayBeConstant) {
    EXPECT_EQ(reflectance("Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [ .1 .2 .3 ]").scale,
              (Rgb{0.1f, 0.2f, 0.3f}));
}

TEST(PbrtTextures, MayBePictures) {
    const Texture t = reflectance(
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"p.hdr\" \"string wrap\" \"clamp\" \"float "
        "uscale\" 2\n"
        "\"float vdelta\" .5 \"bool invert\" true \"string filter\" \"trilinear\"");
    const auto& picture = std::get<ImageTexture>(t.pattern);
    ASSERT_TRUE(picture.image);
    EXPECT_EQ(picture.image->width, 2u);
    EXPECT_EQ(picture.image->colour(0, 0), (Rgb{1, 1, 1}));
    EXPECT_EQ(picture.image->colour(0, 1), (Rgb{0.25f, 0.25f, 0.25f}));
    EXPECT_EQ(picture.wrap_u, Wrap::clamp);
    EXPECT_EQ(picture.wrap_v, Wrap::clamp);
    EXPECT_TRUE(t.invert);
    EXPECT_EQ(picture.uv.scale, (Vec2{2, 1}));
    EXPECT_EQ(picture.uv.offset, (Vec2{0, 0.5f}));
}

TEST(PbrtTextures, ShareThePictureOfAFile) {
    const auto scene = with(
        "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"p.hdr\"\n"
        "Texture \"b\" \"spectrum\" \"imagemap\" \"string filename\" \"./p.hdr\" \"float scale\" .5\n"
        "Material \"diffuse\" \"texture reflectance\" \"a\"\n" +
            ball + "Material \"diffuse\" \"texture reflectance\" \"b\"",
        pictures());
    const auto& a = scene.textures.at(model_of<DiffuseMaterial>(scene, 0).reflectance);
    const auto& b = scene.textures.at(model_of<DiffuseMaterial>(scene, 1).reflectance);
    EXPECT_EQ(std::get<ImageTexture>(a.pattern).image, std::get<ImageTexture>(b.pattern).image);
    EXPECT_EQ(b.scale, (Rgb{0.5f, 0.5f, 0.5f}));
}

const std::string picture = "Texture \"p\" \"spectrum\" \"imagemap\" \"string filename\" \"p.hdr\" ";

TEST(PbrtTextures, LieWithTheirLowerEdgeAtZero) {
    const std::string t = picture + "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"p\"";
    EXPECT_NEAR(value_at(t, {0.25f, 0.75f}).r, 1, 1e-6f);      // upper left
    EXPECT_NEAR(value_at(t, {0.25f, 0.25f}).r, 0.25f, 1e-6f);  // lower left
    EXPECT_NEAR(value_at(t, {0.5f, 0.75f}).r, 0.75f, 1e-6f);   // between two pixels
    EXPECT_NEAR(value_at(t, {1.25f, -0.25f}).r, 1, 1e-6f);     // repeated
}

TEST(PbrtTextures, MayBeScaled) {
    EXPECT_EQ(
        reflectance(picture + "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"p\" \"float scale\" .5").scale.r,
        0.5f);
    const std::string product = picture +
                                "Texture \"f\" \"float\" \"imagemap\" \"string filename\" \"p.hdr\"\n"
                                "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"p\" \"texture scale\" \"f\"";
    EXPECT_NEAR(value_at(product, {0.75f, 0.75f}).g, 0.25f, 1e-6f);
}

TEST(PbrtTextures, MayBeMixed) {
    const std::string t =
        picture +
        "Texture \"t\" \"spectrum\" \"mix\" \"texture tex1\" \"p\" \"rgb tex2\" [ 1 0 0 ] \"float amount\" .25";
    EXPECT_NEAR(value_at(t, {0.75f, 0.25f}).r, 0.25f, 1e-6f);
    EXPECT_NEAR(value_at(t, {0.25f, 0.75f}).g, 0.75f, 1e-6f);
}

TEST(PbrtTextures, MayBeCheckerboards) {
    const std::string t =
        "Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 2 \"rgb tex1\" [ 1 0 0 ] "
        "\"rgb tex2\" [ 0 1 0 ]";
    EXPECT_EQ(value_at(t, {0.125f, 0.25f}), (Rgb{1, 0, 0}));
    EXPECT_EQ(value_at(t, {0.375f, 0.25f}), (Rgb{0, 1, 0}));
    EXPECT_EQ(value_at(t, {0.375f, 0.75f}), (Rgb{1, 0, 0}));
    EXPECT_EQ(value_at(t, {0.125f, 1.75f}), (Rgb{0, 1, 0}));
}

TEST(PbrtTextures, MayRunBetweenFourCorners) {
    const std::string t =
        "Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [ 0 0 0 ] \"rgb v10\" [ 1 0 0 ] \"rgb v01\" [ 0 1 0 ] "
        "\"rgb v11\" [ 0 0 1 ]";
    EXPECT_EQ(value_at(t, {0, 0}), (Rgb{0, 0, 0}));
    EXPECT_EQ(value_at(t, {1, 0}), (Rgb{1, 0, 0}));
    EXPECT_EQ(value_at(t, {0, 1}), (Rgb{0, 1, 0}));
    EXPECT_NEAR(value_at(t, {0.5f, 0.25f}).r, 0.375f, 1e-6f);
    EXPECT_NEAR(value_at(t, {0.5f, 0.25f}).b, 0.125f, 1e-6f);
}

TEST(PbrtTextures, VaryRoughness) {
    const auto scene = with(
        "Texture \"f\" \"float\" \"imagemap\" \"string filename\" \"p.hdr\" \"float scale\" .5\n"
        "Material \"conductor\" \"texture roughness\" \"f\" \"bool remaproughness\" false",
        pictures());
    const Roughness& rough = model_of<ConductorMaterial>(scene).roughness;
    EXPECT_EQ(rough.u, 1);
    EXPECT_EQ(rough.means, Roughness::Means::alpha);
    EXPECT_NEAR(look_up(scene.textures, rough.texture.value(), {{0.25f, 0.75f}}).r, 0.5f, 1e-6f);
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtTextures, OfUnsupportedClassesAreTheirMean) {
    const auto scene = with(
        "Texture \"t\" \"spectrum\" \"ptex\" \"string filename\" \"t.ptx\"\n"
        "Texture \"u\" \"spectrum\" \"ptex\" \"string filename\" \"u.ptx\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\"");
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_THAT(warnings_of(scene), HasSubstr("textures of class 'ptex' are not supported"));
    EXPECT_THAT(warnings_of(scene), HasSubstr("(2 times)"));
}

// Where the statement stands, the world is moved and turned: what is at `position` there is seen at a texture's own.
Rgb solid_value(const std::string& texture, Vec3 position, Vec3 normal = {0, 0, 1}) {
    const auto scene = with("AttributeBegin Translate 10 0 0 Scale 2 2 2\n" + texture +
                                "\nAttributeEnd Material \"diffuse\" \"texture reflectance\" \"t\"",
                            pictures());
    EXPECT_THAT(scene.warnings, IsEmpty());
    return look_up(scene.textures, model_of<DiffuseMaterial>(scene).reflectance, {{}, {1, 1, 1}, position, normal});
}

TEST(PbrtTextures, LieWhereTheirStatementStands) {
    const std::string red_green = " \"rgb tex1\" [ 1 0 0 ] \"rgb tex2\" [ 0 1 0 ] ";
    const std::string squares = "Texture \"t\" \"spectrum\" \"checkerboard\"" + red_green;
    const Rgb red{1, 0, 0}, green{0, 1, 0};
    const std::string cubes = squares + "\"integer dimension\" 3";
    EXPECT_EQ(solid_value(cubes, {11, 1, 1}), red);
    EXPECT_EQ(solid_value(cubes, {13, 1, 1}), green);
    const std::string plane =
        squares + "\"string mapping\" \"planar\" \"vector3 v1\" [ 0 0 4 ] \"vector3 v2\" [ 1 0 0 ] \"float vdelta\" 1";
    EXPECT_EQ(solid_value(plane, {10.2f, 9, 0.1f}), green);
    EXPECT_EQ(solid_value(plane, {10.2f, 9, 0.6f}), red);
    EXPECT_EQ(solid_value(plane, {13, 9, 0.6f}), green);
    const std::string cylinder = squares + "\"string mapping\" \"cylindrical\"";
    EXPECT_EQ(solid_value(cylinder, {11, 1, 1}), red);
    EXPECT_EQ(solid_value(cylinder, {11, 1, 3}), green);
    const std::string image = "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"p.hdr\"";
    const std::string sphere = image + " \"string mapping\" \"spherical\"";
    EXPECT_NEAR(solid_value(sphere, {10 + std::sqrt(2.0f), -std::sqrt(2.0f), 2}).r, value_at(image, {0.25f, 0.875f}).r,
                1e-5f);
}

TEST(PbrtTextures, MixByDirectionTakeTheirDirectionAlong) {
    const std::string t =
        "Rotate 90 0 0 1 Texture \"t\" \"spectrum\" \"directionmix\" \"rgb tex1\" [ 1 0 0 ] \"rgb tex2\" [ 0 1 0 ]";
    EXPECT_NEAR(solid_value(t, {}, {1, 0, 0}).r, 1, 1e-6f);
    EXPECT_NEAR(solid_value(t, {}, {0, 1, 0}).g, 1, 1e-6f);
}

TEST(PbrtTextures, MayBeNoise) {
    const Vec3 own{0.3f, 0.6f, -0.2f}, there{10.6f, 1.2f, -0.4f};
    const auto grey = [&](const std::string& type) {
        return solid_value("Texture \"t\" \"spectrum\" \"" + type, there).r;
    };
    EXPECT_NEAR(grey("fbm\" \"integer octaves\" 3 \"float roughness\" .4"), std::max(0.0f, fractal_noise(own, 3, 0.4f)),
                1e-5f);
    EXPECT_NEAR(grey("wrinkled\""), turbulence(own, 8, 0.5f), 1e-5f);
    EXPECT_NEAR(grey("windy\""), std::max(0.0f, wind_waves(own)), 1e-5f);
    EXPECT_NEAR(grey("marble\" \"float scale\" 3 \"float variation\" 2"), marble(own * 3, 8, 0.5f, 2).r, 1e-5f);
}

TEST(PbrtTextures, HaveDotsOfWhatIsOutside) {
    int red = 0;
    for (int i = 0; i < 400; ++i) {
        const std::string t = "Texture \"t\" \"spectrum\" \"dots\" \"rgb inside\" [ 0 1 0 ] \"rgb outside\" [ 1 0 0 ]";
        const Rgb found = value_at(t, {0.73f * float(i), 0.41f * float(i)});
        red += found == Rgb{1, 0, 0};
    }
    EXPECT_GT(red, 20);
    EXPECT_LT(red, 120);
}

TEST(PbrtTextures, OfNoiseNameWrongOctaves) {
    EXPECT_THAT(errors_of_world("Texture \"t\" \"float\" \"fbm\" \"integer octaves\" 99"),
                HasSubstr("'octaves' is 99, not 0 to 32"));
}

TEST(PbrtTextures, OfAnotherKindAreNamed) {
    EXPECT_THAT(
        errors_of_world("Texture \"t\" \"float\" \"constant\" Material \"diffuse\" \"texture reflectance\" \"t\""),
        HasSubstr("there is no spectrum texture 't' above (that one is of kind 'float')"));
}

}  // namespace
}  // namespace lightnet::test::pbrt_materials_reader_test
