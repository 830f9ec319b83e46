// Media in pbrt's files: those that only absorb colour glass, others are left out.
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

TEST(PbrtMedia, ThatScatterAreLeftOut) {
    const auto scene = with(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 1 1 ]\n"
        "MediumInterface \"fog\" \"\"\nMaterial \"dielectric\"");
    EXPECT_EQ(scene.materials[scene.shapes[0].material].absorption, (Rgb{0, 0, 0}));
    EXPECT_THAT(warnings_of(scene), HasSubstr("scene.pbrt:2: participating media are not supported"));
}

}  // namespace
}  // namespace lightnet::test::pbrt_media_reader_test
