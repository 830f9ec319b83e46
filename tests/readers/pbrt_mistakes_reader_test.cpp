// What is said of broken scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/pbrt_text.hpp"

namespace lightnet::test::pbrt_mistakes_reader_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Mistake {
    std::string statements, message;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.statements; }

class EveryMistake : public testing::TestWithParam<Mistake> {};

TEST_P(EveryMistake, IsNamedWithItsLine) {
    EXPECT_THAT(errors_of_world(GetParam().statements), HasSubstr("scene.pbrt:2: " + GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Syntax, EveryMistake,
    testing::Values(
        Mistake{"Shap \"sphere\"", "unknown statement 'Shap' (did you mean 'Shape'?)"},
        Mistake{"Material \"diffuse\" WorldEnd", "'WorldEnd' belongs to pbrt-v3"},
        Mistake{"Material \"diffuse\" SurfaceIntegrator \"path\"", "'SurfaceIntegrator' belongs to older versions"},
        Mistake{"\"sphere\"", "a statement must begin here, not 'sphere'"},
        Mistake{"Shape", "Shape needs a name in quotes behind it"},
        Mistake{"Texture \"a\" \"spectrum\"", "Texture needs 3 names in quotes behind it"},
        Mistake{"Translate 1 2", "Translate needs 3 numbers, but number 3 is missing"},
        Mistake{"Translate 1 2 x", "Translate needs 3 numbers, but number 3 is 'x'"},
        Mistake{"Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 ]", "Transform takes 16 numbers and then a ']'"},
        Mistake{"Shape \"sphere\" \"radius\" 1",
                "Shape 'sphere': a parameter is written \"type name\", not \"radius\""},
        Mistake{"Shape \"sphere\" \"flaot radius\" 1",
                "Shape 'sphere': parameter 'radius' has the unknown type 'flaot' (did you mean 'float'?)"},
        Mistake{"Shape \"sphere\" \"float radius\" [ 1x ]", "parameter 'radius': a number expected, not '1x'"},
        Mistake{"Shape \"sphere\" \"float radius\" nan", "parameter 'radius': a number expected, not 'nan'"},
        Mistake{"Shape \"sphere\" \"float radius\" 1e99", "parameter 'radius': a number expected, not '1e99'"},
        Mistake{"Shape \"sphere\" \"float radius\" []", "Shape 'sphere': parameter 'radius' has no value"},
        Mistake{"Shape \"sphere\" \"float radius\" [ 1 ", "parameter 'radius': ']' is missing"},
        Mistake{"Shape \"sphere\" \"float radius\" [ 1 2 ]",
                "Shape 'sphere': parameter 'radius' has 2 values, but must have one"},
        Mistake{"Shape \"sphere\" \"integer radius\" 1",
                "Shape 'sphere': parameter 'radius' is of type integer, but must be float"},
        Mistake{"Shape \"trianglemesh\" \"integer indices\" [ 0.5 ]",
                "parameter 'indices': a whole number expected, not '0.5'"},
        Mistake{"Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 ]",
                "Shape 'trianglemesh': parameter 'P' of type point3 has 4 numbers"},
        Mistake{"Material \"conductor\" \"bool remaproughness\" yes",
                "parameter 'remaproughness': true or false expected, not 'yes'"},
        Mistake{"Shape \"plymesh\" \"string filename\" x", "parameter 'filename': a text in quotes expected, not 'x'"},
        Mistake{"Shape \"sphere", "a quote is opened, but not closed on its line"}));

INSTANTIATE_TEST_SUITE_P(
    Blocks, EveryMistake,
    testing::Values(
        Mistake{"Camera \"perspective\"", "Camera must stand before WorldBegin"},
        Mistake{"AttributeBegin", "this block is never closed"},
        Mistake{"AttributeEnd", "there is no AttributeBegin to end here"},
        Mistake{"AttributeBegin TransformEnd AttributeEnd",
                "there is no TransformBegin to end here (the latest open block begins in line 2)"},
        Mistake{"ObjectEnd", "there is no ObjectBegin to end here"},
        Mistake{"ObjectBegin \"a\" ObjectBegin \"b\" ObjectEnd", "ObjectBegin inside of another object"},
        Mistake{"ObjectBegin \"a\" ObjectEnd ObjectBegin \"a\" ObjectEnd", "there is an object 'a' already"},
        Mistake{"ObjectBegin \"tree\" ObjectEnd ObjectInstance \"tre\"",
                "there is no object 'tre' (did you mean 'tree'?)"},
        Mistake{"CoordSysTransform \"wolrd\"", "there is no coordinate system 'wolrd' (did you mean 'world'?)"},
        Mistake{"Attribute \"shpae\" \"float radius\" 1",
                "Attribute is of light, material, medium, shape or texture, not 'shpae' (did you mean 'shape'?)"},
        Mistake{"ActiveTransform Middle", "ActiveTransform is All, StartTime or EndTime, not 'Middle'"},
        Mistake{"ColorSpace \"srbg\"", "unknown color space 'srbg' (did you mean 'srgb'?)"},
        Mistake{"Rotate 90 0 0 0", "Rotate needs an axis that is not 0"},
        Mistake{"LookAt 0 0 0 0 0 0 0 1 0", "LookAt: eye, target and up must span a view"},
        Mistake{"LookAt 0 0 0 0 1 0 0 1 0", "LookAt: eye, target and up must span a view"},
        Mistake{"Include \"none.pbrt\"", "can't read 'none.pbrt': none.pbrt: no such file"}));

INSTANTIATE_TEST_SUITE_P(
    Shapes, EveryMistake,
    testing::Values(Mistake{"Shape \"spere\"", "Shape 'spere': unknown shape (did you mean 'sphere'?)"},
                    Mistake{"Shape \"sphere\" \"float radius\" 0", "Shape 'sphere': the radius must be above 0"},
                    Mistake{"Shape \"trianglemesh\"", "Shape 'trianglemesh': parameter 'P' is missing"},
                    Mistake{"Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]",
                            "Shape 'trianglemesh': parameter 'indices' is missing"},
                    Mistake{"Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]",
                            "Shape 'trianglemesh': index 3 is out of range: there are 3 vertices"},
                    Mistake{"Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 -1 ]",
                            "Shape 'trianglemesh': index -1 is out of range"},
                    Mistake{"Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 ]",
                            "Shape 'trianglemesh': 2 indices are no multiple of 3"},
                    Mistake{"Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"normal N\" [ 0 0 1 ]",
                            "Shape 'trianglemesh': there are 1 'N' for 3 vertices"},
                    Mistake{"Scale 1e30 1 1 Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1e30 0 0 0 1 0 ]",
                            "Shape 'trianglemesh': a vertex is not finite"},
                    Mistake{"Shape \"plymesh\"", "Shape 'plymesh': parameter 'filename' is missing"},
                    Mistake{"Shape \"plymesh\" \"string filename\" \"a.ply\"",
                            "can't read 'a.ply': a.ply: no such file"},
                    Mistake{"Shape \"plymesh\" \"string filename\" \"a.ply.gz\"",
                            "can't read 'a.ply.gz': a.ply.gz: no such file"}));

INSTANTIATE_TEST_SUITE_P(
    Materials, EveryMistake,
    testing::Values(
        Mistake{"Material \"difuse\"", "Material 'difuse': unknown material 'difuse' (did you mean 'diffuse'?)"},
        Mistake{"Material \"diffuse\" Material \"matte\"",
                "Material 'matte': unknown material 'matte' (of older versions; pbrt-v4 says 'diffuse')"},
        Mistake{"Material \"diffuse\" \"rgb reflectance\" [ -1 0 0 ]", "rgb 'reflectance' has a negative component"},
        Mistake{"Material \"diffuse\" \"float reflectance\" .5",
                "parameter 'reflectance' is of type float, but must be rgb, spectrum or texture"},
        Mistake{"Material \"diffuse\" \"texture reflectance\" \"t\"", "there is no spectrum texture 't' above"},
        Mistake{"Material \"diffuse\" \"spectrum reflectance\" [ 400 1 300 2 ]",
                "spectrum 'reflectance' needs wavelengths, ascending"},
        Mistake{"Material \"conductor\" \"spectrum eta\" \"metal-Ag-eat\"",
                "unknown spectrum 'metal-Ag-eat' for parameter 'eta' (did you mean 'metal-Ag-eta'?)"},
        Mistake{"Material \"conductor\" \"spectrum eta\" \"a.spd\"", "can't read 'a.spd'"},
        Mistake{"Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"rgb k\" [ 1 1 1 ]",
                "Material 'conductor': 'reflectance' and 'eta' or 'k' exclude each other"},
        Mistake{"Material \"mix\" \"string materials\" [ \"a\" \"b\" ]",
                "Material 'mix': there is no material 'a' above"},
        Mistake{"MakeNamedMaterial \"gold\"", "MakeNamedMaterial 'gold': parameter 'type' is missing"},
        Mistake{"NamedMaterial \"gold\"", "there is no material 'gold'"},
        Mistake{"MakeNamedMaterial \"gold\" \"string type\" \"diffuse\" NamedMaterial \"gld\"",
                "there is no material 'gld' (did you mean 'gold'?)"},
        Mistake{
            "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"a\" \"string type\" \"diffuse\"",
            "MakeNamedMaterial 'a': a material of that name is there already"},
        Mistake{"Material \"diffuse\" Texture \"t\" \"color\" \"constant\"",
                "Texture 't': a texture is of kind 'float' or 'spectrum', not 'color' (did you mean 'spectrum'?)"},
        Mistake{"Texture \"t\" \"float\" \"imagmap\"",
                "Texture 't': unknown class of texture 'imagmap' (did you mean 'imagemap'?)"},
        Mistake{"Texture \"t\" \"float\" \"imagemap\"", "Texture 't': parameter 'filename' is missing"},
        Mistake{"Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"string encoding\" \"gama 2\"",
                "Texture 't': unknown encoding 'gama 2'"},
        Mistake{"Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"string wrap\" \"repeet\"",
                "Texture 't': unknown wrap 'repeet' (did you mean 'repeat'?)"}));

INSTANTIATE_TEST_SUITE_P(
    Lights, EveryMistake,
    testing::Values(
        Mistake{"LightSource \"pont\"", "LightSource 'pont': unknown light 'pont' (did you mean 'point'?)"},
        Mistake{"LightSource \"spot\" \"float coneangle\" 0", "LightSource 'spot': 'coneangle' must be above 0"},
        Mistake{"LightSource \"spot\" \"float coneangle\" 10 \"float conedeltaangle\" 25",
                "LightSource 'spot': 'coneangle' must be above 0"},
        Mistake{"LightSource \"distant\" \"point3 to\" [ 0 0 0 ]",
                "LightSource 'distant': 'from' and 'to' are the same"},
        Mistake{"LightSource \"infinite\" \"point3 portal\" [ 0 2 0  0 2 1  3 2 1  3 2 0.5 ]",
                "LightSource 'infinite': 'portal' is not four corners of a rectangle, one after the other"},
        Mistake{"LightSource \"infinit\"", "LightSource 'infinit': unknown light 'infinit' (did you mean 'infinite'?)"},
        Mistake{"Material \"diffuse\" AreaLightSource \"area\"", "AreaLightSource 'area': unknown area light 'area'"},
        Mistake{"AreaLightSource \"diffuse\" \"float scale\" -1",
                "AreaLightSource 'diffuse': 'scale' must not be negative"},
        Mistake{"AreaLightSource \"diffuse\" \"blackbody L\" 0",
                "parameter 'L' needs one temperature above 0, in kelvin"},
        Mistake{"AreaLightSource \"diffuse\" \"texture L\" \"t\"",
                "parameter 'L' is of type texture, but must be rgb, spectrum or blackbody"}));

TEST(PbrtMistakes, BeforeTheWorldAreNamedToo) {
    EXPECT_THAT(
        errors_of("Camera \"ortographic\"\nWorldBegin"),
        HasSubstr("scene.pbrt:1: Camera 'ortographic': unknown camera 'ortographic' (did you mean 'orthographic'?)"));
    EXPECT_THAT(errors_of("Camera \"perspective\" \"float lensradius\" -1 \"float focaldistance\" 0\nWorldBegin"),
                AllOf(HasSubstr("'lensradius' must not be negative"), HasSubstr("'focaldistance' must be above 0")));
    EXPECT_THAT(errors_of("Camera \"perspective\" \"float fov\" 180\nWorldBegin"),
                HasSubstr("'fov' must be between 0 and 180"));
    EXPECT_THAT(errors_of("Camera \"perspective\" \"float shutterclose\" 0\nWorldBegin"),
                HasSubstr("the shutter must close after"));
    EXPECT_THAT(errors_of("Camera \"perspective\" \"float screenwindow\" [ 1 0 0 1 ]\nWorldBegin"),
                HasSubstr("'screenwindow' needs four numbers"));
    EXPECT_THAT(errors_of("Film \"rgbb\"\nWorldBegin"), HasSubstr("unknown film 'rgbb' (did you mean 'rgb'?)"));
    EXPECT_THAT(errors_of("Film \"rgb\" \"integer xresolution\" 0\nWorldBegin"), HasSubstr("a film of 0 x 720 pixels"));
    EXPECT_THAT(errors_of("Film \"rgb\" \"float iso\" 0\nWorldBegin"), HasSubstr("'iso' must be above 0"));
    EXPECT_THAT(errors_of(ball), HasSubstr("scene.pbrt:1: Shape must stand behind WorldBegin"));
    EXPECT_THAT(errors_of(""), HasSubstr("scene.pbrt: there is no WorldBegin"));
}

TEST(PbrtMistakes, AreAllNamedAtOnce) {
    EXPECT_EQ(errors_of_world("Material \"diffuse\" Shape \"spere\"\nTranslate 1 2\nMaterial \"matte\"\n" + ball +
                              "Bogus 1 2 [ 3 ]\nAttributeEnd"),
              "scene.pbrt:2: Shape 'spere': unknown shape (did you mean 'sphere'?)\n"
              "scene.pbrt:4: Translate needs 3 numbers, but number 3 is 'Material'\n"
              "scene.pbrt:4: Material 'matte': unknown material 'matte' (of older versions; pbrt-v4 says 'diffuse')\n"
              "scene.pbrt:6: unknown statement 'Bogus'\n"
              "scene.pbrt:7: there is no AttributeBegin to end here");
}

TEST(PbrtMistakes, InOtherFilesBearTheirNames) {
    const MemoryFiles files{{"lib/a.pbrt", "\nShape \"spere\""}};
    EXPECT_THAT(errors_of_world("Include \"lib/a.pbrt\"", files), HasSubstr("lib/a.pbrt:2: Shape 'spere'"));
    const MemoryFiles broken{{"a.ply", "ply\nformat ascii 1.0\n"}};
    EXPECT_THAT(errors_of_world("Shape \"plymesh\" \"string filename\" \"a.ply\"", broken),
                HasSubstr("scene.pbrt:2: Shape 'plymesh': 'a.ply': PLY: the header ends early"));
}

TEST(PbrtMistakes, OfHugeNumbersAreNamed) {
    EXPECT_THAT(errors_of_world("AreaLightSource \"diffuse\" \"rgb L\" [ 1e30 1 1 ] \"float scale\" 1e30"),
                HasSubstr("the light is infinitely bright"));
    EXPECT_THAT(errors_of_world("Scale 1e30 1e30 1e30 Shape \"sphere\" \"float radius\" 1e30"),
                HasSubstr("centre or radius is not finite"));
}

TEST(PbrtMistakes, EndAtAHundred) {
    std::string text;
    for (int i = 0; i < 1000; ++i) text += "Shape \"spere\"\n";
    const std::string errors = errors_of_world(text);
    EXPECT_THAT(errors,
                AllOf(HasSubstr("scene.pbrt:101:"), HasSubstr("too many errors"), Not(HasSubstr("scene.pbrt:102:"))));
}

TEST(PbrtMistakes, InCirclesOfFilesEnd) {
    const MemoryFiles files{{"a.pbrt", "Include \"b.pbrt\""}, {"b.pbrt", "Include \"a.pbrt\""}};
    EXPECT_THAT(errors_of_world("Include \"a.pbrt\"", files), HasSubstr("b.pbrt:1: 'a.pbrt' includes itself"));
    // two in each file: two to the power of 24 without a bound
    MemoryFiles twice;
    for (int i = 0; i < 24; ++i) {
        const std::string next = "Include \"" + std::to_string(i + 1) + ".pbrt\"\n";
        twice.add(std::to_string(i) + ".pbrt", next + next);
    }
    twice.add("24.pbrt", "");
    EXPECT_THAT(errors_of_world("Include \"0.pbrt\"", twice),
                HasSubstr("'20.pbrt': files include each other too deeply or too often"));
}

TEST(PbrtMistakes, InTheMainFileItselfAreNamed) {
    MemoryFiles none;
    EXPECT_THROW(read_scene(none, "scene.pbrt"), UserError);
    EXPECT_THROW(read_scene(none, "scene.obj"), UserError);
}

TEST(PbrtMistakes, OfBlocksAcrossImportsAreNamed) {
    const MemoryFiles files{{"open.pbrt", "AttributeBegin"}, {"close.pbrt", "AttributeEnd"}};
    EXPECT_THAT(errors_of_world("Import \"open.pbrt\"", files),
                HasSubstr("open.pbrt:1: this block is not closed in its file"));
    EXPECT_THAT(errors_of_world("AttributeBegin Import \"close.pbrt\" AttributeEnd", files),
                HasSubstr("close.pbrt:1: there is no AttributeBegin"));
}

TEST(PbrtWarnings, NameParametersWithoutAnEffect) {
    EXPECT_THAT(warnings_of(read_world("Shape \"sphere\" \"float radiu\" 2")),
                HasSubstr("scene.pbrt:2: Shape 'sphere': parameter 'radiu' is unknown here and has no effect (did you "
                          "mean 'radius'?)"));
}

TEST(PbrtWarnings, NameParametersThatAreGivenTwice) {
    const auto scene = read_world("Shape \"sphere\" \"float radius\" 1 \"float radius\" 2");
    EXPECT_EQ(sphere_of(scene).radius, 2);
    EXPECT_EQ(warnings_of(scene),
              "scene.pbrt:2: Shape 'sphere': parameter 'radius' is given twice: the last one holds\n");
}

// Only what stands under it is lost.
TEST(PbrtWarnings, NameWhatStandsUnderASingularTransform) {
    const std::string flat = "ConcatTransform [ 0 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ] ";
    for (const std::string& singular :
         {flat, std::string("Scale 1 0 1 "), std::string("Transform [ 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 ] ")}) {
        const auto scene = read_world("ObjectBegin \"o\" " + triangle + "ObjectEnd AttributeBegin " + singular +
                                      "Texture \"t\" \"spectrum\" \"constant\" AttributeEnd " + triangle);
        EXPECT_THAT(scene.warnings, testing::IsEmpty());
        const auto under = [&](const std::string& statement) { return read_world(singular + statement); };
        EXPECT_THAT(warnings_of(under(triangle)), HasSubstr("stands under a singular transform, and is left out"));
        EXPECT_TRUE(under(ball).shapes.empty());
        EXPECT_TRUE(under("LightSource \"point\"").lights.empty());
        EXPECT_THAT(warnings_of(under("LightSource \"point\"")), HasSubstr("left out"));
        EXPECT_EQ(under("LightSource \"infinite\"").environments.size(), 1u);
        const auto instance =
            read_world("ObjectBegin \"o\" " + triangle + "ObjectEnd " + singular + "ObjectInstance \"o\"");
        EXPECT_TRUE(instance.instances.empty());
        EXPECT_THAT(warnings_of(instance), HasSubstr("an instance stands under a singular transform"));
        EXPECT_THAT(warnings_of(under("Texture \"t\" \"float\" \"fbm\"")), HasSubstr("lies as the world does"));
        EXPECT_THAT(errors_of(singular + "Camera \"perspective\"\nWorldBegin"),
                    HasSubstr("the camera's transform is singular"));
    }
}

TEST(PbrtWarnings, NameShapesWithoutTriangles) {
    const MemoryFiles files{{"a.ply",
                             "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
                             "float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n"}};
    const auto scene = read_world("Shape \"plymesh\" \"string filename\" \"a.ply\"", files);
    EXPECT_TRUE(scene.shapes.empty());
    EXPECT_THAT(warnings_of(scene), HasSubstr("scene.pbrt:2: a shape without any triangle is left out"));
}

TEST(PbrtWarnings, AreCountedWhereTheyRepeat) {
    const auto scene = read_world(
        "MakeNamedMedium \"mist\" \"string type\" \"smoky\"\nMakeNamedMedium \"fog\" \"string type\" "
        "\"smoky\"");
    EXPECT_EQ(warnings_of(scene),
              "scene.pbrt:2: a medium of type 'smoky' is not supported: the space is taken as empty (2 "
              "times)\n");
}

TEST(PbrtWarnings, TellNewNamesOfOldTypes) {
    const auto scene = read_world("Shape \"trianglemesh\" \"point P\" [ 0 0 0 1 0 0 0 1 0 ]");
    EXPECT_EQ(mesh_of(scene).positions.size(), 3u);
    EXPECT_THAT(warnings_of(scene), HasSubstr("scene.pbrt:2: type 'point' is an older spelling, read as 'point3'"));
}

const std::string everything =
    "LookAt 0 0 0 0 0 1 0 1 0 Camera \"perspective\" \"float fov\" [ 40 ]\nFilm \"rgb\" \"integer xresolution\" 8\n"
    "WorldBegin # remark\nAttributeBegin Rotate 5 0 1 0 Texture \"t\" \"float\" \"constant\" \"float value\" 1\n"
    "Material \"conductor\" \"texture roughness\" \"t\" \"bool remaproughness\" false AreaLightSource \"diffuse\" "
    "\"rgb L\" [ 1 1 1 ]\n"
    "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 ] \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] AttributeEnd\n"
    "ObjectBegin \"o\" Shape \"sphere\" ObjectEnd ObjectInstance \"o\" Option \"string s\" \"a\\\"b\"\n";

TEST(PbrtText, IsReadOrRefusedWhereverItIsCut) {
    ASSERT_EQ(errors_of(everything), "");
    for (std::size_t length = 0; length < everything.size(); ++length) errors_of(everything.substr(0, length));
}

TEST(PbrtText, NeverCrashesWithABrokenByte) {
    for (std::size_t i = 0; i < everything.size(); ++i)
        for (const char byte : {'\0', '"', '[', ']', '#', ' ', '9', '-', '\n', '\xff'}) {
            std::string broken = everything;
            broken[i] = byte;
            errors_of(broken);
        }
}

}  // namespace
}  // namespace lightnet::test::pbrt_mistakes_reader_test
