// The language of Mitsuba's XML: variables, references, includes, transforms, and all that can be wrong with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/readers/mitsuba/document.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_language_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const std::string sphere = "<shape type='sphere'/>";

std::string moved(const std::string& statements) {
    return "<shape type='sphere'><transform name='to_world'>" + statements + "</transform></shape>";
}

Vec3 center_of(const std::string& statements) { return sphere_of(read_mitsuba(moved(statements))).center; }

TEST(MitsubaNames, AreThoseOfVersionThree) {
    EXPECT_EQ(mitsuba::snake_case("toWorld"), "to_world");
    EXPECT_EQ(mitsuba::snake_case("intIOR"), "int_ior");
    EXPECT_EQ(mitsuba::snake_case("alphaU"), "alpha_u");
    EXPECT_EQ(mitsuba::snake_case("diffuse_reflectance"), "diffuse_reflectance");
}

TEST(MitsubaVariables, HaveTheirDefaultsAndLongestNames) {
    const auto scene = read_mitsuba(
        "<default name='r' value='2'/><default name='r' value='3'/><default name='radius' value='5'/>"
        "<shape type='sphere'><float name='radius' value='$radius'/></shape>"
        "<shape type='sphere'><float name='radius' value='$r'/></shape>");
    EXPECT_EQ(sphere_of(scene, 0).radius, 5);
    EXPECT_EQ(sphere_of(scene, 1).radius, 2);
    EXPECT_THAT(errors_of_mitsuba("<default name='radius' value='1'/><shape type='sphere'>"
                                  "<float name='radius' value='$radus'/></shape>"),
                HasSubstr("scene.xml:1: there is no variable '$radus' (did you mean 'radius'?)"));
}

TEST(MitsubaReferences, MayComeBeforeWhatTheyMeanAndHaveAliases) {
    const auto scene = read_mitsuba(
        "<shape type='sphere'><ref id='a'/></shape><bsdf type='dielectric' id='a'/><alias id='a' as='b'/>"
        "<shape type='sphere'><ref id='b'/></shape>");
    EXPECT_EQ(scene.shapes[0].material, scene.shapes[1].material);
    EXPECT_NO_THROW(model_of<DielectricMaterial>(scene, 0));
    EXPECT_THAT(errors_of_mitsuba("<bsdf type='diffuse' id='wall'/><shape type='sphere'><ref id='wal'/></shape>"),
                HasSubstr("there is no element with the id 'wal' (did you mean 'wall'?)"));
    EXPECT_THAT(errors_of_mitsuba("<bsdf type='diffuse' id='a'/>\n<bsdf type='diffuse' id='a'/>" + sphere),
                HasSubstr("scene.xml:2: there is another element with the id 'a'"));
}

TEST(MitsubaReferences, MustNotGoInCircles) {
    EXPECT_THAT(errors_of_mitsuba(
                    "<bsdf type='twosided' id='a'><ref id='b'/></bsdf>"
                    "<bsdf type='twosided' id='b'><ref id='a'/></bsdf><shape type='sphere'><ref id='a'/></shape>"),
                HasSubstr("refers to itself"));
    EXPECT_THAT(
        errors_of_mitsuba("<texture type='checkerboard' id='t'><ref name='color0' id='t'/></texture>"
                          "<shape type='sphere'><bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf></shape>"),
        HasSubstr("texture 't' refers to itself"));
}

TEST(MitsubaIncludes, ArePartOfTheSceneWithLinesOfTheirOwn) {
    const auto scene =
        read_mitsuba("<include filename='parts/more.xml'/>", {{"parts/more.xml", "<scene>" + sphere + "</scene>"}});
    EXPECT_THAT(scene.shapes, SizeIs(1));
    EXPECT_EQ(scene.shapes[0].where, (SourceLine{"parts/more.xml", 1}));
    const std::string errors =
        errors_of_mitsuba("<include filename='a.xml'/><include filename='none.xml'/>" + sphere,
                          {{"a.xml", "<scene>\n<include filename='scene.xml'/>\n<include filename='a.xml'/></scene>"}});
    EXPECT_THAT(errors, HasSubstr("a.xml:2: 'scene.xml' includes itself"));
    EXPECT_THAT(errors, HasSubstr("a.xml:3: 'a.xml' includes itself"));
    EXPECT_THAT(errors, HasSubstr("scene.xml:1: can't read a file: none.xml: no such file"));
}

// Beside the file that names them, beside the first one, and in folders beside either.
TEST(MitsubaIncludes, FindFilesFromTheirOwnFolderAndFromTheFirstFiles) {
    const std::string ball = "<scene>" + sphere + "</scene>";
    const auto scene =
        read_mitsuba("<include filename='sub/a.xml'/>",
                     {{"sub/a.xml",
                       "<scene><include filename='sub/deep/b.xml'/><include filename='near.xml'/><path value='extra'/>"
                       "<include filename='c.xml'/><include filename='d.xml'/></scene>"},
                      {"sub/deep/b.xml", ball},
                      {"sub/near.xml", ball},
                      {"extra/c.xml", ball},
                      {"sub/extra/d.xml", ball}});
    EXPECT_THAT(scene.shapes, SizeIs(4));
    EXPECT_EQ(scene.shapes[0].where.file, "sub/deep/b.xml");
}

TEST(MitsubaReferences, MakeNoFalseAlarms) {
    const auto scene = read_mitsuba(
        "<shape type='rectangle'><ref id='lamp'/></shape><emitter type='area' id='lamp'/>"
        "<medium type='homogeneous' id='ink'><rgb name='sigma_a' value='1'/><rgb name='sigma_s' value='0'/></medium>"
        "<shape type='sphere'><bsdf type='dielectric'/><ref id='ink' name='interior'/></shape>"
        "<spectrum id='s' name='x' value='.5'/><shape type='sphere'><bsdf type='diffuse'><ref id='s' "
        "name='reflectance'/></bsdf></shape>");
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
    EXPECT_TRUE(scene.shapes[0].emission.has_value());
    EXPECT_THAT(warnings_of(read_mitsuba(sphere + "<emitter type='area' id='lamp'/>")),
                HasSubstr("emitter 'area' belongs to no shape and is left out"));
}

TEST(MitsubaTransforms, ApplyInTheOrderInWhichTheyStand) {
    EXPECT_EQ(center_of("<translate x='1'/><scale value='2'/>"), (Vec3{2, 0, 0}));
    EXPECT_EQ(center_of("<scale value='2'/><translate x='1'/>"), (Vec3{1, 0, 0}));
    const Vec3 turned = center_of("<translate x='1'/><rotate y='1' angle='90'/>");
    EXPECT_NEAR(turned.x, 0, 1e-6);
    EXPECT_NEAR(turned.z, -1, 1e-6);
    const Vec3 upright = center_of("<translate y='1'/><rotate x='1' angle='90'/>");
    EXPECT_NEAR(upright.z, 1, 1e-6);
    EXPECT_EQ(center_of("<matrix value='1 0 0 4  0 1 0 5  0 0 1 6  0 0 0 1'/>"), (Vec3{4, 5, 6}));
    EXPECT_EQ(center_of("<lookat origin='1, 2, 3' target='1 2 4' up='0 1 0'/>"), (Vec3{1, 2, 3}));
    EXPECT_EQ(center_of("<lookAt origin='1, 2, 3' target='1 2 4' up='0 1 0'/>"), (Vec3{1, 2, 3}));
}

TEST(MitsubaTransforms, SayWhatIsWrong) {
    EXPECT_THAT(errors_of_mitsuba(moved("<matrix value='1 2 3'/>")), HasSubstr("a matrix has 16 numbers, not 3"));
    EXPECT_THAT(errors_of_mitsuba(moved("<rotate angle='3'/>")), HasSubstr("a rotation needs an axis"));
    EXPECT_THAT(errors_of_mitsuba(moved("<lookat origin='0 0 0' target='0 1 0' up='0 1 0'/>")),
                HasSubstr("span no view"));
    EXPECT_THAT(errors_of_mitsuba(moved("<skew x='1'/>")), HasSubstr("unknown transform <skew>"));
    EXPECT_THAT(errors_of_mitsuba(moved("<translate x='nan'/>")), HasSubstr("a finite number expected, not 'nan'"));
}

TEST(MitsubaFiles, AreWrongInManyPlacesAtOnce) {
    const std::string errors = errors_as("scene.xml",
                                         "<scene version='3.0.0'>\n<shape type='obj'/>\n<shape type='sphere'>\n"
                                         "<float name='radius' value='x'/></shape>\n<shape type='ply'>"
                                         "<string name='filename' value='none.ply'/></shape></scene>");
    EXPECT_THAT(errors, HasSubstr("scene.xml:2: shape 'obj' needs a 'filename'"));
    EXPECT_THAT(errors, HasSubstr("scene.xml:4: a finite number expected, not 'x'"));
    EXPECT_THAT(errors, HasSubstr("scene.xml:5: can't read a file: none.ply: no such file"));
}

TEST(MitsubaFiles, HoldTheLastOfAParameterThatIsGivenTwice) {
    const auto scene = read_mitsuba(
        "<shape type='sphere'><float name='radius' value='3'/><float name='radius' "
        "value='2'/></shape><emitter type='constant'/>");
    EXPECT_EQ(std::get<Sphere>(scene.shapes.at(0).geometry).radius, 2);
    EXPECT_THAT(warnings_of(scene),
                HasSubstr("parameter 'radius' of shape 'sphere' is given twice: the last one holds"));
}

TEST(MitsubaFiles, MayBeNothingButASky) {
    const auto scene = read_mitsuba("<sensor type='perspective'/><emitter type='constant'/>");
    EXPECT_TRUE(scene.shapes.empty());
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(MitsubaFiles, NameWhatTheirIntegratorsHide) {
    const auto with = [](const std::string& value) {
        return warnings_of(
            read_mitsuba("<integrator type='aov'><integrator type='path'><boolean name='hideEmitters' value='" + value +
                         "'/></integrator></integrator><shape type='sphere'/>"));
    };
    EXPECT_THAT(with("true"), HasSubstr("'hide_emitters' is left out: the camera sees lamps"));
    EXPECT_THAT(with("false"), Not(HasSubstr("hide_emitters")));
}

TEST(MitsubaFiles, MustBeSoundXml) {
    EXPECT_THAT(errors_as("scene.xml", "<scene>\n<shape></scene>"), HasSubstr("scene.xml:2: not sound XML"));
    EXPECT_THAT(errors_as("scene.xml", ""), HasSubstr("not sound XML"));
    EXPECT_THAT(errors_as("scene.xml", "<html/>"), HasSubstr("begins with <scene>, not with <html>"));
    EXPECT_THAT(errors_as("scene.xml", "<scene/>"), HasSubstr("there are no shapes"));
    EXPECT_THAT(
        errors_as("scene.xml", "<scene><Group id='0'><TriangleMesh/></Group></scene>"),
        HasSubstr("<Group> is none of Mitsuba's elements (other formats in XML, such as Embree's, aren't read)"));
    std::string deep = "<scene>";
    for (int i = 0; i < 100000; ++i) deep += "<bsdf type='twosided'>";
    for (int i = 0; i < 100000; ++i) deep += "</bsdf>";
    EXPECT_THAT(errors_as("scene.xml", deep + "</scene>"), HasSubstr("elements are nested too deeply"));
}

TEST(MitsubaFiles, MayHoldWhatNobodyKnows) {
    const auto scene =
        read_mitsuba("<constellation/><shape type='teapot'/><shape type='teapot'/>" + sphere +
                     "<shape type='sphere'><bsdf type='velvet'/><float name='sharpness' value='3'/></shape>");
    EXPECT_THAT(scene.shapes, SizeIs(2));
    const std::string warnings = warnings_of(scene);
    EXPECT_THAT(warnings, HasSubstr("unknown element <constellation> is left out"));
    EXPECT_THAT(warnings, HasSubstr("shape 'teapot' is not supported and left out (2 times)"));
    EXPECT_THAT(warnings, HasSubstr("bsdf 'velvet' is not supported: grey is taken"));
    EXPECT_THAT(warnings, HasSubstr("parameter 'sharpness' of shape 'sphere' is left out"));
    EXPECT_THAT(warnings, HasSubstr("'--env'"));
}

TEST(MitsubaFiles, MayBeOfOlderVersions) {
    const auto scene = read_as("old.xml", R"(<?xml version="1.0" encoding="utf-8"?>
<scene version="0.5.0">
  <integrator type="path"><integer name="maxDepth" value="-1"/></integrator>
  <shape type="rectangle"><transform name="toWorld"><translate z="3"/></transform>
    <bsdf type="dielectric"><float name="intIOR" value="1.5"/><float name="extIOR" value="1"/></bsdf></shape>
  <emitter type="constant"><spectrum name="radiance" value="2"/></emitter>
</scene>)");
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_EQ(mesh_of(scene).positions[0].z, 3);
    EXPECT_EQ(model_of<DielectricMaterial>(scene).eta, 1.5f);
    EXPECT_EQ(scene.environments.at(0).radiance, (Rgb{2, 2, 2}));
}

// Before version 0.5 lights were luminaires, of an intensity, and angles of cameras those of the shorter side.
TEST(MitsubaFiles, MayBeOfTheFirstVersions) {
    const auto read = [](const std::string& part) {
        return read_as("old.xml",
                       R"(<scene version="0.3.0"><camera type="perspective"><float name="fov" value="60"/>)" + part +
                           R"(<film type="exrfilm"><integer name="width" value="200"/>
  <integer name="height" value="100"/></film></camera>
  <shape type="rectangle"><luminaire type="area"><spectrum name="intensity" value="3"/></luminaire></shape>
  <luminaire type="constant"><spectrum name="intensity" value="2"/></luminaire>
  <luminaire type="directional"><spectrum name="intensity" value="4"/></luminaire></scene>)");
    };
    const auto scene = read("");
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_EQ(scene.shapes.at(0).emission->radiance, (Rgb{3, 3, 3}));
    EXPECT_EQ(scene.environments.at(0).radiance, (Rgb{2, 2, 2}));
    EXPECT_EQ(std::get<DirectionalLight>(scene.lights.at(0)).irradiance, (Rgb{4, 4, 4}));
    EXPECT_NEAR(scene.camera.fov, 60, 1e-3f);  // ours is that of the shorter side, too
    EXPECT_LT(read(R"(<boolean name="mapSmallerSide" value="false"/>)").camera.fov, 33);
}

}  // namespace
}  // namespace lightnet::test::mitsuba_language_reader_test
