// Cages of OBJ files: smooth surfaces, their creases, borders, materials and limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/readers/read_scene.hpp"
#include "tests/support/obj_text.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::obj_subdivision_reader_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

const std::string cube =
    "o box\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

SceneData cage(const std::string& text, const std::string& object = "*", const std::string& levels = "3",
               const std::string& name = "a.obj") {
    MemoryFiles files;
    files.add(name, text);
    return read_scene(files, name, {{std::string(subdivision_constant) + object, levels}});
}

template <class Read>
std::string error_of(const Read& read) {
    try {
        read();
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

float largest(const Mesh& mesh) {
    float most = 0;
    for (const Vec3 p : mesh.positions) most = std::max(most, length(p));
    return most;
}

TEST(ObjCage, IsSmooth) {
    const auto scene = cage(cube);
    ASSERT_THAT(scene.shapes, SizeIs(1));
    const Mesh& mesh = mesh_of(scene);
    EXPECT_THAT(mesh.triangles, SizeIs(6 * 64 * 2));
    EXPECT_THAT(mesh.positions, SizeIs(6 * 64 + 2));  // closed: V = F + 2 of quadrilaterals
    ASSERT_THAT(mesh.normals, SizeIs(mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_GT(dot(mesh.normals[i], mesh.positions[i]), 0.95f * length(mesh.normals[i]) * length(mesh.positions[i]));
    // the limit of a corner, of valence n: n² times itself, 4 times its neighbours, once what is across (Halstead et
    // al.)
    const float corner = (9 * 1.0f + 4 * 3 * (1.0f / 3) + 3 * (-1.0f / 3)) / (9 + 12 + 3);
    EXPECT_NEAR(largest(mesh), corner * std::sqrt(3.0f), 1e-5f);
}

TEST(ObjCage, EndsWhereMoreSubdivisionsWould) {
    const auto coarse = cage(cube, "box", "1"), fine = cage(cube, "box", "4");
    EXPECT_NEAR(largest(mesh_of(coarse)), largest(mesh_of(fine)), 1e-5f);
}

TEST(ObjCage, HasTheCreasesThatTagsName) {
    std::string sharp = cube;  // the square below, in one plane for ever
    for (const char* edge : {"0 1", "1 2", "2 3", "3 0"}) sharp += std::string("t crease 2/1/0 ") + edge + " 10\n";
    const auto scene = read_as("a.obj", sharp);
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("left out")));
    const Mesh& mesh = mesh_of(scene);
    EXPECT_THAT(mesh.triangles, SizeIs(6 * 64 * 2));  // tags alone say that it is a cage
    std::size_t below = 0, up = 0, aside = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (std::fabs(mesh.positions[i].z + 1) < 1e-6f) {
            ++below;
            const Vec3 n = mesh.normals[i] / length(mesh.normals[i]);
            (n.z < -0.999f ? up : aside) += 1;
        }
    EXPECT_EQ(up, 81u);     // 9 × 9 vertices of the square
    EXPECT_EQ(aside, 32u);  // and those along its edges once more, for the sides
    EXPECT_EQ(below, up + aside);
}

TEST(ObjCage, IsLessSharpWithLessSharpness) {
    const auto with = [](const std::string& sharpness) {
        return largest(mesh_of(read_as("a.obj", cube + "t corner 1/1/0 6 " + sharpness + "\n")));
    };
    EXPECT_LT(with("0"), with("1"));
    EXPECT_LT(with("1"), with("2"));
    EXPECT_LT(with("2"), with("10"));
    EXPECT_FLOAT_EQ(with("10"), std::sqrt(3.0f));
}

TEST(ObjCage, HasBordersAsTagsSay) {
    const auto corner = [](const std::string& tag) {
        const auto scene = cage(square + tag);
        float most = 0;
        for (const Vec3 p : mesh_of(scene).positions) most = std::max(most, p.x + p.y);
        return most;
    };
    EXPECT_FLOAT_EQ(corner("t interpolateboundary 1/0/0 1\n"), 2);
    EXPECT_LT(corner("t interpolateboundary 1/0/0 2\n"), 1.8f);
    EXPECT_EQ(corner(""), corner("t interpolateboundary 1/0/0 2\n"));
}

TEST(ObjCage, KeepsMaterialsHolesAndTextureCoordinates) {
    const std::string two =
        "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "usemtl a\nf 1/1 2/2 5/3 4/4\nusemtl b\nf 2/1 3/2 6/3 5/4\n";
    const auto scene = cage(two, "*", "2");
    ASSERT_THAT(scene.shapes, SizeIs(2));
    for (std::size_t i = 0; i < 2; ++i) {
        const Mesh& mesh = mesh_of(scene, i);
        EXPECT_THAT(mesh.triangles, SizeIs(32));
        EXPECT_THAT(mesh.positions, SizeIs(25));
        ASSERT_THAT(mesh.uvs, SizeIs(25));
        const auto [least, most] = std::ranges::minmax_element(mesh.uvs, {}, &Vec2::x);
        EXPECT_EQ(least->x, 0);  // the pieces meet, their coordinates don't
        EXPECT_EQ(most->x, 1);
    }
    EXPECT_THAT(cage(two + "t hole 1/0/0 1\n", "*", "2").shapes, SizeIs(1));
}

TEST(ObjCage, IsWhatANameSays) {
    const auto scene = cage(cube + "o floor\nf 1 2 6 5\n", "b*", "1");
    ASSERT_THAT(scene.shapes, SizeIs(2));
    EXPECT_THAT(mesh_of(scene, 0).triangles, SizeIs(2));  // the floor, as it is
    EXPECT_THAT(mesh_of(scene, 1).triangles, SizeIs(48));
    EXPECT_THAT(mesh_of(cage(cube + "t corner 1/1/0 6 1\n", "box", "0")).triangles, SizeIs(12));
}

TEST(ObjCage, MayNameVerticesThatComeLater) {
    const auto scene = cage("f 1 2 3 4\n" + square, "*", "1");
    EXPECT_THAT(mesh_of(scene).triangles, SizeIs(16));
}

TEST(ObjCage, TellsWhatIsWrong) {
    EXPECT_THAT(error_of([] { cage(cube, "bax"); }), HasSubstr("no object is called 'bax' (did you mean 'box'?)"));
    EXPECT_THAT(error_of([] { cage(cube, "box", "9"); }), HasSubstr("must be a whole number from 0 to 8, not 9"));
    EXPECT_THAT(error_of([] { cage("ply\n", "*", "2", "a.ply"); }), HasSubstr("is of '.obj' files"));
    EXPECT_THAT(warnings_of(read_as("a.obj", cube + "t crease 2/1/0 0 6 2\n")), HasSubstr("edges that no face has"));
    EXPECT_THAT(warnings_of(read_as("a.obj", cube + "t smoothtriangles 0/0/1 smooth\n")),
                HasSubstr("tag 'smoothtriangles'"));
    const auto strange = read_as("a.obj", cube + "t something else\n");
    EXPECT_THAT(warnings_of(strange), HasSubstr("tag 'something' is left out"));
    EXPECT_THAT(mesh_of(strange).triangles, SizeIs(12)) << "it says nothing of faces";
    EXPECT_THAT(error_of([] { read_as("a.obj", cube + "t crease 2/1/0 0\n"); }),
                HasSubstr("as many numbers as it says"));
    EXPECT_THAT(warnings_of(cage(cube + "f 1 2 1\n")), HasSubstr("name a vertex twice"));
}

TEST(ObjCage, RefusesMoreThanItHasRoomFor) {
    std::string many = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    for (int i = 0; i < 70; ++i) many += "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf -4 -3 -2 -1\n";
    EXPECT_THAT(error_of([&] { cage(many, "*", "8"); }), HasSubstr("more than 8388608 triangles"));
}

}  // namespace
}  // namespace lightnet::test::obj_subdivision_reader_test
