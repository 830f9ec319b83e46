// What pbrt's statements do: transforms, blocks, files, camera, film.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/pbrt_text.hpp"

namespace lightnet::test::pbrt_language_reader_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

void expect_near(Vec3 a, Vec3 b) {
    EXPECT_NEAR(a.x, b.x, 1e-5f);
    EXPECT_NEAR(a.y, b.y, 1e-5f);
    EXPECT_NEAR(a.z, b.z, 1e-5f);
}

Vec3 first_vertex(const std::string& statements) { return mesh_of(read_world(statements)).positions[1]; }

TEST(PbrtText, HasBlanksWhereverTheyFit) {
    for (const std::string radius :
         {"\" float radius\" 2", "\"float  radius \"[2]", "\"\tfloat\tradius\"\n[ 2\n]", "\"  float radius  \" [\t2 ]"})
        EXPECT_EQ(sphere_of(read_world("Shape \"sphere\" " + radius)).radius, 2) << radius;
    EXPECT_TRUE(read_world("AreaLightSource \"diffuse\" \" bool  twosided \" [ true ] " + ball)
                    .shapes.at(0)
                    .emission->two_sided);
}

TEST(PbrtFiles, MayBeNamedWithBackslashes) {
    const std::string mesh =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
        "1\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const MemoryFiles files{{"parts/new/t.ply", mesh},
                            {"parts/all.pbrt", "Shape \"plymesh\" \"string filename\" \"parts\\new\\t.ply\""},
                            {"parts/b.spd", "400 1 700 1"}};
    for (const std::string statement :
         {"Shape \"plymesh\" \"string filename\" \"parts\\new\\t.ply\"",
          "Shape \"plymesh\" \"string filename\" \".\\\\parts\\\\new\\\\t.ply\"", "Include \"parts\\all.pbrt\"",
          "Import \"parts\\\\all.pbrt\"",
          "Material \"diffuse\" \"spectrum reflectance\" \"parts\\b.spd\" Include \"parts\\all.pbrt\""}) {
        const auto scene = read_world(statement, files);
        ASSERT_EQ(scene.shapes.size(), 1u) << statement;
        EXPECT_EQ(mesh_of(scene).positions.size(), 3u);
    }
}

TEST(PbrtTransforms, ApplyTheLatestFirst) {
    expect_near(first_vertex("Translate 5 0 0 Scale 2 2 2 " + triangle), {7, 0, 0});
    expect_near(first_vertex("Scale 2 2 2 Translate 5 0 0 " + triangle), {12, 0, 0});
}

TEST(PbrtTransforms, RotateByDegreesAroundAnAxis) {
    expect_near(first_vertex("Rotate 90 0 0 1 " + triangle), {0, 1, 0});
    expect_near(first_vertex("Rotate 90 0 3 0 " + triangle), {0, 0, -1});
}

TEST(PbrtTransforms, TakeMatricesColumnByColumn) {
    expect_near(first_vertex("Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1 ] " + triangle), {6, 6, 7});
    expect_near(first_vertex("Scale 2 2 2 ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 5 0 0 1 ] " + triangle),
                {12, 0, 0});
    expect_near(first_vertex("Translate 9 9 9 Identity " + triangle), {1, 0, 0});
}

TEST(PbrtTransforms, ComeBackAtTheEndOfABlock) {
    expect_near(first_vertex("AttributeBegin Translate 5 0 0 AttributeEnd " + triangle), {1, 0, 0});
    expect_near(first_vertex("TransformBegin Translate 5 0 0 TransformEnd " + triangle), {1, 0, 0});
}

TEST(PbrtTransforms, HaveNames) {
    expect_near(
        first_vertex("Translate 5 0 0 CoordinateSystem \"here\" Identity CoordSysTransform \"here\" " + triangle),
        {6, 0, 0});
    // the camera's system leads from the camera into the world
    const auto scene =
        read_text("Translate 0 0 5 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\" " + triangle);
    expect_near(mesh_of(scene).positions[0], {0, 0, -5});
}

TEST(PbrtCamera, LooksAlongZWithXToTheRight) {
    const auto camera = read_text("LookAt 1 2 3  1 2 13  0 1 0 Camera \"perspective\" WorldBegin").camera;
    expect_near(transform_point(camera.to_world, {0, 0, 0}), {1, 2, 3});
    expect_near(transform_direction(camera.to_world, {0, 0, 1}), {0, 0, 1});
    expect_near(transform_direction(camera.to_world, {1, 0, 0}), {1, 0, 0});
    expect_near(transform_direction(camera.to_world, {0, 1, 0}), {0, 1, 0});
}

// at 100000 a float step is 1/128: the eye stands .046875 high, not .05, and looks at the same point from there
TEST(PbrtCamera, LooksAtItsTargetFromWhereFloatsPutIt) {
    const auto camera = read_text(
                            "LookAt 100000 100000.05 100006  100000 100000 99999.95  0 1 0 Camera \"perspective\" "
                            "WorldBegin")
                            .camera;
    EXPECT_EQ(transform_point(camera.to_world, {0, 0, 0}), (Vec3{100000, 100000.046875f, 100006}));
    const Vec3 ahead = transform_direction(camera.to_world, {0, 0, 1});
    EXPECT_NEAR(ahead.y / ahead.z, 0.046875 / 6.046875, 1e-7);
}

TEST(PbrtCamera, IsMirroredByAScaleBeforeIt) {
    const auto camera = read_text("Scale -1 1 1 LookAt 1 2 3  1 2 13  0 1 0 Camera \"perspective\" WorldBegin").camera;
    expect_near(transform_point(camera.to_world, {0, 0, 0}), {1, 2, 3});
    expect_near(transform_direction(camera.to_world, {0, 0, 1}), {0, 0, 1});
    expect_near(transform_direction(camera.to_world, {1, 0, 0}), {-1, 0, 0});
}

TEST(PbrtCamera, HasAScreenOnlyWhenOneIsGiven) {
    EXPECT_FALSE(read_text("Camera \"perspective\" \"float fov\" 30 WorldBegin").camera.screen_given);
    const auto wide = read_text("Camera \"perspective\" \"float frameaspectratio\" 2 WorldBegin").camera;
    EXPECT_TRUE(wide.screen_given);
    EXPECT_EQ(wide.screen, (std::array<float, 4>{-2, 2, -1, 1}));
    const auto tall = read_text("Camera \"perspective\" \"float frameaspectratio\" 0.5 WorldBegin").camera;
    EXPECT_EQ(tall.screen, (std::array<float, 4>{-1, 1, -2, 2}));
    const auto window = read_text("Camera \"perspective\" \"float screenwindow\" [ 0 1 -1 0 ] WorldBegin").camera;
    EXPECT_EQ(window.screen, (std::array<float, 4>{0, 1, -1, 0}));
}

TEST(PbrtFilm, HasSizeCropAndScale) {
    const auto film = read_text(
                          "Film \"rgb\" \"integer xresolution\" 320 \"integer yresolution\" [ 200 ] \"float iso\" 200\n"
                          "\"float cropwindow\" [ 0 .5 .25 1 ] \"string sensor\" \"cie1931\"\n"
                          "Camera \"perspective\" \"float shutteropen\" 0.5 \"float shutterclose\" 1 WorldBegin")
                          .film;
    EXPECT_EQ(film.width, 320u);
    EXPECT_EQ(film.height, 200u);
    EXPECT_EQ(film.scale, 1);  // twice the sensitivity, half the time
    EXPECT_EQ(film.crop, (std::array<float, 4>{0, 0.5f, 0.25f, 1}));
}

TEST(PbrtFilm, HasTheSizeThatPbrtGivesIt) {
    const auto film = read_text("WorldBegin").film;
    EXPECT_EQ(film.width, 1280u);
    EXPECT_EQ(film.height, 720u);
    EXPECT_EQ(film.scale, 1);
}

TEST(PbrtFiles, IncludeEachOther) {
    const MemoryFiles files{{"parts/ball.pbrt", "Translate 1 0 0 " + ball}};
    const auto scene = read_world("Include \"parts/ball.pbrt\" " + ball, files);
    ASSERT_THAT(scene.shapes, SizeIs(2));
    expect_near(sphere_of(scene, 1).center, {1, 0, 0});  // what an included file does stays
    EXPECT_EQ(scene.shapes[0].where, (SourceLine{"parts/ball.pbrt", 1}));
}

TEST(PbrtFiles, ImportWithoutAnEffectOnWhatFollows) {
    const MemoryFiles files{{"ball.pbrt", "Translate 1 0 0 " + ball}};
    const auto scene = read_world("Import \"ball.pbrt\" " + ball, files);
    expect_near(sphere_of(scene, 0).center, {1, 0, 0});
    expect_near(sphere_of(scene, 1).center, {0, 0, 0});
}

TEST(PbrtFiles, AreRelativeToTheMainOne) {
    MemoryFiles files{{"a/scene.pbrt", "WorldBegin Include \"deep/one.pbrt\""},
                      {"a/deep/one.pbrt", "Include \"two.pbrt\""},
                      {"a/two.pbrt", ball}};
    EXPECT_THAT(read_scene(files, "a/scene.pbrt").shapes, SizeIs(1));
}

TEST(PbrtFiles, MayBeginWithAByteOrderMarkAndHaveOtherLineEnds) {
    const auto scene = read_text("\xEF\xBB\xBFWorldBegin\r\n# remark\r\n" + ball);
    ASSERT_THAT(scene.shapes, SizeIs(1));
    EXPECT_EQ(scene.shapes[0].where.line, 3);
}

TEST(PbrtBlocks, KeepMaterialLampAndOrientation) {
    const auto scene =
        read_world("AttributeBegin Material \"dielectric\" AreaLightSource \"diffuse\" ReverseOrientation " + ball +
                   "AttributeEnd " + ball);
    EXPECT_TRUE(scene.shapes[0].emission);
    EXPECT_TRUE(sphere_of(scene, 0).flip_normals);
    EXPECT_FALSE(scene.shapes[1].emission);
    EXPECT_FALSE(sphere_of(scene, 1).flip_normals);
    EXPECT_EQ(model_of<DielectricMaterial>(scene, 0).eta, 1.5f);
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene, 1).reflectance), (Rgb{0.5f, 0.5f, 0.5f}));
}

TEST(PbrtAttributes, FillInWhatAStatementLeavesOut) {
    const auto scene = read_world(
        "Attribute \"shape\" \"float radius\" 3\nAttribute \"material\" \"rgb reflectance\" [ 1 0 0 ]\n"
        "Material \"diffuse\"\n" +
        ball + "Shape \"sphere\" \"float radius\" 5");
    EXPECT_EQ(sphere_of(scene, 0).radius, 3);
    EXPECT_EQ(sphere_of(scene, 1).radius, 5);
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{1, 0, 0}));
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtObjects, StandOnceHoweverManyInstancesThereAre) {
    const auto scene = read_world("ObjectBegin \"pair\" Translate 0 1 0 " + ball + triangle + "ObjectEnd\n" + ball +
                                  "Translate 5 0 0 ObjectInstance \"pair\" Translate 5 0 0 ObjectInstance \"pair\"");
    ASSERT_THAT(scene.shapes, SizeIs(3));
    ASSERT_THAT(scene.objects, SizeIs(1));
    EXPECT_THAT(scene.objects[0].shapes, ElementsAre(0u, 1u));
    expect_near(sphere_of(scene, 0).center, {0, 1, 0});
    ASSERT_THAT(scene.instances, SizeIs(2));
    expect_near(transform_point(scene.instances[1].to_world, sphere_of(scene, 0).center), {10, 1, 0});
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtObjects, LoseTheirInterfaces) {
    const auto scene = read_world("ObjectBegin \"o\" Material \"interface\" " + ball + "Material \"diffuse\" " + ball +
                                  "ObjectEnd ObjectInstance \"o\"");
    ASSERT_THAT(scene.shapes, SizeIs(1));
    EXPECT_THAT(scene.objects[0].shapes, ElementsAre(0u));
}

TEST(PbrtColours, MayHaveOtherPrimaries) {
    const std::string red = "Material \"diffuse\" \"rgb reflectance\" [ .25 .5 .25 ] " + ball;
    for (const char* space : {"rec2020", "dci-p3", "aces2065-1"}) {
        const auto scene = read_world("ColorSpace \"" + std::string(space) + "\" Material \"diffuse\" " +
                                      "\"rgb reflectance\" [ .5 .5 .5 ] " + ball + red);
        const Rgb grey = colour_of(scene, model_of<DiffuseMaterial>(scene, 0).reflectance);
        EXPECT_NEAR(grey.r, 0.5f, 1e-4f) << space;
        EXPECT_NEAR(grey.b, 0.5f, 1e-4f) << space;
        const Rgb green = colour_of(scene, model_of<DiffuseMaterial>(scene, 1).reflectance);
        EXPECT_LT(green.r, 0.22f) << space;  // the same green is purer than that of sRGB
        EXPECT_GT(green.g, 0.51f) << space;
    }
    EXPECT_THAT(errors_of_world("ColorSpace \"rec2002\""), HasSubstr("did you mean 'rec2020'?"));
}

TEST(PbrtStatements, ThatConcernSamplingHaveNoEffect) {
    const auto scene = read_text(
        "Option \"bool disablepixeljitter\" true\nIntegrator \"path\" \"integer maxdepth\" 5\n"
        "Sampler \"zsobol\" \"integer pixelsamples\" 64\nPixelFilter \"box\"\nAccelerator \"bvh\"\n"
        "ColorSpace \"srgb\"\nTransformTimes 0 1\nWorldBegin");
    EXPECT_THAT(scene.warnings, IsEmpty());
}

}  // namespace
}  // namespace lightnet::test::pbrt_language_reader_test
