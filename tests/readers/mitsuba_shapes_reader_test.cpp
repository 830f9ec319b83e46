// Mitsuba's shapes, emitters and sensors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <numbers>

#include "core/readers/mitsuba/serialized.hpp"
#include "core/scene/shapes/placed_quadric.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_shapes_reader_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

constexpr float degrees = std::numbers::pi_v<float> / 180;

SceneData shape(const std::string& type, const std::string& inside, MemoryFiles files = {}) {
    return read_mitsuba("<shape type='" + type + "'>" + inside + "</shape>", std::move(files));
}

float area_of(const Mesh& mesh) {
    float area = 0;
    for (const auto& t : mesh.triangles)
        area +=
            length(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]])) / 2;
    return area;
}

/// The mean of (position · normal) over the triangles: positive where a closed shape around 0 looks outwards.
float outwards(const Mesh& mesh) {
    float sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        sum += dot(normal_of(mesh, i), mesh.positions[mesh.triangles[i][0]]);
    return sum / float(mesh.triangles.size());
}

std::string deflated(const std::string& text) {
    uLongf size = compressBound(text.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(text.data()), text.size());
    packed.resize(size);
    return packed;
}

/// One triangle with uvs, at z.
std::string packed_triangle(float z, std::uint16_t version) {
    std::string body = raw(std::uint32_t{0x1002});
    if (version == 4) body += std::string("tri\0", 4);
    body += raw(std::uint64_t{3}, std::uint64_t{1});
    body += raw(0.0f, 0.0f, z, 1.0f, 0.0f, z, 0.0f, 1.0f, z);
    body += raw(0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f);
    body += raw(std::uint32_t{0}, std::uint32_t{1}, std::uint32_t{2});
    return raw(std::uint16_t{0x041C}, version) + deflated(body);
}

std::string two_triangles(std::uint16_t version) {
    const std::string first = packed_triangle(0, version), second = packed_triangle(7, version);
    const std::string table = version == 4 ? raw(std::uint64_t{0}, std::uint64_t{first.size()})
                                           : raw(std::uint32_t{0}, static_cast<std::uint32_t>(first.size()));
    return first + second + table + raw(std::uint32_t{2});
}

TEST(MitsubaRectangle, LooksAlongZWhateverTheHandedness) {
    EXPECT_EQ(normal_of(mesh_of(shape("rectangle", ""))), (Vec3{0, 0, 1}));
    EXPECT_EQ(normal_of(mesh_of(shape("rectangle", "<transform name='to_world'><scale x='-1'/></transform>"))),
              (Vec3{0, 0, 1}));
    EXPECT_EQ(normal_of(mesh_of(shape("rectangle", "<boolean name='flipNormals' value='true'/>"))), (Vec3{0, 0, -1}));
    EXPECT_FLOAT_EQ(area_of(mesh_of(shape("rectangle", ""))), 4);
}

TEST(MitsubaSolids, LookOutwards) {
    const auto cube = mesh_of(shape("cube", ""));
    EXPECT_FLOAT_EQ(area_of(cube), 24);
    EXPECT_FLOAT_EQ(outwards(cube), 1);
    EXPECT_FLOAT_EQ(outwards(mesh_of(shape("cube", "<transform name='to_world'><scale z='-1'/></transform>"))), 1);
}

TEST(MitsubaCylinder, StandsBetweenItsEnds) {
    const auto scene = shape(
        "cylinder",
        "<point name='p0' x='0' y='-2' z='0'/><point name='p1' x='0' y='2' z='0'/><float name='radius' value='.5'/>");
    const PlacedQuadric cylinder(quadric_of(scene));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("triangles")));
    EXPECT_NEAR(cylinder.area(), 4 * std::numbers::pi_v<float>, 1e-4f);
    EXPECT_FLOAT_EQ(cylinder.position({1, 0, 0}).y, -2);
    EXPECT_FLOAT_EQ(cylinder.position({1, 0, 1}).y, 2);
    EXPECT_GT(dot(cylinder.normal({1, 0, 0}), cylinder.position({1, 0, 0.5f})), 0.49f);
    EXPECT_EQ(cylinder.uv({0, 1, 0.25f}), (Vec2{0.25f, 0.75f}));
}

TEST(MitsubaDisk, LooksAlongZWithTheRadiusAsItsFirstCoordinate) {
    const auto scene = shape("disk", "<transform name='to_world'><scale x='-1'/></transform>");
    const PlacedQuadric disk(quadric_of(scene));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("triangles")));
    EXPECT_NEAR(disk.area(), std::numbers::pi_v<float>, 1e-5f);
    EXPECT_EQ(disk.normal({}), (Vec3{0, 0, 1}));
    EXPECT_NEAR(disk.uv({0, 0.75f, 0}).x, 0.75f, 1e-6f);
    EXPECT_NEAR(disk.uv({0, 0.75f, 0}).y, 0.75f, 1e-6f);
}

TEST(MitsubaSphere, IsRoundOrStretched) {
    const auto round = sphere_of(shape("sphere",
                                       "<point name='center' value='1 0 0'/><float name='radius' value='2'/>"
                                       "<transform name='to_world'><scale value='3'/></transform>"));
    EXPECT_EQ(round.center, (Vec3{3, 0, 0}));
    EXPECT_FLOAT_EQ(round.radius, 6);
    const auto egg = shape("sphere", "<transform name='to_world'><scale z='2'/></transform>");
    EXPECT_THAT(warnings_of(egg), Not(HasSubstr("triangles")));
    EXPECT_EQ(PlacedQuadric(quadric_of(egg)).position({0, 0, 1}), (Vec3{0, 0, 2}));
    EXPECT_EQ(PlacedQuadric(quadric_of(egg)).normal({0, 0, -1}), (Vec3{0, 0, -1}));
    EXPECT_THAT(errors_of_mitsuba("<shape type='sphere'><float name='radius' value='0'/></shape>"),
                HasSubstr("a radius above 0"));
}

const std::string obj_square =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

TEST(MitsubaObj, HasItsTexturesUprightAndSmoothNormals) {
    const MemoryFiles files{{"a.obj", obj_square}};
    const auto scene = shape("obj", "<string name='filename' value='a.obj'/>", files);
    EXPECT_THAT(mesh_of(scene).triangles, SizeIs(2));
    EXPECT_EQ(mesh_of(scene).uvs[3], (Vec2{0, 1}));
    EXPECT_THAT(mesh_of(scene).normals, SizeIs(4));
    const auto flat = shape("obj",
                            "<string name='filename' value='a.obj'/><boolean name='faceNormals' value='true'/>"
                            "<boolean name='flipTexCoords' value='false'/>",
                            files);
    EXPECT_TRUE(mesh_of(flat).normals.empty());
    EXPECT_EQ(mesh_of(flat).uvs[3], (Vec2{0, 0}));
}

TEST(MitsubaSerialized, IsReadInBothVersions) {
    for (const std::uint16_t version : {3, 4}) {
        const MemoryFiles files{{"m.serialized", two_triangles(version)}};
        const std::string name = "<string name='filename' value='m.serialized'/>";
        EXPECT_EQ(mesh_of(shape("serialized", name, files)).positions[0].z, 0);
        const auto second = shape("serialized", name + "<integer name='shapeIndex' value='1'/>", files);
        EXPECT_EQ(mesh_of(second).positions[0].z, 7);
        EXPECT_EQ(mesh_of(second).uvs[2], (Vec2{0, 0}));  // v of 1 in a file that counts from the top
        EXPECT_THAT(errors_of_mitsuba(
                        "<shape type='serialized'>" + name + "<integer name='shape_index' value='2'/></shape>", files),
                    HasSubstr("m.serialized: serialized mesh: there is no mesh 2: the file has 2"));
    }
}

TEST(MitsubaSerialized, RefusesWhatIsNotSound) {
    const auto error = [](const std::string& bytes) {
        try {
            bool flat = false;
            mitsuba::read_serialized(std::as_bytes(std::span(bytes)), 0, flat);
        } catch (const Error& problem) {
            return std::string(problem.what());
        }
        return std::string();
    };
    const auto packed = [](const std::string& body) {
        return raw(std::uint16_t{0x041C}, std::uint16_t{4}) + deflated(body);
    };
    EXPECT_THAT(error(""), HasSubstr("ends early"));
    EXPECT_THAT(error("abcdefgh"), HasSubstr("does not begin with 0x041C"));
    EXPECT_THAT(error(raw(std::uint16_t{0x041C}, std::uint16_t{9}) + "1234"), HasSubstr("version 9 is not known"));
    EXPECT_THAT(error(two_triangles(4).substr(0, 30)), HasSubstr("end early"));
    // four thousand million vertices that are not there
    EXPECT_THAT(error(packed(raw(std::uint32_t{0}) + '\0' + raw(std::uint64_t{4000000000}, std::uint64_t{1}))),
                HasSubstr("end early"));
    // so many zeros in so few bytes that they can only be meant to fill the memory
    EXPECT_THAT(error(packed(raw(std::uint32_t{0}) + '\0' + raw(std::uint64_t{3'000'000}, std::uint64_t{0}) +
                             std::string(36'000'000, '\0'))),
                HasSubstr("packed too tightly"));
    std::string wrong =
        raw(std::uint32_t{0}) + '\0' + raw(std::uint64_t{1}, std::uint64_t{1}) + raw(0.f, 0.f, 0.f) + raw(0u, 0u, 5u);
    EXPECT_THAT(error(packed(wrong)), HasSubstr("the vertex index 5, but there are 1 vertices"));
    wrong =
        raw(std::uint32_t{0}) + '\0' + raw(std::uint64_t{1}, std::uint64_t{1}) + raw(0.f, NAN, 0.f) + raw(0u, 0u, 0u);
    EXPECT_THAT(error(packed(wrong)), HasSubstr("not finite"));
}

TEST(MitsubaInstances, ShareAGroup) {
    const auto scene = read_mitsuba(
        "<shape type='shapegroup' id='g'><shape type='cube'/><shape type='sphere'/></shape>"
        "<shape type='instance'><ref id='g'/><transform name='to_world'><translate x='5'/></transform></shape>"
        "<shape type='instance'><ref id='g'/></shape>");
    EXPECT_THAT(scene.objects, SizeIs(1));
    EXPECT_THAT(scene.objects[0].shapes, SizeIs(2));
    ASSERT_THAT(scene.instances, SizeIs(2));
    EXPECT_EQ(scene.instances[0].to_world.m[0][3], 5);
    EXPECT_THAT(errors_of_mitsuba("<shape type='instance'/>"), HasSubstr("needs a reference to one shapegroup"));
    EXPECT_THAT(errors_of_mitsuba("<shape type='shapegroup' id='g'><shape type='instance'><ref id='g'/></shape></shape>"
                                  "<shape type='instance'><ref id='g'/></shape>"),
                HasSubstr("no instances inside of a shapegroup"));
    EXPECT_THAT(errors_of_mitsuba(
                    "<shape type='shapegroup' id='g'><shape type='cube'/></shape><shape type='instance'><ref id='g'/>"
                    "<transform name='to_world'><scale value='0'/></transform></shape>"),
                HasSubstr("scene.xml:1: the transform of an instance can't be inverted"));
}

TEST(MitsubaArea, ShinesOnTheSideOfTheNormal) {
    const auto scene = shape("rectangle", "<emitter type='area'><rgb name='radiance' value='1 2 3'/></emitter>");
    ASSERT_TRUE(scene.shapes[0].emission);
    EXPECT_EQ(scene.shapes[0].emission->radiance, (Rgb{1, 2, 3}));
    EXPECT_FALSE(scene.shapes[0].emission->two_sided);
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{0, 0, 0}));  // a lamp without a bsdf
    const auto hot = shape("sphere", "<emitter type='area'><blackbody name='radiance' temperature='3000K'/></emitter>");
    EXPECT_GT(hot.shapes[0].emission->radiance.r, hot.shapes[0].emission->radiance.b);
}

TEST(MitsubaGlass, MayAbsorb) {
    const auto scene =
        shape("cube",
              "<bsdf type='dielectric'/><medium type='homogeneous' name='interior'><rgb name='albedo' value='0'/>"
              "<rgb name='sigma_t' value='.5 .2 .4'/></medium>");
    EXPECT_EQ(scene.materials[scene.shapes[0].material].absorption, (Rgb{0.5f, 0.2f, 0.4f}));
    EXPECT_TRUE(scene.media.empty());
}

const std::string one_ball = "<shape type='sphere'/>";

TEST(MitsubaLights, StandWhereTheirTransformsPutThem) {
    const auto scene = read_mitsuba(
        one_ball +
        "<emitter type='point'><point name='position' value='1 2 3'/><rgb name='intensity' value='4'/></emitter>"
        "<emitter type='point'><transform name='toWorld'><translate y='9'/></transform></emitter>"
        "<emitter type='spot'><transform name='toWorld'><lookat origin='0 5 0' target='0 0 0' up='1 0 0'/></transform>"
        "<float name='cutoff_angle' value='40'/></emitter>"
        "<emitter type='directional'><vector name='direction' x='0' y='-2' z='0'/><rgb name='irradiance' "
        "value='3'/></emitter>");
    ASSERT_THAT(scene.lights, SizeIs(4));
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).position, (Vec3{1, 2, 3}));
    EXPECT_EQ(std::get<PointLight>(scene.lights[1]).position, (Vec3{0, 9, 0}));
    const auto& spot = std::get<SpotLight>(scene.lights[2]);
    EXPECT_EQ(spot.axis, (Vec3{0, -1, 0}));
    EXPECT_FLOAT_EQ(spot.outer, 40 * degrees);
    EXPECT_FLOAT_EQ(spot.inner, 30 * degrees);
    EXPECT_EQ(spot.falloff, SpotLight::Falloff::linear);
    EXPECT_EQ(std::get<DirectionalLight>(scene.lights[3]).direction, (Vec3{0, -1, 0}));
}

TEST(MitsubaEnvironments, HaveTheirMiddleAtPlusZ) {
    const std::string map =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + std::string("\x80\x80\x80\x81\x80\x80\x80\x81", 8);
    const auto scene = read_mitsuba(
        one_ball +
            "<emitter type='envmap'><string name='filename' value='e.hdr'/><float name='scale' value='2'/></emitter>",
        {{"e.hdr", map}});
    ASSERT_THAT(scene.environments, SizeIs(1));
    EXPECT_EQ(scene.environments[0].radiance, (Rgb{2, 2, 2}));
    const Vec3 middle = transform_direction(scene.environments[0].to_world, {0, 0, -1});
    EXPECT_EQ(middle, (Vec3{0, 0, 1}));
    const Vec3 right = transform_direction(scene.environments[0].to_world, {1, 0, 0});
    EXPECT_EQ(right, (Vec3{-1, 0, 0}));
}

TEST(MitsubaMerge, IsWhatItConsistsOf) {
    const std::string parts =
        "<shape type='merge' id='m'><shape type='cube'/><shape type='merge'><shape "
        "type='sphere'/></shape></shape>";
    const auto scene = read_mitsuba(parts);
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_TRUE(std::holds_alternative<Sphere>(scene.shapes[1].geometry));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("merge")));
    const auto grouped = read_mitsuba("<shape type='shapegroup' id='g'>" + parts +
                                      "</shape><shape type='instance'><ref id='g'/></shape>");
    EXPECT_EQ(grouped.objects.at(0).shapes.size(), 2u);
    EXPECT_THAT(errors_of_mitsuba("<shape type='merge' id='m'><shape type='cube'/><ref id='m'/></shape>"),
                HasSubstr("merged too deeply"));
}

const std::string lamp = "<emitter type='area'><rgb name='radiance' value='3'/></emitter>";

std::string masked(const std::string& opacity) {
    return "<bsdf type='mask'>" + opacity + "<bsdf type='diffuse'/></bsdf>";
}

// there, emission does not ask what the bsdf lets through
TEST(MitsubaLamps, ShineAlsoWhereTheirSurfaceIsNotThere) {
    const auto with = [](const std::string& bsdf) {
        return read_mitsuba("<shape type='sphere'>" + bsdf + lamp + "</shape>");
    };
    const auto half = with(masked("<float name='opacity' value='.5'/>"));
    EXPECT_EQ(half.shapes[0].emission.value().radiance, (Rgb{6, 6, 6}));
    for (const std::string& bsdf : {std::string("<bsdf type='null'/>"), masked("<float name='opacity' value='0'/>")}) {
        const auto scene = with(bsdf);
        EXPECT_EQ(scene.shapes[0].emission.value().radiance, (Rgb{3, 3, 3}));
        EXPECT_TRUE(scene.shapes[0].emission->unseen);
        EXPECT_EQ(colour_of(scene, scene.materials[scene.shapes[0].material].opacity.value()), (Rgb{0, 0, 0}));
        EXPECT_THAT(warnings_of(scene), HasSubstr("shines, but the picture does not show the lamp itself"));
    }
    EXPECT_THAT(warnings_of(with(masked("<texture type='checkerboard' name='opacity'/>"))),
                HasSubstr("the lamp is left out where 'mask'"));
    EXPECT_THAT(warnings_of(with("<bsdf type='null'/><medium name='interior' type='homogeneous'/>")),
                HasSubstr("only bounds a medium is left out: it is dark"));
    EXPECT_THAT(warnings_of(with("")), Not(HasSubstr("lamp")));
}

TEST(MitsubaOlderShapes, NameMaterialsOfObjThatAreLeftOut) {
    const auto with = [](const std::string& version, const std::string& more) {
        return warnings_of(read_as("s.xml",
                                   "<scene version='" + version +
                                       "'><shape type='obj'><string name='filename' "
                                       "value='a.obj'/>" +
                                       more + "</shape></scene>",
                                   {{"a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"}}));
    };
    const auto named = HasSubstr("the materials that 'a.obj' names are left out: it is grey");
    EXPECT_THAT(with("0.6.0", ""), named);
    EXPECT_THAT(with("0.6.0", "<bsdf type='plastic'/>"), Not(named));
    EXPECT_THAT(with("0.6.0", "<boolean name='loadMaterials' value='false'/>"), Not(named));
    EXPECT_THAT(with("3.0.0", ""), Not(named));
}

}  // namespace
}  // namespace lightnet::test::mitsuba_shapes_reader_test
