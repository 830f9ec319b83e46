// pbrt's shapes and lights: where they are, which side is which, how bright they shine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <numbers>

#include "core/base/unwanted.hpp"
#include "core/readers/pbrt/subdivision.hpp"
#include "core/scene/shapes/placed_quadric.hpp"
#include "tests/support/pbrt_text.hpp"

namespace lightnet::test::pbrt_shapes_reader_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr float pi = std::numbers::pi_v<float>;

void expect_near(Vec3 a, Vec3 b) {
    EXPECT_NEAR(a.x, b.x, 1e-5f);
    EXPECT_NEAR(a.y, b.y, 1e-5f);
    EXPECT_NEAR(a.z, b.z, 1e-5f);
}

double area_of(const Mesh& mesh) {
    double area = 0;
    for (const auto& t : mesh.triangles)
        area += 0.5 *
                length(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]));
    return area;
}

TEST(PbrtNormals, OfATriangleFollowTheOrderOfItsCorners) {
    expect_near(normal_of(mesh_of(read_world(triangle))), {0, 0, 1});
}

TEST(PbrtTangents, TurnWithTheirMesh) {
    const std::string corners = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"vector3 S\" ";
    const auto scene = read_world("Rotate 90 0 0 1 Scale 2 2 2 " + corners + "[ 1 0 0 1 0 0 0 1 0 ]");
    ASSERT_THAT(mesh_of(scene).tangents, SizeIs(3));
    expect_near(mesh_of(scene).tangents[0].along, {0, 1, 0});
    expect_near(mesh_of(scene).tangents[2].along, {-1, 0, 0});
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_THAT(errors_of_world(corners + "[ 1 0 0 ]"), HasSubstr("there are 1 'S' for 3 vertices"));
}

TEST(PbrtNormals, AreTurnedByReverseOrientation) {
    expect_near(normal_of(mesh_of(read_world("ReverseOrientation " + triangle))), {0, 0, -1});
}

TEST(PbrtNormals, KeepTheirSideInAMirror) {
    // mirrored, the corners run the other way round; pbrt turns the normal back
    expect_near(normal_of(mesh_of(read_world("Scale -1 1 1 " + triangle))), {0, 0, 1});
    expect_near(normal_of(mesh_of(read_world("ReverseOrientation Scale -1 1 1 " + triangle))), {0, 0, -1});
}

TEST(PbrtNormals, FollowTheShadingNormals) {
    const std::string against =
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"normal N\" [ 0 0 -1 0 0 -1 0 0 -1 ]\n";
    const auto scene =
        read_world(against + "AttributeBegin ReverseOrientation " + against + "AttributeEnd Scale -1 1 1 " + against);
    expect_near(normal_of(mesh_of(scene, 0)), {0, 0, -1});
    expect_near(mesh_of(scene, 0).normals[0], {0, 0, -1});
    expect_near(normal_of(mesh_of(scene, 1)), {0, 0, 1});
    expect_near(mesh_of(scene, 1).normals[0], {0, 0, 1});
    expect_near(normal_of(mesh_of(scene, 2)), {0, 0, -1});
}

TEST(PbrtNormals, GoByTheInverseTranspose) {
    const auto scene = read_world(
        "Scale 2 1 1 Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 -1 0 0 0 1 ] \"normal N\" [ 1 1 0 1 1 0 1 1 0 ]");
    const float s = 1 / std::sqrt(5.0f);
    expect_near(mesh_of(scene).normals[0], {s, 2 * s, 0});
}

TEST(PbrtNormals, ThatAreZeroAreReplaced) {
    const auto scene =
        read_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"normal N\" [ 0 0 0 0 0 1 0 0 1 ]");
    expect_near(mesh_of(scene).normals[0], {0, 0, 1});
}

TEST(PbrtMeshes, HaveTextureCoordinates) {
    const auto scene =
        read_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"point2 uv\" [ 0 0 1 0 0 1 ]");
    EXPECT_THAT(mesh_of(scene).uvs, ElementsAre(Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}));
}

TEST(PbrtMeshes, MayBeInPlyFiles) {
    const MemoryFiles files{{"m/a.ply",
                             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                             "end_header\n0 0 0 1 0 0 0 1 0 3 0 1 2"}};
    expect_near(
        mesh_of(read_world("Translate 0 0 4 Shape \"plymesh\" \"string filename\" \"m/a.ply\"", files)).positions[2],
        {0, 1, 4});
}

TEST(PbrtPatches, AreTwoTrianglesEach) {
    const auto scene = read_world("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]");
    ASSERT_THAT(mesh_of(scene).triangles, SizeIs(2));
    EXPECT_NEAR(area_of(mesh_of(scene)), 1, 1e-6);
    expect_near(normal_of(mesh_of(scene), 0), {0, 0, 1});
    expect_near(normal_of(mesh_of(scene), 1), {0, 0, 1});
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtPatches, ThatAreBentAreCutIntoMore) {
    const auto scene = read_world("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 1 ]");
    EXPECT_THAT(warnings_of(scene), HasSubstr("scene.pbrt:2: Shape 'bilinearmesh': a bilinear patch that is bent"));
    const Mesh& mesh = mesh_of(scene);
    EXPECT_THAT(mesh.triangles, SizeIs(128));
    for (std::size_t i = 4; i < mesh.positions.size(); ++i)  // the surface is z = x y
        EXPECT_NEAR(mesh.positions[i].z, mesh.positions[i].x * mesh.positions[i].y, 1e-6f);
}

// Any level ends on the same surface: an octahedron's corner (valence 4) goes where the mask of the limit says.
TEST(PbrtSubdivision, EndsOnTheLimitSurface) {
    const std::string octahedron =
        "\"integer indices\" [ 0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5 ]\n"
        "\"point3 P\" [ 1 0 0 -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1 ]";
    for (const int levels : {0, 1, 3}) {
        const auto scene =
            read_world("Shape \"loopsubdiv\" \"integer levels\" " + std::to_string(levels) + " " + octahedron);
        const Mesh& mesh = mesh_of(scene);
        EXPECT_EQ(mesh.triangles.size(), 8u << (2 * levels));
        // β = 3/32, so the neighbours' share is 4 / (4 + 4) and they cancel out
        expect_near(mesh.positions[4], {0, 0, 0.5f});
        expect_near(mesh.normals[4], {0, 0, -1});  // as in pbrt: against the order of vertices
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) EXPECT_LT(dot(mesh.positions[i], mesh.normals[i]), 0);
        EXPECT_THAT(scene.warnings, IsEmpty());
    }
}

TEST(PbrtSubdivision, EndsWhenNobodyWantsItAnyMore) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const std::atomic<bool> unwanted = true;
    const LookingAt looking(&unwanted);
    EXPECT_THROW(pbrt::subdivide(mesh, 12), Cancelled);
}

TEST(PbrtSubdivision, KeepsBoundariesWhereTheyAre) {
    const auto scene = read_world(
        "Shape \"loopsubdiv\" \"integer levels\" 2 \"integer indices\" [ 0 1 2 0 2 3 ]\n"
        "\"point3 P\" [ 0 0 0  1 0 0  1 1 0  0 1 0 ]");
    for (const Vec3& p : mesh_of(scene).positions) EXPECT_EQ(p.z, 0);
    expect_near(normal_of(mesh_of(scene)), {0, 0, -1});
    EXPECT_THAT(
        errors_of_world("Shape \"loopsubdiv\" \"integer levels\" 30 \"integer indices\" [ 0 1 2 ] \"point3 P\" [ 0 0 "
                        "0 1 0 0 0 1 0 ]"),
        HasSubstr("30 levels of subdivision would make more than 2^24 triangles"));
}

TEST(PbrtSpheres, AreScaledAndMoved) {
    const auto scene = read_world("Translate 1 2 3 Scale 2 2 2 Rotate 30 1 1 0 Shape \"sphere\" \"float radius\" 1.5");
    expect_near(sphere_of(scene).center, {1, 2, 3});
    EXPECT_NEAR(sphere_of(scene).radius, 3, 1e-5f);
    EXPECT_FALSE(sphere_of(scene).flip_normals);
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(PbrtSpheres, AreTurnedInsideOutByAMirrorAsInPbrt) {
    EXPECT_TRUE(sphere_of(read_world("Scale 1 1 -1 " + ball)).flip_normals);
    EXPECT_FALSE(sphere_of(read_world("ReverseOrientation Scale 1 1 -1 " + ball)).flip_normals);
}

/// Where the point of that name lies, and its normal.
std::pair<Vec3, Vec3> place_of(const Quadric& shape, Vec3 own) {
    const PlacedQuadric placed(shape);
    return {placed.position(own), placed.normal(own)};
}

TEST(PbrtSpheres, AreQuadricsWhereTheyAreStretchedOrCut) {
    const auto scene =
        read_world("AttributeBegin Scale 1 1 2 " + ball + "AttributeEnd Shape \"sphere\" \"float zmin\" 0");
    EXPECT_EQ(warnings_of(scene), "");
    EXPECT_NEAR(PlacedQuadric(quadric_of(scene, 1)).area(), 2 * pi, 1e-4);
    const auto [top, up] = place_of(quadric_of(scene, 0), {0, 0, 1});
    EXPECT_FLOAT_EQ(top.z, 2 * place_of(quadric_of(scene, 0), {1, 0, 0}).first.x);
    expect_near(up, {0, 0, 1});
    EXPECT_EQ(quadric_of(scene, 1).low, 0);
    EXPECT_EQ(quadric_of(scene, 1).high, 1);
    EXPECT_TRUE(quadric_of(read_world("Scale 1 1 -2 " + ball)).flip_normals);
}

TEST(PbrtDisks, KeepTheirAreaAndFaceUp) {
    const auto scene =
        read_world("Shape \"disk\" \"float radius\" 2 \"float height\" 3 Shape \"disk\" \"float innerradius\" 0.5");
    EXPECT_EQ(warnings_of(scene), "");
    EXPECT_NEAR(PlacedQuadric(quadric_of(scene, 0)).area(), 4 * pi, 1e-4);
    EXPECT_NEAR(PlacedQuadric(quadric_of(scene, 1)).area(), 0.75 * pi, 1e-4);
    const auto [rim, up] = place_of(quadric_of(scene, 0), {1, 0, 0});
    expect_near(rim, {2, 0, 3});
    expect_near(up, {0, 0, 1});
    EXPECT_EQ(quadric_of(scene, 0).to_uv[1][1], 1);
}

TEST(PbrtDisks, OfNoExtentAreLeftOut) {
    const auto scene = read_world("Shape \"disk\" \"float innerradius\" 1 Shape \"cylinder\" \"float zmin\" 1");
    EXPECT_TRUE(scene.shapes.empty());
    EXPECT_THAT(warnings_of(scene), HasSubstr("has no extent"));
}

TEST(PbrtCylinders, HaveNormalsOutwards) {
    const auto scene = read_world("Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 0 \"float zmax\" 3");
    EXPECT_EQ(warnings_of(scene), "");
    EXPECT_NEAR(PlacedQuadric(quadric_of(scene)).area(), 12 * pi, 1e-3);
    const auto [at, normal] = place_of(quadric_of(scene), {0, 1, 1});
    expect_near(at, {0, 2, 3});
    expect_near(normal, {0, 1, 0});
}

Rgb lamp(const std::string& parameters, const std::string& shape = ball) {
    return read_world("AreaLightSource \"diffuse\" " + parameters + "\n" + shape)
        .shapes.at(0)
        .emission.value()
        .radiance;
}

TEST(PbrtLamps, ShineAsTheirNumbersSay) {
    EXPECT_EQ(lamp("\"rgb L\" [ 1 2 3 ]"), (Rgb{1, 2, 3}));
    EXPECT_EQ(lamp("\"rgb L\" [ 1 2 3 ] \"float scale\" 10"), (Rgb{10, 20, 30}));
    EXPECT_EQ(lamp(""), (Rgb{1, 1, 1}));
    EXPECT_EQ(lamp("\"spectrum L\" \"stdillum-D65\" \"float scale\" 4"), (Rgb{4, 4, 4}));
}

TEST(PbrtLamps, OfASpectrumHaveLuminanceOne) {
    EXPECT_NEAR(luminance(lamp("\"blackbody L\" 2700")), 1, 1e-5f);
    EXPECT_NEAR(luminance(lamp("\"spectrum L\" [ 400 0 500 8 600 15.6 700 18.4 ] \"float scale\" 3")), 3, 1e-5f);
}

TEST(PbrtLamps, MayShineOnBothSides) {
    EXPECT_FALSE(read_world("AreaLightSource \"diffuse\" " + ball).shapes[0].emission->two_sided);
    EXPECT_TRUE(read_world("AreaLightSource \"diffuse\" \"bool twosided\" true " + ball).shapes[0].emission->two_sided);
}

TEST(PbrtLamps, HaveThePowerThatIsAskedFor) {
    // a diffuse lamp of radiance L and area A sends out π A L
    EXPECT_NEAR(lamp("\"float power\" 100").r * 4 * pi * pi, 100, 1e-3);
    const std::string patch = "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  2 0 0  0 2 0  2 2 0 ]";
    EXPECT_NEAR(lamp("\"float power\" 100", patch).r * 4 * pi, 100, 1e-3);
    EXPECT_NEAR(lamp("\"float power\" 100 \"bool twosided\" true", patch).r * 8 * pi, 100, 1e-3);
}

TEST(PbrtLamps, OfAMeshHaveThatPowerInEachTriangleAsInPbrt) {
    const auto scene = read_world(
        "AreaLightSource \"diffuse\" \"float power\" 10\n"
        "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 1 3 ] \"point3 P\" [ 0 0 0  1 0 0  0 1 0  0 4 0 ]");
    ASSERT_THAT(scene.shapes, SizeIs(2));
    EXPECT_NEAR(scene.shapes[0].emission->radiance.r, 10 / (0.5f * pi), 1e-4f);
    EXPECT_NEAR(scene.shapes[1].emission->radiance.r, 10 / (2 * pi), 1e-4f);
}

TEST(PbrtLamps, DoNotShineInsideOfObjects) {
    const auto scene =
        read_world("ObjectBegin \"o\" AreaLightSource \"diffuse\" " + ball + "ObjectEnd ObjectInstance \"o\"");
    EXPECT_FALSE(scene.shapes.at(0).emission);
    EXPECT_THAT(warnings_of(scene), HasSubstr("lamps inside of an object don't shine"));
}

TEST(PbrtShapes, WithInterfacesOnlyAreLeftOut) {
    const auto scene =
        read_world("Material \"interface\" " + ball + ball + "NamedMaterial \"air\" " + ball +
                   "MakeNamedMaterial \"air\" \"string type\" \"interface\" Material \"diffuse\" " + ball);
    EXPECT_THAT(scene.shapes, SizeIs(1));
    EXPECT_THAT(warnings_of(scene), HasSubstr("is left out (3 times)"));
}

}  // namespace
}  // namespace lightnet::test::pbrt_shapes_reader_test
