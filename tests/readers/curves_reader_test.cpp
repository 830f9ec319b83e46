// Hair as pbrt and Mitsuba write it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/scene/shapes/curves.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::curves_reader_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

const Curves& curves_of(const SceneData& scene, std::size_t shape = 0) {
    return std::get<Curves>(scene.shapes.at(shape).geometry);
}

std::string curve(const std::string& parameters) { return "Shape \"curve\" " + parameters + "\n"; }

const std::string four = "\"point3 P\" [ 0 0 0  0 0 1  0 0 2  0 0 3 ] ";
const std::string three = "\"point3 P\" [ 0 0 0  1 0 0  2 1 0 ] \"integer degree\" 2 ";

TEST(PbrtCurves, HaveTheWidthsThatAreSaid) {
    const auto scene = read_world(curve(four + "\"float width0\" 0.2 \"float width1\" 0.1 \"integer splitdepth\" 2") +
                                  curve(four + "\"float width\" 0.3") + curve(four));
    const Curves& curves = curves_of(scene);
    EXPECT_EQ(warnings_of(scene), "scene.pbrt:2: Shape 'curve': a flat curve is taken as a round one (3 times)\n");
    EXPECT_NEAR(curves.at(0, 0).radius, 0.1f, 1e-6f);
    EXPECT_NEAR(curves.at(0, 0.5f).radius, 0.075f, 1e-6f);
    EXPECT_NEAR(curves.at(0, 1).radius, 0.05f, 1e-6f);
    EXPECT_NEAR(curves.at(0, 0.5f).position.z, 1.5f, 1e-6f);
    EXPECT_NEAR(curves.at(1, 0.5f).radius, 0.15f, 1e-6f);
    EXPECT_NEAR(curves.at(2, 0.5f).radius, 0.5f, 1e-6f);
}

TEST(PbrtCurves, ThatAreAlikeBecomeOneShape) {
    const auto scene =
        read_world(curve(four) + curve(four) + "Material \"conductor\"\n" + curve(four) + "Shape \"sphere\"\n" +
                   curve(four) + "ObjectBegin \"o\"\n" + curve(four) + curve(four) + "ObjectEnd\n" + curve(four));
    ASSERT_THAT(scene.shapes, SizeIs(6));
    EXPECT_THAT(curves_of(scene, 0).strands, ElementsAre(0, 1));
    EXPECT_THAT(curves_of(scene, 1).strands, ElementsAre(0));
    EXPECT_THAT(curves_of(scene, 4).strands, ElementsAre(0, 1));
    EXPECT_THAT(scene.objects.at(0).shapes, ElementsAre(4));
}

// The ends of a B-spline's segments, and the middle of a parabola, are known.
TEST(PbrtCurves, OfAllBasesAndDegreesRunWherePbrtHasThem) {
    const auto spline = read_world(curve(four + "\"string basis\" \"bspline\""));
    EXPECT_NEAR(curves_of(spline).at(0, 0).position.z, 1, 1e-6f);
    EXPECT_NEAR(curves_of(spline).at(0, 1).position.z, 2, 1e-6f);
    const auto parabola = read_world(curve(three));
    EXPECT_NEAR(curves_of(parabola).at(0, 0.5f).position.x, 1, 1e-6f);
    EXPECT_NEAR(curves_of(parabola).at(0, 0.5f).position.y, 0.25f, 1e-6f);
    const auto square_spline = read_world(curve(three + "\"string basis\" \"bspline\""));
    EXPECT_NEAR(curves_of(square_spline).at(0, 0).position.x, 0.5f, 1e-6f);
    EXPECT_NEAR(curves_of(square_spline).at(0, 1).position.y, 0.5f, 1e-6f);
}

TEST(PbrtCurves, GoWithTheirTransform) {
    const auto scene = read_world("Translate 1 2 3 Scale 2 2 2\n" + curve(four + "\"float width\" 0.2"));
    EXPECT_NEAR(curves_of(scene).at(0, 1).position.z, 9, 1e-5f);
    EXPECT_NEAR(curves_of(scene).at(0, 1).radius, 0.2f, 1e-6f);
    EXPECT_THAT(warnings_of(read_world("Scale 1 2 1\n" + curve(four))), HasSubstr("stretched by its transform"));
}

// It lies at right angles to its normals, which turn from one end to the other.
TEST(PbrtRibbons, LieAcrossTheirNormals) {
    const auto scene =
        read_world(curve(four + "\"string type\" \"ribbon\" \"float width\" 0.5 \"normal N\" [ 1 0 0  0 1 0 ]"));
    const Mesh& mesh = mesh_of(scene);
    EXPECT_THAT(mesh.positions, SizeIs(34));
    EXPECT_NEAR(mesh.positions[0].x, 0, 1e-6f);
    EXPECT_NEAR(std::fabs(mesh.positions[0].y), 0.25f, 1e-6f);
    EXPECT_NEAR(std::fabs(mesh.positions[33].x), 0.25f, 1e-6f);
    EXPECT_NEAR(mesh.positions[33].y, 0, 1e-6f);
    EXPECT_NEAR(mesh.normals[16].x, std::sqrt(0.5f), 1e-5f);
    EXPECT_FLOAT_EQ(mesh.uvs[33].x, 1);
    EXPECT_FLOAT_EQ(mesh.uvs[33].y, 1);
}

TEST(PbrtCurves, SayWhatIsMissing) {
    const auto wrong = [](const std::string& parameters) { return errors_of_world(curve(parameters)); };
    EXPECT_THAT(wrong(""), HasSubstr("scene.pbrt:2: "));
    EXPECT_THAT(wrong(""),
                HasSubstr("a Bézier curve of degree 3 needs 4 points, and 3 for each further segment: there are 0"));
    EXPECT_THAT(wrong(three + "\"string basis\" \"bspline\" \"integer degree\" 3"),
                HasSubstr("needs 4 points or more"));
    EXPECT_THAT(wrong(four + "\"integer degree\" 4"), HasSubstr("the degree of a curve is 2 or 3, not 4"));
    EXPECT_THAT(wrong(four + "\"string basis\" \"bezir\""), HasSubstr("did you mean 'bezier'?"));
    EXPECT_THAT(wrong(four + "\"string type\" \"round\""), HasSubstr("'round' is no 'type' of a curve"));
    EXPECT_THAT(wrong(four + "\"float width\" -1"), HasSubstr("the width of a curve must be 0 or more"));
    EXPECT_THAT(wrong(four + "\"string type\" \"ribbon\""),
                HasSubstr("a ribbon of 1 segments needs 2 normals 'N': there are 0"));
}

SceneData strands(const std::string& type, const std::string& text, const std::string& more = "") {
    return read_mitsuba("<shape type='" + type + "'><string name='filename' value='hair.txt'/>" + more + "</shape>",
                        {{"hair.txt", text}});
}

TEST(MitsubaCurves, AreSplinesOrStraight) {
    const std::string text =
        "0 0 0 0.1\n 0 0 1 0.1\r\n0 0 2 .1\n0\t0 3 1e-1\n\n\n5 0 0 0.2\n5 0 1 0.2\n5 0 2 0.2\n5 0 3 0.2";
    const auto spline = strands("bsplinecurve", text);
    EXPECT_THAT(curves_of(spline).strands, ElementsAre(0, 1));
    EXPECT_NEAR(curves_of(spline).at(0, 0).position.z, 1, 1e-6f);
    EXPECT_NEAR(curves_of(spline).at(1, 1).position.z, 2, 1e-6f);
    EXPECT_NEAR(curves_of(spline).at(1, 1).radius, 0.2f, 1e-6f);
    const auto linear = strands("linearcurve", text);
    EXPECT_THAT(curves_of(linear).strands, ElementsAre(0, 3));
    EXPECT_NEAR(curves_of(linear).at(4, 0.5f).position.z, 1.5f, 1e-6f);
}

// As in Mitsuba.
TEST(MitsubaCurves, KeepTheirRadiusUnderTransforms) {
    const auto scene =
        strands("linearcurve", "0 0 0 0.1\n0 0 1 0.1\n", "<transform name='to_world'><scale value='3'/></transform>");
    EXPECT_NEAR(curves_of(scene).at(0, 1).position.z, 3, 1e-6f);
    EXPECT_NEAR(curves_of(scene).at(0, 1).radius, 0.1f, 1e-6f);
}

TEST(MitsubaCurves, SayInWhichLineAMistakeIs) {
    const auto wrong = [](const std::string& type, const std::string& text) {
        return errors_of_mitsuba("<shape type='" + type + "'><string name='filename' value='hair.txt'/></shape>",
                                 {{"hair.txt", text}});
    };
    EXPECT_THAT(wrong("linearcurve", "0 0 0 1\n0 0 1\n"), HasSubstr("line 2: a control point has four numbers"));
    EXPECT_THAT(wrong("linearcurve", "0 0 0 1\n0 0 1 -1\n"), HasSubstr("line 2: a radius must be 0 or more"));
    EXPECT_THAT(wrong("linearcurve", "0 0 nan 1\n"), HasSubstr("line 1: a control point is not finite"));
    EXPECT_THAT(wrong("bsplinecurve", "0 0 0 1\n0 0 1 1\n\n"),
                HasSubstr("needs 4 control points or more: there are 2"));
    EXPECT_THAT(wrong("bsplinecurve", "\n\n"), HasSubstr("hair.txt: there are no control points in it"));
    EXPECT_THAT(errors_of_mitsuba("<shape type='linearcurve'/>"), HasSubstr("needs a 'filename'"));
}

}  // namespace
}  // namespace lightnet::test::curves_reader_test
