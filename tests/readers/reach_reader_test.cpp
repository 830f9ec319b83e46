// What stands too far away to be traced is refused, with the line where it is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/readers/overrides.hpp"
#include "tests/support/pbrt_text.hpp"

namespace lightnet::reach_reader_test {
namespace {

using namespace test;
using testing::HasSubstr;

std::string errors_in(const std::string& path, const std::string& text, MemoryFiles files = {}) {
    files.add(path, text);
    try {
        read_scene(files, path);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(Reach, OfAPbrtCameraIsChecked) {
    const auto with = [](const std::string& camera) { return errors_of(camera + "\nWorldBegin\n" + test::triangle); };
    EXPECT_EQ(with("LookAt 0 0 1e14  0 0 0  0 1 0\nCamera \"perspective\""), "");
    EXPECT_THAT(with("LookAt 0 0 1e19  0 0 0  0 1 0\nCamera \"perspective\""), HasSubstr("scene.pbrt:2: the camera"));
    EXPECT_THAT(with("Camera \"perspective\" \"float fov\" 1e-45"), HasSubstr("scene.pbrt:1: the camera's rays"));
    EXPECT_THAT(with("Camera \"perspective\" \"float fov\" 1e-25"), HasSubstr("scene.pbrt:1: the camera's rays"));
    EXPECT_THAT(with("Camera \"perspective\" \"float screenwindow\" [ -1e38 1e38 -1 1 ]"), HasSubstr("scene.pbrt:1:"));
    EXPECT_THAT(with("Camera \"perspective\" \"float lensradius\" 1e30"), HasSubstr("scene.pbrt:1:"));
    EXPECT_THAT(with("Camera \"orthographic\" \"float screenwindow\" [ -1e20 1e20 -1 1 ]"), HasSubstr("scene.pbrt:1:"));
}

TEST(Reach, OfPbrtShapesLightsAndInstancesIsChecked) {
    EXPECT_THAT(errors_of_world("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1e38 0 0  0 1 0 ]"),
                HasSubstr("scene.pbrt:2: a vertex lies beyond 1e+15"));
    for (const char* shape : {"Shape \"sphere\" \"float radius\" 1e30", "Shape \"disk\" \"float radius\" 1e30",
                              "Translate 1e17 0 0 Shape \"sphere\"", "Scale 1 1e20 1 Shape \"sphere\"",
                              "Shape \"cylinder\" \"float zmax\" 1e30"})
        EXPECT_THAT(errors_of_world(shape), HasSubstr("scene.pbrt:2:")) << shape;
    for (const char* light : {"\"point\" \"point3 from\" [ 1e17 0 0 ]", "\"spot\" \"point3 from\" [ 0 -1e30 0 ]"})
        EXPECT_THAT(errors_of_world(test::triangle + "LightSource " + light), HasSubstr("scene.pbrt:3: ")) << light;
    const std::string object = "ObjectBegin \"a\"\n" + test::triangle + "ObjectEnd\n";
    for (const char* way : {"Translate 1e17 0 0", "Scale 1e14 1e14 1e14", "Scale 1e-15 1e-15 1e-15", "Scale 1e16 1 1"})
        EXPECT_THAT(errors_of_world(object + way + "\nObjectInstance \"a\""), HasSubstr("scene.pbrt:")) << way;
    EXPECT_EQ(errors_of_world(object + "Scale 1e-3 1e-3 1e-3\nObjectInstance \"a\""), "");
}

TEST(Reach, IsWorldSpace) {
    EXPECT_EQ(errors_of_world("Scale 1e-10 1e-10 1e-10\nShape \"trianglemesh\" \"point3 P\" [ 0 0 0 1e16 0 0 0 1 0 ]"),
              "");
}

// Embree multiplies three distances, in single precision.
TEST(Reach, EndsWhereTrianglesAreTooLargeToBeMet) {
    const auto floor = [](const std::string& scale) {
        return errors_of_world("Scale " + scale + " " + scale + " " + scale +
                               "\nShape \"trianglemesh\" \"point3 P\" [ -1 0 -1  1 0 -1  0 0 1 ]");
    };
    EXPECT_EQ(floor("1e12"), "");
    EXPECT_THAT(floor("1e13"), HasSubstr("scene.pbrt:3: its triangles are so large that no ray from 1e+13 units away"));
    EXPECT_THAT(floor("1e15"), HasSubstr("scene.pbrt:3:"));
    EXPECT_THAT(errors_of_world("Shape \"trianglemesh\" \"point3 P\" [ -1e12 0 -1e12  1e12 0 -1e12  0 0 1e12 ]\n"
                                "Translate 0 0 1e14 Shape \"sphere\""),
                HasSubstr("scene.pbrt:2: its triangles"));
    EXPECT_EQ(errors_of_world("Translate 0 0 1e14\n" + test::triangle + "Shape \"sphere\""), "") << "small ones";
    EXPECT_THAT(errors_of_world("ObjectBegin \"a\"\nShape \"trianglemesh\" \"point3 P\" [ -1 0 -1  1 0 -1  0 0 1 ]\n"
                                "ObjectEnd\nScale 1e12 1e12 1e12 Scale 20 20 20 ObjectInstance \"a\""),
                HasSubstr("scene.pbrt:"));
}

TEST(Reach, OfObjVerticesIsChecked) {
    EXPECT_THAT(errors_in("s.obj", "v 0 0 0\nv 1.8e18 0 0\nv 0 1 0\nf 1 2 3\n"), HasSubstr("s.obj:2: the vertex"));
}

TEST(Reach, OfPlyVerticesIsChecked) {
    EXPECT_THAT(errors_in("s.ply",
                          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                          "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1e30 0 "
                          "0\n0 1 0\n3 0 1 2\n"),
                HasSubstr("s.ply: a vertex lies beyond"));
}

std::string mitsuba(const std::string& inside) {
    return errors_in("s.xml", "<scene version=\"0.6.0\">\n" + inside + "\n</scene>\n");
}

TEST(Reach, OfMitsubaScenesIsChecked) {
    EXPECT_THAT(mitsuba("<shape type=\"cube\"><transform name=\"toWorld\"><translate x=\"1e20\"/></transform></shape>"),
                HasSubstr("s.xml:2: a vertex lies beyond"));
    EXPECT_THAT(mitsuba("<shape type=\"sphere\"><float name=\"radius\" value=\"1e20\"/></shape>"),
                HasSubstr("s.xml:2:"));
    EXPECT_THAT(mitsuba("<shape type=\"cube\"/>\n<emitter type=\"point\"><point name=\"position\" x=\"1e20\" y=\"0\" "
                        "z=\"0\"/></emitter>"),
                HasSubstr("s.xml:3: it stands out of reach"));
    EXPECT_THAT(mitsuba("<shape type=\"cube\"/>\n<sensor type=\"perspective\"><transform name=\"toWorld\"><translate "
                        "x=\"1e20\"/></transform></sensor>"),
                HasSubstr("s.xml:3: the camera"));
    EXPECT_THAT(
        mitsuba("<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"/></shape>\n"
                "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"toWorld\"><matrix value=\"1 0 0 0 0 1 "
                "-2147483648 0 0 1 -2147483648 0 0 0 0 1\"/></transform></shape>"),
        HasSubstr("s.xml:3: the transform of an instance can't be inverted"));
}

TEST(Reach, OfGltfScenesIsChecked) {
    EXPECT_THAT(errors_in("s.gltf", R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"camera":0,
        "translation":[1e20,0,0]},{"mesh":0}],"cameras":[{"type":"perspective","perspective":{"yfov":1,"aspectRatio":1}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,
        "type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,
        "uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})"),
                HasSubstr("s.gltf: the camera"));
}

TEST(Reach, OfAGraphsCameraIsChecked) {
    SceneData scene = read_text("Camera \"perspective\"\nWorldBegin\n" + test::triangle);
    SceneOverrides far;
    far.camera.emplace();
    far.camera->from = Vec3{1e20f, 0, 0}, far.camera->to = Vec3{0, 0, 0}, far.camera->up = Vec3{0, 1, 0};
    MemoryFiles none;
    try {
        apply(far, scene, none, {"g.lua", 7});
        ADD_FAILURE() << "it was taken";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("g.lua:7: 'camera': "));
    }
}

}  // namespace
}  // namespace lightnet::reach_reader_test
