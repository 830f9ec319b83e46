// OBJ with MTL, and PLY, alone as scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/readers/common/mesh_tools.hpp"
#include "tests/support/obj_text.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::obj_reader_test {
namespace {

using namespace obj_text;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

TEST(Obj, CountsFromBothEndsAndCutsPolygons) {
    const auto scene = read_as("a.obj", corners + "f 1 2 3 4\nf -4 -3 -2\nf 1//  2// 3//\n");
    ASSERT_THAT(scene.shapes, SizeIs(1));
    EXPECT_THAT(mesh_of(scene).triangles, SizeIs(4));
    EXPECT_EQ(normal_of(mesh_of(scene)), (Vec3{0, 0, 1}));
    EXPECT_THAT(mesh_of(scene).positions, SizeIs(4));  // shared
    EXPECT_FALSE(scene.camera_given);
    EXPECT_THAT(warnings_of(scene), HasSubstr("'--env'"));
    EXPECT_THAT(scene.environments, SizeIs(1));
}

TEST(Obj, JoinsLinesAndSkipsRemarks) {
    const auto scene =
        read_as("a.obj", "# a remark\r\nv 0 0 0 # here\r\nv 1 0 0\r\nv 1 \\\r\n1 0\r\nf 1 2 \\\r\n 3\r\n");
    EXPECT_EQ(mesh_of(scene).positions[2], (Vec3{1, 1, 0}));
}

TEST(Obj, MayHaveLinesThatEndAsOfOldMacs) {
    const auto scene = read_as("a.obj", "v 0 0 0\rv 1 0 0\r\nv 1 1 0\nv 0 1 0\rf 1 2 \\\r3 4\rf 1 2 3\r");
    EXPECT_THAT(mesh_of(scene).triangles, SizeIs(3));
}

TEST(Obj, MayHaveRemarksBehindNamesOfMaterials) {
    const auto scene = read_as("a.obj", "mtllib m.mtl # here\nusemtl a # and # b\n" + corners + "f 1 2 3 # there\n",
                               {{"m.mtl", "newmtl a\nKd 1 0 0\n"}});
    EXPECT_EQ(material_of(scene).name, "a");
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("grey is taken")));
}

TEST(Obj, CutsConcavePolygonsInside) {
    // an L: its area is 3, a fan's would be larger
    const auto scene = read_as("l.obj", "v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nf 4 5 6 1 2 3\n");
    const auto& mesh = mesh_of(scene);
    float area = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        area +=
            length(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]])) / 2;
        EXPECT_GT(normal_of(mesh, i).z, 0.99f);
    }
    EXPECT_FLOAT_EQ(area, 3);
}

TEST(Obj, SmoothsOnlyWhereItIsTold) {
    EXPECT_THAT(mesh_of(read_as("a.obj", corners + "f 1 2 3\n")).normals, IsEmpty());
    EXPECT_THAT(mesh_of(read_as("a.obj", corners + "s 1\nf 1 2 3\n")).normals, SizeIs(3));
    EXPECT_THAT(read_as("a.obj", corners + "s 1\nf 1 2 3\ns off\nf 2 3 4\n").shapes, SizeIs(2));
    const auto given = read_as("a.obj", corners + "vn 0 0 -1\nf 1//1 2//1 3//1\n");
    EXPECT_EQ(normal_of(mesh_of(given)), (Vec3{0, 0, -1}));  // the given ones say where outside is
}

TEST(Obj, TakesColoursOfVertices) {
    const auto scene = read_as("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nf 1 2 3\n");
    EXPECT_EQ(mesh_of(scene).colours[1], (Rgb{0, 1, 0}));
    const auto& texture = scene.textures[model_of<DiffuseMaterial>(scene).reflectance];
    EXPECT_TRUE(std::holds_alternative<VertexColour>(texture.pattern));
}

TEST(Obj, MayHaveColoursByXyz) {
    const auto colour = [](const std::string& statement) {
        const auto scene = with_material(statement);
        const auto& texture = scene.textures[model_of<DiffuseMaterial>(scene).reflectance];
        return texture.scale;
    };
    const Rgb grey = colour("Kd xyz 0.475235 0.5 0.544415\n");
    for (const float channel : {grey.r, grey.g, grey.b}) EXPECT_NEAR(channel, .5f, 1e-4);
    EXPECT_THAT(warnings_of(with_material("Kd xyz 0 0.5 0\n")), HasSubstr("outside of what sRGB can show"));
}

TEST(Obj, MayNameVerticesThatComeLater) {
    const auto scene =
        read_as("a.obj",
                "usemtl red\nf 1/1/1 2/2/1 3/3/1\nusemtl blue\nv 9 9 9\nf 4 3 -1\nusemtl green\nf 2 3 4\n"
                "v 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n");
    ASSERT_EQ(scene.shapes.size(), 3u);
    const auto shape = [&](const std::string& material) {
        for (const auto& one : scene.shapes)
            if (scene.materials[one.material].name == material) return std::get<Mesh>(one.geometry);
        return Mesh{};
    };
    EXPECT_EQ(shape("red").positions, (std::vector<Vec3>{{9, 9, 9}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(shape("red").normals[0], (Vec3{0, 0, 1}));
    EXPECT_EQ(shape("red").uvs[1], (Vec2{1, 0}));
    EXPECT_EQ(shape("blue").positions, (std::vector<Vec3>{{0, 0, 1}, {0, 1, 0}, {9, 9, 9}})) << "-1 was the first";
    EXPECT_EQ(shape("green").triangles.size(), 1u);
    const auto later = read_as("a.obj", corners + "f 1//1 2//1 3//1\nf 1//2 2//1 3//1\nvn 0 0 -1\n");
    EXPECT_EQ(normal_of(mesh_of(later)), (Vec3{0, 0, -1}));
    EXPECT_THAT(warnings_of(later), HasSubstr("a.obj:6: faces name normals that are not there"));
    EXPECT_THAT(errors_as("a.obj", "f 1 2 9\n" + corners), HasSubstr("a.obj:1: index 9 is out of range: there are"));
}

TEST(Obj, SaysWhatIsWrongAndWhere) {
    const std::string errors =
        errors_as("a.obj", "v 0 0 zero\nv 1 0 0\nv 1 inf 0\nf 1 2 9\nf 0 1 2\n\nf 1 x 2\nvn 1 2\n");
    EXPECT_THAT(errors, HasSubstr("a.obj:1: a finite number expected, not 'zero'"));
    EXPECT_THAT(errors, HasSubstr("a.obj:3: a finite number expected, not 'inf'"));
    EXPECT_THAT(errors, HasSubstr("a.obj:4: index 9 is out of range: there are 3 vertices"));
    EXPECT_THAT(errors, HasSubstr("a.obj:5: index 0 is out of range"));
    EXPECT_THAT(errors, HasSubstr("a.obj:7: an index expected, not 'x'"));
    EXPECT_THAT(errors, HasSubstr("a.obj:8: a normal needs three numbers"));
    EXPECT_THAT(errors_as("a.obj", corners), HasSubstr("a.obj: there are no faces"));
    EXPECT_THAT(errors_as("none.txt", ""), HasSubstr("'.obj'"));
}

TEST(Obj, WarnsOfWhatItLeavesOut) {
    const auto scene =
        read_as("a.obj", corners + "l 1 2\np 1\ncurv 0 1\nmtllib gone.mtl\nusemtl stone\nf 1 2 3\nf 1 2\n");
    const std::string warnings = warnings_of(scene);
    EXPECT_THAT(warnings, HasSubstr("lines and points have no surface and are left out (2 times)"));
    EXPECT_THAT(warnings, HasSubstr("a.obj:11: faces of fewer than three corners have no surface and are left out"));
    EXPECT_THAT(warnings, HasSubstr("unknown statement 'curv' is left out"));
    EXPECT_THAT(warnings, HasSubstr("a.obj:8: there is no material library 'gone.mtl': grey is taken"));
    EXPECT_THAT(warnings, HasSubstr("there is no material 'stone': grey is taken"));
}

TEST(Mtl, MakesMatterOfKdAndLightOfKe) {
    const auto scene = with_material("Kd .1 .2 .3\nKe 4 5 6\nillum 1\n");
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{0.1f, 0.2f, 0.3f}));
    ASSERT_TRUE(scene.shapes[0].emission);
    EXPECT_EQ(scene.shapes[0].emission->radiance, (Rgb{4, 5, 6}));
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(Mtl, KnowsMirrorsAndGlass) {
    EXPECT_NO_THROW(model_of<ConductorMaterial>(with_material("Kd 0 0 0\nKs .9 .9 .9\nillum 3\n")));
    for (const char* none : {"illum 4.4e28\n", "illum -7e30\n", "illum 11\n"})
        EXPECT_NO_THROW(model_of<DiffuseMaterial>(with_material("Kd .5 .5 .5\n" + std::string(none)))) << none;
    const auto glass = with_material("Ni 1.33\nTf .5 1 1\nd 0\nillum 7\n");
    EXPECT_EQ(model_of<DielectricMaterial>(glass).eta, 1.33f);
    EXPECT_FALSE(material_of(glass).opacity);  // glass is there, though it lets all through
    EXPECT_NEAR(model_of<PrincipledMaterial>(with_material("Kd .5 .5 .5\nKs 1 1 1\nNs 198\n")).roughness.u, 0.1f,
                1e-5f);
}

TEST(Mtl, TakesPhysicallyBasedNumbers) {
    const auto scene = with_material("Kd .5 .5 .5\nPr .25\nPm 1\nPc .5\nPcr .1\nPs .2\nNi 1.4\nTr .25\n");
    const auto& model = model_of<PrincipledMaterial>(scene);
    EXPECT_EQ(model.metallic, 1);
    EXPECT_EQ(model.roughness.u, 0.25f);
    EXPECT_EQ(model.clearcoat, 0.5f);
    EXPECT_EQ(model.sheen, 0.2f);
    EXPECT_EQ(model.eta, 1.4f);
    EXPECT_EQ(colour_of(scene, material_of(scene).opacity.value()).r, 0.75f);
}

TEST(Mtl, TakesPicturesWithOptions) {
    const auto scene =
        with_material("map_Kd -s 2 3 1 -o .5 -clamp on my wood.hdr\nbump -bm .1 my wood.hdr\nmap_d my wood.hdr\n",
                      {{"my wood.hdr", dot}});
    const auto& pattern = std::get<ImageTexture>(scene.textures[model_of<DiffuseMaterial>(scene).reflectance].pattern);
    EXPECT_EQ(pattern.uv.scale, (Vec2{2, 3}));
    EXPECT_EQ(pattern.uv.offset, (Vec2{0.5f, 0}));
    EXPECT_EQ(pattern.wrap_u, Wrap::clamp);
    EXPECT_EQ(scene.textures[material_of(scene).bump_map.value()].scale.r, 0.1f);
    EXPECT_TRUE(material_of(scene).opacity);
}

TEST(Mtl, SaysWhatIsWrongAndWhere) {
    const std::string errors =
        errors_as("m.obj", "mtllib m.mtl\nv 0 0 0\nf 1 1 1\n", {{"m.mtl", "Kd 1 1 1\nnewmtl a\nKd red\nNs\n"}});
    EXPECT_THAT(errors, HasSubstr("m.mtl:1: 'Kd' stands before the first 'newmtl'"));
    EXPECT_THAT(errors, HasSubstr("m.mtl:3: a finite number expected, not 'red'"));
    EXPECT_THAT(errors, HasSubstr("m.mtl:4: 'Ns' needs a number"));
}

TEST(Mtl, IsReadWhereverALineNamesIt) {
    const MemoryFiles files{{"a.mtl", "newmtl red\nKd 1 0 0\n"},
                            {"my b.mtl", "newmtl green\nKd 0 1 0\n"},
                            {"c.mtl", "newmtl blue\nKd 0 0 1\n"}};
    for (const char* lines : {"mtllib a.mtl my b.mtl c.mtl\n", "mtllib a.mtl\nmtllib my b.mtl\nmtllib c.mtl # sea\n",
                              "mtllib my b.mtl  a.mtl\tc.mtl\n", "mtllib C:\\work\\A.MTL my b.mtl /old/c.mtl\n"}) {
        const auto scene = read_as(
            "m.obj", lines + corners + "usemtl red\nf 1 2 3\nusemtl green\nf 1 2 3\nusemtl blue\nf 1 2 3\n", files);
        EXPECT_THAT(warnings_of(scene), Not(HasSubstr("grey is taken"))) << lines;
        EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene, 1).reflectance), (Rgb{0, 1, 0})) << lines;
    }
    const auto scene = read_as("m.obj", "mtllib gone.mtl A.mtl\n" + corners + "usemtl red\nf 1 2 3\n", files);
    EXPECT_THAT(warnings_of(scene), HasSubstr("there is no material library 'gone.mtl': grey is taken"));
    EXPECT_THAT(warnings_of(scene), HasSubstr("there is no material library 'A.mtl': 'a.mtl' is taken"));
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{1, 0, 0}));
}

TEST(Obj, MayBeginWithAByteOrderMark) {
    const std::string mark = "\xEF\xBB\xBF";
    const auto scene = read_as("m.obj", mark + "mtllib m.mtl\nusemtl a\n" + corners + "f 1 2 3\n",
                               {{"m.mtl", mark + "newmtl a\nKd .25 .5 1\n"}});
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{0.25f, 0.5f, 1}));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("left out")));
}

TEST(Obj, GoesWithoutNormalsAndCoordinatesThatAreNotThere) {
    const auto scene = read_as("a.obj", corners + "f 1/1/1 2/2/2 3/3/3\nf 1/-1/-1 3/0/0 4/9/9\n");
    EXPECT_THAT(mesh_of(scene).triangles, SizeIs(2));
    EXPECT_THAT(mesh_of(scene).normals, IsEmpty());
    EXPECT_THAT(mesh_of(scene).uvs, IsEmpty());
    EXPECT_THAT(warnings_of(scene),
                HasSubstr("a.obj:5: faces name normals that are not there, and go without (6 times)"));
    EXPECT_THAT(warnings_of(scene), HasSubstr("faces name texture coordinates that are not there"));
    EXPECT_THAT(errors_as("a.obj", corners + "f 1//x 2 3\n"), HasSubstr("an index expected, not 'x'"));
}

TEST(Mtl, FindsPicturesOfOtherMachines) {
    for (const char* name :
         {"C:\\textures\\Wood.HDR", "/home/somebody/wood.hdr", "..\\lost\\WOOD.hdr", "Maps/wood.hdr"}) {
        const auto scene = with_material("Kd .1 .2 .3\nmap_Kd " + std::string(name) + "\n", {{"wood.hdr", dot}});
        const Texture& texture = scene.textures[model_of<DiffuseMaterial>(scene).reflectance];
        EXPECT_TRUE(std::holds_alternative<ImageTexture>(texture.pattern)) << name;
        EXPECT_THAT(warnings_of(scene), HasSubstr("m.mtl:3: image '")) << name;
        EXPECT_THAT(warnings_of(scene), HasSubstr("'wood.hdr' is taken")) << name;
    }
    const auto scene = with_material("map_Kd maps/wood.hdr\n", {{"Maps/Wood.hdr", dot}});
    EXPECT_THAT(warnings_of(scene), HasSubstr("'Maps/Wood.hdr' is taken"));
}

TEST(Mtl, GoesWithoutPicturesThatCantBeRead) {
    const auto scene = with_material(
        "Kd .1 .2 .3\nmap_Kd gone.png\nmap_Ke broken.png\nKe 0 0 0\nmap_d gone.png\nnorm gone.png\nbump -bm 2 "
        "gone.png\nmap_Ks\n",
        {{"broken.png", "\x89PNG\r\n\x1A\nand no more"}});
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_FALSE(scene.shapes[0].emission);
    EXPECT_FALSE(material_of(scene).opacity || material_of(scene).normal_map || material_of(scene).bump_map);
    const std::string warnings = warnings_of(scene);
    EXPECT_THAT(warnings, HasSubstr("m.mtl:3: image 'gone.png': gone.png: no such file: Kd alone is taken"));
    EXPECT_THAT(warnings, HasSubstr("m.mtl:4: image 'broken.png': PNG: "));
    EXPECT_THAT(warnings, HasSubstr("m.mtl:6: image 'gone.png': gone.png: no such file: it is left out (3 times)"));
    EXPECT_THAT(warnings, HasSubstr("m.mtl:9: 'map_Ks' names no file and is left out"));
    // exporters write 0 beside a map
    for (const char* kd : {"", "Kd 0 0 0\n"}) {
        const auto grey = with_material(std::string(kd) + "map_Kd gone.png\n");
        EXPECT_EQ(colour_of(grey, model_of<DiffuseMaterial>(grey).reflectance), (Rgb{0.5f, 0.5f, 0.5f}));
        EXPECT_THAT(warnings_of(grey), HasSubstr("mid-grey is taken"));
    }
}

TEST(Mtl, SkipsOptionsOfPictures) {
    const auto scene = with_material(
        "map_Kd -blendu off -blendv on -texres 512 -o 0 0 0 -s 1 1 1 -mm .5 2 -cc on -imfchan r wood.hdr\n",
        {{"wood.hdr", dot}});
    EXPECT_TRUE(
        std::holds_alternative<ImageTexture>(scene.textures[model_of<DiffuseMaterial>(scene).reflectance].pattern));
    EXPECT_THAT(warnings_of(scene), HasSubstr("option '-mm' of a map is left out"));
    EXPECT_THAT(warnings_of(scene), HasSubstr("option '-imfchan r' of a map is left out"));
    const auto usual = with_material("map_Kd -mm 0 1 -t 0 0 0 -cc off \"wood.hdr\"\n", {{"wood.hdr", dot}});
    EXPECT_THAT(warnings_of(usual), Not(HasSubstr("left out")));
    EXPECT_TRUE(
        std::holds_alternative<ImageTexture>(usual.textures[model_of<DiffuseMaterial>(usual).reflectance].pattern));
}

TEST(Mtl, ColoursReflectionsByKs) {
    const auto scene = with_material("Kd 0 0 0\nKs .2 .4 .1\nNs 20\n");
    const auto& model = model_of<PrincipledMaterial>(scene);
    const Rgb reflected = model.specular_colour * model.specular;
    EXPECT_NEAR(reflected.r, 0.2f, 1e-6f);
    EXPECT_NEAR(reflected.g, 0.4f, 1e-6f);
    EXPECT_NEAR(reflected.b, 0.1f, 1e-6f);
    const auto even = with_material("Kd 0 0 0\nKs .5 .5 .5\nNs 20\nmap_Ks wood.hdr\n", {{"wood.hdr", dot}});
    EXPECT_EQ(model_of<PrincipledMaterial>(even).specular_colour, (Rgb{1, 1, 1}));
    EXPECT_TRUE(model_of<PrincipledMaterial>(even).specular_texture);
}

TEST(Mtl, NamesMaterialsThatAreThereTwice) {
    const auto scene = with_material("Kd 1 0 0\nnewmtl a\nKd 0 1 0\n");
    EXPECT_EQ(colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance), (Rgb{1, 0, 0}));
    EXPECT_THAT(warnings_of(scene), HasSubstr("the material 'a' is there twice: the first one is taken"));
}

TEST(PlyScene, HasTheColoursOfItsVertices) {
    const std::string start =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const auto scene =
        read_as("a.ply", start +
                             "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 "
                             "0 0 128\n3 0 1 2\n");
    EXPECT_EQ(mesh_of(scene).colours[0], (Rgb{1, 0, 0}));
    EXPECT_NEAR(mesh_of(scene).colours[2].b, 0.2158f, 1e-3f);
    EXPECT_THAT(warnings_of(scene), HasSubstr("'--env'"));
    const auto grey = read_as("a.ply", start +
                                           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 "
                                           "0\n1 0 0\n0 1 0\n7 0 1 2 -1 2 1 0\n");
    EXPECT_THAT(mesh_of(grey).triangles, SizeIs(2));
    EXPECT_EQ(colour_of(grey, model_of<DiffuseMaterial>(grey).reflectance), (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_THAT(errors_as("a.ply", "ply\n"), HasSubstr("a.ply: PLY: the header ends early"));
}

TEST(PlyScene, HasTheColoursOfItsFacesWhereItsVerticesHaveNone) {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\nproperty list uchar int vertex_indices\n";
    const auto scene =
        read_as("a.ply", header +
                             "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
                             "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3 0 255 0\n");
    const auto& mesh = mesh_of(scene);
    ASSERT_THAT(mesh.colours, SizeIs(6));
    EXPECT_EQ(mesh.colours[mesh.triangles[0][2]], (Rgb{1, 0, 0}));
    EXPECT_EQ(mesh.colours[mesh.triangles[1][0]], (Rgb{0, 1, 0}));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("left out")));
}

TEST(SmoothNormals, AreMeansOverTheAnglesOfFaces) {
    // the corner of a cube, one of whose faces is cut in two
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {0, 4, 3}};
    smooth_normals(mesh);
    const float third = -1 / std::sqrt(3.0f);
    EXPECT_NEAR(mesh.normals[0].x, third, 1e-6f);
    EXPECT_NEAR(mesh.normals[0].y, third, 1e-6f);
    EXPECT_NEAR(mesh.normals[0].z, third, 1e-6f);
}

}  // namespace
}  // namespace lightnet::test::obj_reader_test
