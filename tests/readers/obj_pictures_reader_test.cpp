// What OBJ, MTL and PLY say of pictures and of colours of vertices.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "core/scene/textures/look_up.hpp"
#include "tests/support/obj_text.hpp"
#include "tests/support/picture_bytes.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::obj_pictures_reader_test {
namespace {

using namespace obj_text;
using testing::HasSubstr;
using testing::Not;

std::string pixel_of(const std::string& rgbe) { return "#?RADIANCE\n\n-Y 1 +X 1\n" + rgbe; }

TEST(Mtl, ScalesPicturesByTheirGain) {
    const auto colour = [](const std::string& statements) {
        const auto scene = with_material(statements, {{"wood.hdr", dot}});
        EXPECT_THAT(warnings_of(scene), Not(HasSubstr("left out")));
        return look_up(scene.textures, model_of<DiffuseMaterial>(scene).reflectance, {{0.5f, 0.5f}});
    };
    EXPECT_EQ(colour("map_Kd -mm 0 .5 wood.hdr\n"), (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(colour("Kd .5 .25 1\nmap_Kd -mm 0 .5 wood.hdr\n"), (Rgb{0.25f, 0.125f, 0.5f}));
    const auto thin = with_material("Kd 0 0 0\nd .5\nmap_d -mm 0 .5 wood.hdr\n", {{"wood.hdr", dot}});
    EXPECT_EQ(look_up(thin.textures, *material_of(thin).opacity, {{0.5f, 0.5f}}).r, 0.25f);
}

TEST(Mtl, TakesTheLuminanceOfColouredNumbersUnlessAChannelIsNamed) {
    const MemoryFiles files{{"c.hdr", pixel_of(std::string("\x80\x40\0\x81", 4))}};  // 1, 1/2, 0
    const auto opacity = [&](const std::string& map) {
        const auto scene = with_material("map_d " + map + "\n", files);
        EXPECT_THAT(warnings_of(scene), Not(HasSubstr("left out")));
        return look_up(scene.textures, *material_of(scene).opacity, {{0.5f, 0.5f}}).r;
    };
    EXPECT_NEAR(opacity("c.hdr"), 0.2126f + 0.7152f / 2, 1e-5f);
    EXPECT_EQ(opacity("-imfchan r c.hdr"), 1);
    EXPECT_EQ(opacity("-imfchan g c.hdr"), 0.5f);
    EXPECT_EQ(opacity("-imfchan b c.hdr"), 0);
    const auto scene = with_material("map_Pm c.hdr\nbump -imfchan z c.hdr\n", files);
    EXPECT_NEAR(look_up(scene.textures, *model_of<PrincipledMaterial>(scene).metallic_texture, {{0.5f, 0.5f}}).r,
                0.5702f, 1e-5f);
    EXPECT_THAT(warnings_of(scene), HasSubstr("'-imfchan z'"));
}

// A mask in colours, whose alpha says nothing.
TEST(Mtl, TakesTheAlphaOfAMaskOnlyWhereItSaysSomething) {
    const auto opacity = [](std::uint8_t alpha) {
        const std::uint8_t samples[] = {0, 0, 0, alpha, 0, 0, 0, alpha};
        const auto scene = with_material("map_d c.png\n", {{"c.png", png(PNG_FORMAT_RGBA, samples)}});
        return look_up(scene.textures, *material_of(scene).opacity, {{0.5f, 0.5f}}).r;
    };
    EXPECT_EQ(opacity(255), 0);
    EXPECT_NEAR(opacity(51), 0.2f, 1e-6f);
}

TEST(Mtl, NamesColoursThatReflectMoreThanAll) {
    EXPECT_THAT(warnings_of(with_material("Kd 0 128 255\n")), HasSubstr("'Kd' is above 1"));
    EXPECT_THAT(warnings_of(with_material("Kd 0 1 1\n")), Not(HasSubstr("above 1")));
}

TEST(Obj, TakesColoursOfVerticesHoweverTheyAreWritten) {
    const auto with = [](const std::string& colour) {
        return read_as("a.obj", "v 0 0 0 " + colour + "\nv 1 0 0 " + colour + "\nv 1 1 0 " + colour + "\nf 1 2 3\n");
    };
    EXPECT_EQ(mesh_of(with(".25 .5 .75 1")).colours.at(1), (Rgb{0.25f, 0.5f, 0.75f}));
    EXPECT_THAT(warnings_of(with(".25 .5 .75 1")), Not(HasSubstr("left out")));
    EXPECT_THAT(warnings_of(with(".25 .5 .75 .5")), HasSubstr("the alpha of a vertex is left out"));
    EXPECT_THAT(warnings_of(with("1 2")), HasSubstr("behind the position of a vertex is left out"));
    const auto whole = with("0 128 255");
    EXPECT_NEAR(mesh_of(whole).colours.at(1).g, 0.21586f, 1e-5f);
    EXPECT_EQ(mesh_of(whole).colours.at(1).b, 1);
    EXPECT_THAT(warnings_of(whole), HasSubstr("colours of vertices above 1 are taken as parts of 255"));
    EXPECT_THAT(warnings_of(read_as("a.obj", "v 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0\nf 1 2 3\n")),
                HasSubstr("the colour of a vertex behind others that have none is left out"));
}

TEST(Obj, MayNameALibraryInQuotes) {
    const auto scene = read_as("a.obj", "mtllib \"my own.mtl\"\nusemtl a\n" + corners + "f 1 2 3\n",
                               {{"my own.mtl", "newmtl a\nKd 1 0 0\n"}});
    EXPECT_EQ(material_of(scene).name, "a");
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("library")));
}

TEST(Obj, MakesNoFalseAlarmsOfHowThingsAreDrawn) {
    for (const std::string word : {"lod 1", "bevel on", "c_interp off", "d_interp off", "shadow_obj a.obj", "mg 1 .5"})
        EXPECT_THAT(warnings_of(read_as("a.obj", corners + word + "\nf 1 2 3\n")), Not(HasSubstr("left out"))) << word;
}

TEST(PlyScene, WearsThePictureThatItNames) {
    const auto with = [](const std::string& coordinates, const std::string& values) {
        return read_as("a.ply",
                       "ply\nformat ascii 1.0\ncomment TextureFile my dot.hdr\nelement vertex 3\nproperty float x\n"
                       "property float y\nproperty float z\n" +
                           coordinates + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0" +
                           values + "\n1 0 0" + values + "\n0 1 0" + values + "\n3 0 1 2\n",
                       {{"my dot.hdr", dot}});
    };
    const auto scene = with("property float s\nproperty float t\n", " .5 .5");
    EXPECT_EQ(look_up(scene.textures, model_of<DiffuseMaterial>(scene).reflectance, {{0.5f, 0.5f}}), (Rgb{1, 1, 1}));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("left out")));
    EXPECT_THAT(warnings_of(with("", "")), HasSubstr("the texture 'my dot.hdr' is left out"));
}

}  // namespace
}  // namespace lightnet::test::obj_pictures_reader_test
