// glTF at rest: morph targets, skins, hidden nodes, and meshes that come packed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/textures/look_up.hpp"
#include "tests/support/gltf_text.hpp"
#include "tests/support/packed_meshes.hpp"

namespace lightnet::test::gltf_pose_reader_test {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

std::string mesh(const std::string& attributes, const std::string& more = "", const std::string& of_mesh = "") {
    return R"("meshes":[{"primitives":[{"attributes":{)" + attributes + "}" + more + "}]" + of_mesh + "}],";
}
std::string nodes(const std::string& list) { return R"("nodes":[)" + list + "],"; }
void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(GltfMorphs, MoveAllThatAVertexHas) {
    GltfText text = triangle_text();
    text.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});                             // 1: normals
    text.vectors("VEC2", {0, 0, 0, 0, 0, 0});                                      // 2: texture coordinates
    text.vectors("VEC3", {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f});  // 3: colours
    text.vectors("VEC3", {0, 0, 2, 0, 0, 2, 0, 0, 2});                             // 4: of positions
    text.vectors("VEC3", {0, 2, 0, 0, 2, 0, 0, 2, 0});                             // 5: of normals
    text.vectors("VEC2", {0.5f, 0, 0.5f, 0, 0.5f, 0});                             // 6: of texture coordinates
    text.vectors("VEC3", {1, 0, -2, 1, 0, -2, 1, 0, -2});                          // 7: of colours
    text.vectors("VEC3", {9, 9, 9, 9, 9, 9, 9, 9, 9});                             // 8: of a target without a weight
    const auto scene = text.read(
        mesh(R"("POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3)",
             R"(,"targets":[{"POSITION":8},{"POSITION":4,"NORMAL":5,"TEXCOORD_0":6,"COLOR_0":7},{"POSITION":4}])",
             R"(,"weights":[0,0.5,0.25])") +
        nodes(R"({"mesh":0})"));
    expect_near(mesh_of(scene).positions[1], {1, 0, 1.5f});
    expect_near(mesh_of(scene).normals[1], normalize({0, 1, 1}));
    EXPECT_EQ(mesh_of(scene).uvs[0], (Vec2{0.25f, 1}));
    EXPECT_EQ(mesh_of(scene).colours[0], (Rgb{1, 0.5f, 0})) << "within 0 … 1";
    EXPECT_EQ(warnings_of(scene).find("morph"), std::string::npos);
}

TEST(GltfMorphs, GoByTheNodeBeforeTheMesh) {
    GltfText text = triangle_text();
    text.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const auto scene =
        text.read(mesh(R"("POSITION":0)", R"(,"targets":[{"POSITION":1}])", R"(,"weights":[1])") +
                  nodes(R"({"mesh":0},{"mesh":0,"weights":[3]},{"mesh":0,"weights":[0]},{"mesh":0,"weights":[0]})"));
    ASSERT_THAT(scene.shapes, SizeIs(3)) << "two of the nodes show it alike";
    EXPECT_THAT(scene.instances, SizeIs(2));
    std::vector<float> heights;
    for (const auto& shape : scene.shapes) heights.push_back(std::get<Mesh>(shape.geometry).positions[0].z);
    EXPECT_THAT(heights, testing::UnorderedElementsAre(0, 1, 3));
}

TEST(GltfMorphs, MayBeSparseAndQuantised) {
    GltfText text = triangle_text();
    const auto indices = text.view(raw(std::uint16_t{2})), values = text.view(raw(0.f, 0.f, 4.f));
    text.empty_accessor("VEC3", 5126, 3,
                        R"(,"sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(indices) +
                            R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(values) + "}}");
    text.accessor<std::int8_t>("VEC3", 5120, {127, 0, 0, 127, 0, 0, 127, 0, 0}, 3, R"(,"normalized":true)");
    const auto scene =
        text.read(mesh(R"("POSITION":0)", R"(,"targets":[{"POSITION":1},{"POSITION":2}])", R"(,"weights":[1,1])") +
                  nodes(R"({"mesh":0})"));
    EXPECT_EQ(mesh_of(scene).positions[0], (Vec3{1, 0, 0}));
    EXPECT_EQ(mesh_of(scene).positions[2], (Vec3{1, 1, 4}));
}

TEST(GltfMorphs, MustFitTheirMesh) {
    GltfText text = triangle_text();
    text.vectors("VEC3", {0, 0, 1});
    EXPECT_THAT(text.errors(mesh(R"("POSITION":0)", R"(,"targets":[{"POSITION":1}])", R"(,"weights":[1])") +
                            nodes(R"({"mesh":0})")),
                HasSubstr("targets[0].POSITION must name 3 vectors of 3 numbers"));
}

/// The triangle, with its corners on joints 0, 1 and half on each; joint 1 comes by a second set of four.
GltfText hanging() {
    GltfText text = triangle_text();
    text.accessor<std::uint8_t>("VEC4", 5121, {0, 0, 0, 0, 7, 0, 0, 0, 0, 9, 0, 0}, 3);   // 1: JOINTS_0
    text.vectors("VEC4", {1, 0, 0, 0, 0, 0, 0, 0, 0.5f, 0, 0, 0});                        // 2: WEIGHTS_0
    text.accessor<std::uint16_t>("VEC4", 5123, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1}, 3);  // 3: JOINTS_1
    text.accessor<std::uint8_t>("VEC4", 5121, {0, 0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 128}, 3, R"(,"normalized":true)");
    text.vectors("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  // 5: inverse bind matrices
                          1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
    return text;
}
const std::string joints = R"("POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2,"JOINTS_1":3,"WEIGHTS_1":4)";

TEST(GltfSkins, HoldMeshesWhereTheirJointsStand) {
    const auto scene = hanging().read(
        mesh(joints) + R"("skins":[{"joints":[2,3],"inverseBindMatrices":5}],"scenes":[{"nodes":[0,1]}],)" +
        nodes(R"({"mesh":0,"skin":0,"translation":[77,0,0]},{"translation":[0,0,10],"children":[2]},
                 {"children":[3]},{"translation":[1,0,0],"rotation":[0,0,0.70710678,0.70710678],"scale":[2,2,2]})"));
    expect_near(mesh_of(scene).positions[0], {0, 0, 10});
    expect_near(mesh_of(scene).positions[1], {1, 0, 10});
    // (0, 1) by the first joint, and by the other one (-1, 1) turned to (-1, -1), doubled and moved; 128 of 255
    const float half = 128 / 255.f;
    expect_near(mesh_of(scene).positions[2], Vec3{half * -1 / (0.5f + half), (0.5f + half * -2) / (0.5f + half), 10});
    EXPECT_EQ(warnings_of(scene).find("skin"), std::string::npos);
}

TEST(GltfSkins, MirrorAndTurnNormals) {
    GltfText text = triangle_text();
    text.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    text.accessor<std::uint8_t>("VEC4", 5121, std::vector<std::uint8_t>(12), 3);
    text.vectors("VEC4", {2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});  // of any sum
    const auto held = [&](const std::string& attributes, const std::string& joint) {
        return text.read(mesh(attributes) + R"("skins":[{"joints":[1]}],)" +
                         nodes(R"({"mesh":0,"skin":0},{)" + joint + "}"));
    };
    const std::string own = R"("JOINTS_0":2,"WEIGHTS_0":3,"POSITION":0)";
    for (const std::string& attributes : {own, own + R"(,"NORMAL":1)"}) {
        expect_near(normal_of(mesh_of(held(attributes, R"("scale":[-3,1,1])"))), {0, 0, 1});
        expect_near(normal_of(mesh_of(held(attributes, R"("rotation":[0,0.70710678,0,0.70710678])"))), {1, 0, 0});
    }
}

TEST(GltfSkins, ThatMakeNoSenseAreMistakes) {
    const auto error = [](const std::string& skin, const std::string& attributes = joints) {
        return hanging().errors(mesh(attributes) + R"("skins":[{)" + skin + "}]," +
                                nodes(R"({"mesh":0,"skin":0},{},{})"));
    };
    EXPECT_THAT(error(R"("joints":[])"), HasSubstr("skins[0] has no joints"));
    EXPECT_THAT(error(R"("joints":[1])"), HasSubstr("a joint of a skin that has 1"));
    EXPECT_THAT(error(R"("joints":[1,9])"), HasSubstr("skins[0].joints[1] index 9 is out of range"));
    EXPECT_THAT(error(R"("joints":[1,2],"inverseBindMatrices":0)"), HasSubstr("an inverse bind matrix for each joint"));
    EXPECT_THAT(error(R"("joints":[1,2])", R"("POSITION":0)"), HasSubstr("attributes.JOINTS_0 is not there"));
}

TEST(GltfVisibility, HidesMeshesAndLightsButNotCameras) {
    const auto scene = triangle_text().read(
        mesh(R"("POSITION":0)") +
        R"("extensionsRequired":["KHR_node_visibility"],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},
        "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],"scenes":[{"nodes":[0,1]}],)" +
        nodes(R"({"mesh":0,"name":"seen","extensions":{"KHR_node_visibility":{"visible":true}}},
                 {"mesh":0,"children":[2,3],"extensions":{"KHR_node_visibility":{"visible":false}}},
                 {"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0},"KHR_node_visibility":{"visible":true}}},
                 {"camera":0})"));
    ASSERT_THAT(scene.shapes, SizeIs(1));
    EXPECT_EQ(scene.shapes[0].name, "seen");
    EXPECT_THAT(scene.instances, SizeIs(0));
    EXPECT_THAT(scene.lights, SizeIs(0));
    EXPECT_TRUE(scene.camera_given);
}

std::string by_draco(GltfText& text, const std::string& bytes, std::size_t points) {
    const auto view = text.view(bytes);
    const auto at = std::to_string(text.empty_accessor("VEC3", 5126, points));
    const auto colour = std::to_string(text.empty_accessor("VEC4", 5121, points, R"(,"normalized":true)"));
    return R"("extensionsRequired":["KHR_draco_mesh_compression"],)" +
           mesh(R"("POSITION":)" + at + R"(,"COLOR_0":)" + colour,
                R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":)" + std::to_string(view) +
                    R"(,"attributes":{"POSITION":0,"COLOR_0":1}}})") +
           nodes(R"({"mesh":0})");
}

TEST(GltfDraco, IsUnpacked) {
    for (const bool by_edges : {false, true}) {
        GltfText text;
        const auto scene = text.read(by_draco(text, packed_by_draco(8, by_edges), 18));
        const Mesh& strip = mesh_of(scene);
        ASSERT_THAT(strip.triangles, SizeIs(16));
        float area = 0;
        for (const auto& [a, b, c] : strip.triangles)
            area += cross(strip.positions[b] - strip.positions[a], strip.positions[c] - strip.positions[a]).z / 2;
        EXPECT_NEAR(area, 8, 1e-4f);
        for (std::size_t i = 0; i < strip.positions.size(); ++i)
            EXPECT_NEAR(strip.colours[i].g, strip.positions[i].y, 1e-3f) << "each colour is at its vertex";
        EXPECT_EQ(strip.colours[0].r, 1);
    }
}

TEST(GltfDraco, IsRefusedWhereItIsDamagedOrPromisesTooMuch) {
    const std::string sound = packed_by_draco(8, true);
    const auto error = [](const std::string& bytes) {
        GltfText text;
        const std::string document = by_draco(text, bytes, 18);
        return text.errors(document);
    };
    EXPECT_EQ(error(sound), "");
    EXPECT_THAT(error(sound.substr(0, sound.size() / 2)), HasSubstr("is damaged, or no Draco mesh of version 2.2"));
    EXPECT_THAT(error("DRACO"), HasSubstr("is damaged"));
    std::string many = sound;
    ASSERT_EQ(many[13], 16) << "the number of triangles";
    many.replace(13, 1, "\xff\xff\xff\x7f");
    EXPECT_THAT(error(many), HasSubstr("promises 268435455 triangles, far more than the file holds"));
}

TEST(GltfMeshopt, IsUnpacked) {
    const auto file = [](const PackedView& corners, const std::string& more = "") {
        GltfText text;
        const auto view = [&](const PackedView& packed, const std::string& with) {
            const std::size_t at = text.put(packed.bytes);
            return text.view(packed.json(at, with), nullptr);
        };
        text.accessor("VEC3", 5126, view(corners, more), 4);
        text.accessor("SCALAR", 5123, view(packed_order(), ""), 6);
        return text.file(R"("extensionsRequired":["EXT_meshopt_compression"],)" +
                         mesh(R"("POSITION":0)", R"(,"indices":1)") + nodes(R"({"mesh":0})"));
    };
    const auto scene = read_as("a.glb", file(packed_corners()));
    EXPECT_EQ(mesh_of(scene).positions[3], (Vec3{1, 1, 0}));
    ASSERT_THAT(mesh_of(scene).triangles, SizeIs(2));
    PackedView damaged = packed_corners();
    damaged.bytes.resize(9);
    EXPECT_THAT(errors_as("a.glb", file(damaged)), HasSubstr("its bytes can't be unpacked"));
    EXPECT_THAT(errors_as("a.glb", file(packed_corners(), R"(,"filter":"QUATERNION")")),
                HasSubstr("has a filter 'QUATERNION' that does not suit it"));
    PackedView endless = packed_corners();
    endless.count = 1'000'000'000;
    EXPECT_THAT(errors_as("a.glb", file(endless)), HasSubstr("asks for far more than the file holds"));
}

}  // namespace
}  // namespace lightnet::test::gltf_pose_reader_test
