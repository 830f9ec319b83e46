// Heights that pbrt's meshes are moved by, and grids that Mitsuba's shapes are made of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/readers/common/split_edges.hpp"
#include "tests/support/closed_mesh.hpp"
#include "tests/support/pbrt_text.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::relief_reader_test {
namespace {

using testing::HasSubstr;

std::string ply(const std::string& properties, const std::vector<std::vector<float>>& vertices,
                const std::vector<std::string>& faces) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices.size()) + "\n";
    for (const char name : properties) text += std::string("property float ") + name + "\n";
    text += "element face " + std::to_string(faces.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& vertex : vertices) {
        for (const float number : vertex) text += std::to_string(number) + " ";
        text += "\n";
    }
    for (const auto& face : faces) text += face + "\n";
    return text;
}

// The unit square, its texture coordinates being its own.
const std::string square =
    ply("xyzuv", {{0, 0, 0, 0, 0}, {1, 0, 0, 1, 0}, {1, 1, 0, 1, 1}, {0, 1, 0, 0, 1}}, {"4 0 1 2 3"});
// Each vertex has its place as its normal.
const std::string octahedron = [] {
    std::vector<std::vector<float>> vertices;
    for (const float side : {1.f, -1.f})
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<float> vertex(8, 0.f);
            vertex[axis] = vertex[axis + 3] = side;
            vertices.push_back(std::move(vertex));
        }
    return ply("xyzabcuv", vertices,
               {"3 0 1 2", "3 1 3 2", "3 3 4 2", "3 4 0 2", "3 1 0 5", "3 3 1 5", "3 4 3 5", "3 0 4 5"});
}();

std::string with_normals(std::string text) {
    for (const auto& [from, to] : {std::pair{"float a", "float nx"}, {"float b", "float ny"}, {"float c", "float nz"}})
        text.replace(text.find(from), 7, to);
    return text;
}

std::string relief(const std::string& texture, const std::string& edge, const std::string& before = "") {
    return "Texture \"d\" \"float\" " + texture + "\n" + before +
           "Shape \"plymesh\" \"string filename\" \"m.ply\" \"texture displacement\" \"d\" \"float edgelength\" " +
           edge;
}

Mesh raised(const std::string& mesh, const std::string& statements) {
    const auto scene = read_world(statements, {{"m.ply", mesh}});
    EXPECT_EQ(warnings_of(scene).find("displacement"), std::string::npos) << warnings_of(scene);
    return mesh_of(scene);
}

double area_of(const Mesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum += 0.5 * double{length(cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                         mesh.positions[t[2]] - mesh.positions[t[0]]))};
    return sum;
}

TEST(SplitEdges, EndsWhenAllAreShorter) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
    mesh.triangles = {{0, 1, 2}};
    Matrix doubled;
    for (std::size_t i = 0; i < 3; ++i) doubled.m[i][i] = 2;
    ASSERT_TRUE(split_edges(mesh, doubled, 0.5f, 1000));
    EXPECT_LT(longest_edge(mesh), 0.25f) << "0.5 in the world";
    EXPECT_NEAR(area_of(mesh), 0.5, 1e-6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_EQ(mesh.positions[i].x, mesh.uvs[i].x);
        EXPECT_EQ(mesh.positions[i].y, mesh.uvs[i].y);
    }
    EXPECT_FALSE(split_edges(mesh, doubled, 1e-4f, 1000));
}

TEST(PbrtDisplacement, LiftsASquare) {
    const Mesh mesh = raised(square, relief("\"constant\" \"float value\" 0.25", "0.2"));
    EXPECT_LT(longest_edge(mesh), 0.2f);
    EXPECT_NEAR(area_of(mesh), 1, 1e-5);
    for (const Vec3 p : mesh.positions) EXPECT_EQ(p.z, 0.25f);
    for (const Vec3 n : mesh.normals) EXPECT_NEAR(n.z, 1, 1e-6f);
    EXPECT_EQ(mesh.uvs.size(), mesh.positions.size());
}

TEST(PbrtDisplacement, IsWhatTheTextureSaysAtEachVertex) {
    const std::string steps =
        "\"checkerboard\" \"float uscale\" 2 \"float vscale\" 1 \"float tex1\" 0.5 \"float tex2\" -0.25";
    const Mesh mesh = raised(square, relief(steps, "0.1", "Scale 3 3 3\n"));
    std::size_t high = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (mesh.uvs[i].x == 1 || mesh.uvs[i].y == 1) continue;  // where the pattern begins anew
        high += mesh.uvs[i].x < 0.5f;
        EXPECT_NEAR(mesh.positions[i].z, mesh.uvs[i].x < 0.5f ? 1.5f : -0.75f, 1e-6f) << "three times as high";
    }
    EXPECT_GT(high, 100u);
}

TEST(PbrtDisplacement, LeavesAClosedMeshClosed) {
    const Mesh mesh = raised(with_normals(octahedron), relief("\"constant\" \"float value\" 0.5", "0.3"));
    EXPECT_EQ(open_edges(mesh), 0u);
    EXPECT_GT(mesh.triangles.size(), 100u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(length(mesh.positions[i]), 1.5f, 1e-6f);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_GE(length(mesh.positions[i]), 0.5f + 1 / std::sqrt(3.0f) - 0.02f);
        EXPECT_GT(dot(mesh.normals[i], mesh.positions[i]), 0) << "outwards";
    }
}

TEST(PbrtDisplacement, SaysWhatItCanNotDo) {
    const auto wrong = [](const std::string& mesh, const std::string& statements) {
        return errors_of_world(statements, {{"m.ply", mesh}});
    };
    const std::string even = "\"constant\" \"float value\" 1";
    EXPECT_THAT(wrong(square, relief(even, "0")), HasSubstr("'edgelength' must be above 0"));
    EXPECT_THAT(wrong(square, relief(even, "0.00001")), HasSubstr("would make more than 2^24 triangles"));
    EXPECT_THAT(wrong(ply("xyz", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {"3 0 1 2"}), relief(even, "1")),
                HasSubstr("displacement needs texture coordinates"));
}

// ---- Mitsuba ----

SceneData shape_of(const std::string& shape, MemoryFiles files) {
    return read_mitsuba("<emitter type='constant'/>" + shape, std::move(files));
}

// Rows from below, as the format has them.
std::string heights(const std::vector<float>& numbers, int columns, int rows) {
    std::string text = "Pf\n" + std::to_string(columns) + " " + std::to_string(rows) + "\n-1\n";
    for (const float number : numbers) text += raw(number);
    return text;
}

TEST(MitsubaHeightField, HasTheFirstRowOfItsPictureInFront) {
    const MemoryFiles files{{"h.pfm", heights({4, 5, 6, 1, 2, 3}, 3, 2)}};
    const auto scene = shape_of(
        "<shape type='heightfield'><string name='filename' value='h.pfm'/><float name='scale' value='0.5'/></shape>",
        files);
    const Mesh& mesh = mesh_of(scene);
    ASSERT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.triangles.size(), 4u);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(mesh.positions[i].x, float(i % 3) - 1);
        EXPECT_EQ(mesh.positions[i].y, i < 3 ? -1.f : 1.f);
        EXPECT_NEAR(mesh.positions[i].z, 0.5f * float(i + 1), 1e-5f);
        EXPECT_EQ(mesh.uvs[i].y, i < 3 ? 1.f : 0.f) << "v goes down";
        EXPECT_GT(mesh.normals[i].z, 0);
    }
    EXPECT_THAT(warnings_of(scene), HasSubstr("cut into triangles"));
    const auto nested = shape_of(
        "<shape type='heightfield'><texture type='bitmap'><string name='filename' value='h.pfm'/></texture>"
        "<boolean name='shadingNormals' value='false'/></shape>",
        files);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(mesh_of(nested).positions[i].z, float(i + 1), 1e-4f);
    EXPECT_TRUE(mesh_of(nested).normals.empty());
}

TEST(MitsubaHeightField, SaysWhatItLacks) {
    EXPECT_THAT(errors_of_mitsuba("<emitter type='constant'/><shape type='heightfield'/>"),
                HasSubstr("needs a 'filename' or one texture"));
    EXPECT_THAT(errors_of_mitsuba("<emitter type='constant'/><shape type='heightfield'><texture type='checkerboard'/>"
                                  "</shape>"),
                HasSubstr("needs a 'width' and a 'height'"));
}

template <class Distance>
std::string distances(std::uint32_t points, const Distance& distance) {
    std::string text = "VOL\3" + raw(1u) + raw(points) + raw(points) + raw(points) + raw(1u);
    for (const float side : {0.f, 0.f, 0.f, 1.f, 1.f, 1.f}) text += raw(side);
    for (std::uint32_t z = 0; z < points; ++z)
        for (std::uint32_t y = 0; y < points; ++y)
            for (std::uint32_t x = 0; x < points; ++x)
                text += raw(float(distance(Vec3{float(x), float(y), float(z)} / float(points - 1))));
    return text;
}

const std::string grid = "<shape type='sdfgrid'><string name='filename' value='d.vol'/></shape>";

// Between points at a distance h the distance to a ball is off by h² / 8R at most along an edge of a cell, and by three
// times that along its diagonal.
TEST(MitsubaSdfGrid, OfABallIsABall) {
    constexpr float radius = 0.3f, step = 1.0f / 32;
    const auto scene = shape_of(grid, {{"d.vol", distances(33, [](Vec3 p) {
                                            return length(p - Vec3{0.5f, 0.5f, 0.5f}) - radius;
                                        })}});
    const Mesh& mesh = mesh_of(scene);
    EXPECT_EQ(open_edges(mesh), 0u);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 out = mesh.positions[i] - Vec3{0.5f, 0.5f, 0.5f};
        ASSERT_NEAR(length(out), radius, 3 * step * step / (8 * radius) + 1e-6f);
        ASSERT_GT(dot(normalize(out), mesh.normals[i]), 0.995f);
    }
    EXPECT_NEAR(area_of(mesh), 4 * std::numbers::pi * radius * radius, 0.01 * 4 * std::numbers::pi * radius * radius);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [first, second, third] = mesh.triangles[t];
        const Vec3 a = mesh.positions[first], twice_area = cross(mesh.positions[second] - a, mesh.positions[third] - a);
        if (length(twice_area) < 1e-6f) continue;
        ASSERT_GT(dot(normal_of(mesh, t), a - Vec3{0.5f, 0.5f, 0.5f}), 0);
    }
    EXPECT_THAT(warnings_of(scene), HasSubstr("cut into triangles"));
}

TEST(MitsubaSdfGrid, OfAPlaneIsAPlane) {
    const auto scene = shape_of(
        "<shape type='sdfgrid'><string name='filename' value='d.vol'/><transform name='to_world'><scale "
        "value='2'/></transform></shape>",
        {{"d.vol", distances(5, [](Vec3 p) { return p.z - 0.4f; })}});
    for (const Vec3 p : mesh_of(scene).positions) EXPECT_NEAR(p.z, 0.8f, 1e-6f);
    for (const Vec3 n : mesh_of(scene).normals) EXPECT_NEAR(n.z, 1, 1e-6f);
    EXPECT_NEAR(area_of(mesh_of(scene)), 4, 1e-4);
}

TEST(MitsubaSdfGrid, SaysWhatItLacks) {
    const auto wrong = [](const std::string& bytes) {
        return errors_of_mitsuba("<emitter type='constant'/>" + grid, {{"d.vol", bytes}});
    };
    EXPECT_THAT(wrong(distances(5, [](Vec3) { return 1; })), HasSubstr("it has no surface"));
    EXPECT_THAT(wrong(distances(1, [](Vec3) { return 1; })), HasSubstr("2 × 2 × 2 points or more"));
    EXPECT_THAT(wrong("VOL"), HasSubstr("the file ends early"));
    EXPECT_THAT(wrong(distances(2, [](Vec3) { return NAN; })), HasSubstr("a number is not finite"));
}

}  // namespace
}  // namespace lightnet::test::relief_reader_test
