// Media in pbrt's files: those that only absorb colour glass, others fill space.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/pbrt_text.hpp"

namespace lightnet::test::pbrt_media_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

SceneData with(const std::string& statements) { return read_world(statements + "\n" + ball); }

TEST(PbrtMedia, ColourTheGlassThatTheyOnlyAbsorbIn) {
    const std::string green =
                          "MakeNamedMedium \"green\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ .5 .2 4 ] "
                          "\"float scale\" 2 \"rgb sigma_s\" [ 0 0 0 ]\n",
                      inside = "MediumInterface \"green\" \"\"\n";
    const auto glass = with(green + inside + "Material \"dielectric\"");
    EXPECT_EQ(glass.materials[glass.shapes[0].material].absorption, (Rgb{1, 0.4f, 8}));
    EXPECT_THAT(glass.warnings, IsEmpty());
    EXPECT_THAT(with(green + inside + "Material \"diffuse\"").warnings, IsEmpty());  // no light comes in
    for (const std::string& elsewhere :
         {green + "MediumInterface \"green\"\nMaterial \"dielectric\"", green + inside + "Material \"thindielectric\"",
          green + inside + "Material \"diffusetransmission\""})
        EXPECT_THAT(warnings_of(with(elsewhere)), HasSubstr("a medium that absorbs is left out"));
    const auto outside = with(green + "AttributeBegin\n" + inside + "AttributeEnd\nMaterial \"dielectric\"");
    EXPECT_EQ(outside.materials[outside.shapes[0].material].absorption, (Rgb{0, 0, 0}));
}

// The outside is where the normal points: towards the middle of a ball that is turned, or mirrored, but not both.
TEST(PbrtMedia, LieOutsideWhereTheNormalPoints) {
    const std::string media =
        "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 2 3 ] \"rgb sigma_s\" [ 0 0 0 ]\n"
        "MakeNamedMedium \"b\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 4 5 6 ] \"rgb sigma_s\" [ 0 0 0 ]\n"
        "Material \"dielectric\" ";
    const auto material = [&](const std::string& statements) {
        const auto scene = read_world(media + statements + ball);
        return scene.materials[scene.shapes.at(0).material];
    };
    const Rgb a{1, 2, 3}, b{4, 5, 6}, nothing{};
    for (const std::string turn : {"", "ReverseOrientation ", "Scale -1 1 1 ", "ReverseOrientation Scale 1 -1 1 "}) {
        const bool turned = sphere_of(read_world(turn + ball)).flip_normals;
        const auto in = material(turn + "MediumInterface \"a\" \"\" ");
        EXPECT_EQ(in.absorption, a);
        EXPECT_EQ(in.absorption_in_front, nothing);
        const auto out = material(turn + "MediumInterface \"\" \"a\" ");
        EXPECT_EQ(out.absorption, nothing);
        EXPECT_EQ(out.absorption_in_front, a);
        // as if the ball that is turned were not, and the medium in it
        EXPECT_FLOAT_EQ(std::get<DielectricMaterial>(out.model).eta, turned ? 1 / 1.5f : 1.5f) << turn;
        const auto both = material(turn + "MediumInterface \"a\" \"b\" ");
        EXPECT_EQ(both.absorption, a);
        EXPECT_EQ(both.absorption_in_front, b);
        EXPECT_FLOAT_EQ(std::get<DielectricMaterial>(both.model).eta, 1.5f);
    }
    EXPECT_THAT(errors_of_world("MediumInterface \"\" \"none\" " + ball), HasSubstr("there is no medium 'none'"));
}

TEST(PbrtMedia, ThatScatterFillSpace) {
    const auto scene = read_text(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 1 1 ] \"rgb sigma_s\" [ 3 1 0 ] "
        "\"float g\" 0.5 \"float scale\" 2 \"rgb Le\" [ 1 2 3 ] \"float Lescale\" 4\n"
        "MediumInterface \"\" \"fog\" Camera \"perspective\"\nWorldBegin\n"
        "MakeNamedMedium \"milk\" \"string type\" \"homogeneous\" \"string preset\" \"Skimmilk\"\n"
        "MediumInterface \"milk\" \"fog\" Material \"dielectric\" " +
        ball + "MediumInterface \"fog\" Material \"interface\" " + ball + "MediumInterface \"fog\" \"\" " + ball);
    ASSERT_EQ(scene.media.size(), 2u);
    const Medium& fog = scene.media[0];
    EXPECT_EQ(fog.extinction.value, (Rgb{8, 4, 2}));
    EXPECT_EQ(fog.albedo_at({}), (Rgb{0.75f, 0.5f, 0}));
    EXPECT_EQ(fog.phase.g, 0.5f);
    EXPECT_EQ(fog.emission.value, (Rgb{8, 16, 24}));
    EXPECT_FLOAT_EQ(scene.media[1].extinction.value.g, 1.2225f);
    EXPECT_EQ(scene.around, 0);
    ASSERT_EQ(scene.shapes.size(), 2u) << "what parts no media is left out";
    EXPECT_EQ(scene.shapes[0].media->inside, 1);
    EXPECT_EQ(scene.shapes[0].media->outside, 0);
    EXPECT_EQ(scene.materials[scene.shapes[0].material].absorption, (Rgb{0, 0, 0}));
    EXPECT_EQ(scene.shapes[1].media->outside, Query::no_medium);
    EXPECT_THAT(warnings_of(scene), HasSubstr("only bounds media, and is left out"));
}

// Of Jensen et al. 2001 and of Narasimhan et al. 2006: reduced scattering and absorption.
TEST(PbrtMedia, GoByTheNamesOfSubstances) {
    struct Known {
        const char* name;
        Rgb scattered, absorbed;
    };
    for (const auto& [name, scattered, absorbed] :
         {Known{"Ketchup", {0.18f, 0.07f, 0.03f}, {0.061f, 0.97f, 1.45f}},
          Known{"Lowfat Milk", {0.89187f, 1.5136f, 2.532f}, {0.002875f, 0.00575f, 0.0115f}},
          Known{"Head & Shoulders Shampoo", {0.023805f, 0.028804f, 0.034306f}, {0.084621f, 0.15688f, 0.20365f}},
          Known{
              "Pacific Ocean Surface Water", {1.764e-4f, 3.2095e-4f, 1.9617e-4f}, {0.031845f, 0.031324f, 0.030147f}}}) {
        const auto scene = read_text(
            std::string(
                "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float scale\" 10 \"string preset\" \"") +
            name + "\"\nMediumInterface \"\" \"m\" Camera \"perspective\"\nWorldBegin\n" + ball);
        ASSERT_EQ(scene.media.size(), 1u) << name;
        EXPECT_EQ(scene.media[0].albedo.value, scattered * 10) << name;
        EXPECT_EQ(scene.media[0].extinction.value, absorbed * 10 + scattered * 10) << name;
        EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
    }
    EXPECT_THAT(warnings_of(read_world("MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"string preset\" "
                                       "\"Lowfat Mlik\"")),
                HasSubstr("did you mean 'Lowfat Milk'?"));
}

// What only absorbs is in space where no glass holds it.
TEST(PbrtMedia, ThatOnlyAbsorbFillSpaceWhereNoGlassHoldsThem) {
    const auto scene = with(
        "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 2 3 ] \"rgb sigma_s\" [ 0 0 0 ]\n"
        "MediumInterface \"ink\" \"\" Material \"interface\"");
    ASSERT_EQ(scene.media.size(), 1u);
    EXPECT_EQ(scene.media[0].extinction.value, (Rgb{1, 2, 3}));
    EXPECT_EQ(scene.shapes.at(0).media->inside, 0);
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtMedia, MayBeGrids) {
    const auto scene = with(
        "Translate 1 0 0 Scale 2 2 2\n"
        "MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 1 \"integer nz\" 1 "
        "\"float density\" [ 1 3 ] \"rgb sigma_a\" [ 1 1 1 ] \"rgb sigma_s\" [ 3 1 0 ] \"point3 p0\" [ -1 0 0 ]\n"
        "MakeNamedMedium \"sky\" \"string type\" \"cloud\"\n"
        "MakeNamedMedium \"dye\" \"string type\" \"rgbgrid\" \"integer nx\" 1 \"integer ny\" 1 \"integer nz\" 2 "
        "\"rgb sigma_a\" [ 1 2 3 4 5 6 ] \"rgb sigma_s\" [ 1 2 3 4 5 6 ] \"float scale\" 2\n"
        "MediumInterface \"smoke\" \"\" Material \"interface\"");
    ASSERT_EQ(scene.media.size(), 3u);
    const Medium& smoke = scene.media[0];
    // the box is 4 m long, from x = -1 to 3; its points lie at 0 and at 2
    EXPECT_EQ(smoke.extinction.at({0, 1, 1}), (Rgb{4, 2, 1}));
    EXPECT_EQ(smoke.extinction.at({1, 1, 1}), (Rgb{8, 4, 2}));
    EXPECT_EQ(smoke.extinction.at({-1, 1, 1}), (Rgb{2, 1, 0.5f})) << "it fades towards its rim";
    EXPECT_EQ(smoke.albedo_at({0.5f, 1, 1}), (Rgb{0.75f, 0.5f, 0}));
    float densest = 0;
    for (const float density : scene.media[1].extinction.grid->values) densest = std::max(densest, density);
    EXPECT_GT(densest, 0.9f);
    EXPECT_LE(densest, 1.0f);
    EXPECT_EQ(scene.media[2].extinction.grid->at({0.5f, 0.5f, 0.25f}) * scene.media[2].extinction.value.r,
              (Rgb{4, 8, 12}));
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
    EXPECT_THAT(errors_of_world("MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"float "
                                "density\" [ 1 3 4 ]"),
                HasSubstr("'density' has 3 numbers where nx, ny and nz ask for 2"));
}

TEST(PbrtSubsurface, FillsItsShapesWithAMedium) {
    const auto scene = with(
        "Material \"subsurface\" \"rgb reflectance\" [ .2 .5 .9 ] \"rgb mfp\" [ .5 1 2 ] \"float g\" .1 \"float eta\" "
        "1.4");
    const Medium& medium = scene.media.at(0);
    EXPECT_EQ(medium.extinction.value, (Rgb{2, 1, 0.5f}));
    const Rgb albedo = medium.albedo_at({});
    EXPECT_NEAR(albedo.r, 0.6128f, 1e-3f);
    EXPECT_NEAR(albedo.g, 0.9123f, 1e-3f);
    EXPECT_NEAR(albedo.b, 0.9963f, 1e-3f);
    EXPECT_EQ(scene.shapes.at(0).media->inside, 0);
    EXPECT_EQ(model_of<DielectricMaterial>(scene).eta, 1.4f);
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
    const auto skin = with("Material \"subsurface\" \"string name\" \"Skin1\" \"float scale\" 100");
    EXPECT_NEAR(skin.media.at(0).extinction.value.r, 77.2f, 1e-3f);
    EXPECT_NEAR(skin.media.at(0).albedo_at({}).b, 1.01f / 1.49f, 1e-5f);
}

}  // namespace
}  // namespace lightnet::test::pbrt_media_reader_test
