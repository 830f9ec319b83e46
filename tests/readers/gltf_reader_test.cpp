// glTF 2.0: buffers, accessors, nodes, materials, and all that can be wrong with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/bare_lights/environment.hpp"
#include "core/scene/data/surface_names.hpp"
#include "core/scene/textures/look_up.hpp"
#include "tests/support/light_profile_text.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::gltf_reader_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

// bytes 0 … 35: a triangle's positions; 36 … 41: its indices; 44 … 67: uvs; 68 … 79: colours in bytes
const std::string bytes = raw(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f) +
                          raw(std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2}) + std::string(2, '\0') +
                          raw(0.f, 0.f, 1.f, 0.f, 0.f, 1.f) + std::string("\xff\0\0\xff\0\xff\0\xff\0\0\xff\xff", 12);
const std::string views = R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},
 {"buffer":0,"byteOffset":44,"byteLength":24},{"buffer":0,"byteOffset":68,"byteLength":12}],"buffers":[{"byteLength":80}])";
const std::string accessors = R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
 {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},{"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"},
 {"bufferView":3,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}],)";

std::string document(const std::string& more) { return R"({"asset":{"version":"2.0"},)" + more + "}"; }
std::string with_triangle(
    const std::string& more,
    const std::string& primitive = R"({"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"material":0})") {
    const bool coloured = more.find("materials") != std::string::npos;
    return document(more + (coloured ? "" : R"("materials":[{}],)") + R"("meshes":[{"primitives":[)" + primitive +
                    "]}]," + accessors + views);
}
const std::string one_node = R"("nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],)";

SceneData read_gltf(const std::string& json) { return read_as("a.glb", glb(json, bytes)); }
std::string errors_of_gltf(const std::string& json) { return errors_as("a.glb", glb(json, bytes)); }
SceneData with_material(const std::string& material) {
    return read_gltf(with_triangle(one_node + R"("materials":[{)" + material + "}],"));
}
const Material& material_of(const SceneData& scene) { return scene.materials[scene.shapes[0].material]; }

TEST(Gltf, IsReadFromAllItsContainers) {
    EXPECT_EQ(mesh_of(read_gltf(with_triangle(one_node))).positions[1], (Vec3{1, 0, 0}));
    std::string json = with_triangle(one_node);
    const std::string file =
        json.replace(json.find(R"({"byteLength":80})"), 17, R"({"byteLength":80,"uri":"the%20bytes.bin"})");
    EXPECT_EQ(mesh_of(read_as("x/a.gltf", file, {{"x/the bytes.bin", bytes}})).positions[2], (Vec3{0, 1, 0}));
    const std::string inside = document(one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
      "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}])");
    EXPECT_EQ(mesh_of(read_as("a.gltf", inside)).positions[2], (Vec3{0, 1, 0}));
}

// "data:" without ";base64" has plain bytes, those written as %41 that are no letters (RFC 2397).
TEST(Gltf, MayHoldItsBytesInEitherKindOfDataUri) {
    const auto corner = [](const std::string& data) {
        return mesh_of(
                   read_as("a.gltf", document(one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
          "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
          "buffers":[{"byteLength":36,"uri":"data:)" +
                                              data + R"("}])")))
            .positions[1];
    };
    const std::string zero = "%00%00%00%00", one = "%00%00%80%3f";
    EXPECT_EQ(corner("," + zero + zero + zero + one + zero + zero + zero + one + zero), (Vec3{1, 0, 0}));
    EXPECT_EQ(corner(";base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAA%41A"), (Vec3{1, 0, 0}));
    EXPECT_THAT(errors_as("a.gltf", document(one_node + R"("buffers":[{"byteLength":36,"uri":"data:no"}],
          "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"bufferViews":[{"buffer":0,"byteLength":36}],
          "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}])")),
                HasSubstr("is no sound data"));
}

TEST(Gltf, TurnsTextureCoordinatesUpright) {
    EXPECT_EQ(mesh_of(read_gltf(with_triangle(one_node))).uvs[2], (Vec2{0, 0}));
}

TEST(Gltf, KnowsStripsAndFans) {
    const auto count = [](int mode) {
        return mesh_of(read_gltf(with_triangle(one_node,
                                               R"({"attributes":{"POSITION":0},"mode":)" + std::to_string(mode) + "}")))
            .triangles;
    };
    EXPECT_THAT(count(5), SizeIs(1));
    EXPECT_THAT(count(6), SizeIs(1));
    EXPECT_THAT(errors_of_gltf(with_triangle(one_node, R"({"attributes":{"POSITION":0},"mode":1})")),
                HasSubstr("there are no triangles: its points and lines have no surface"));
}

TEST(Gltf, WithACameraMayShowNothingButWhatIsAround) {
    const auto scene = read_gltf(with_triangle(R"("cameras":[{"type":"perspective","perspective":{"yfov":1}}],
      "nodes":[{"mesh":0,"extensions":{"KHR_node_visibility":{"visible":false}}},{"camera":0}],)"));
    EXPECT_TRUE(scene.shapes.empty());
    EXPECT_THAT(warnings_of(scene), HasSubstr("nothing is seen but what is around the scene"));
}

TEST(Gltf, PaintsByColoursOfVertices) {
    const auto scene = read_gltf(with_triangle(one_node, R"({"attributes":{"POSITION":0,"COLOR_0":3}})"));
    EXPECT_EQ(mesh_of(scene).colours[1], (Rgb{0, 1, 0}));
    EXPECT_EQ(look_up(scene.textures, model_of<PrincipledMaterial>(scene).base_colour, {{0, 0}, {0.25f, 0.5f, 1}}),
              (Rgb{0.25f, 0.5f, 1}));
}

TEST(Gltf, OverlaysSparseAccessors) {
    const auto scene = read_gltf(document(one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,
        "indices":{"bufferView":1,"byteOffset":2,"componentType":5123},"values":{"bufferView":0,"byteOffset":24}}}],)" +
                                          views));
    EXPECT_EQ(mesh_of(scene).positions[1], (Vec3{0, 1, 0}));
    EXPECT_EQ(mesh_of(scene).positions[2], (Vec3{0, 1, 0}));
}

TEST(Gltf, ChainsTheTransformsOfNodes) {
    const auto scene =
        read_gltf(with_triangle(R"("scene":0,"scenes":[{"nodes":[1]}],"nodes":[{"mesh":0,"scale":[2,2,2]},
      {"children":[0],"translation":[0,0,5],"rotation":[0,0,0.70710678,0.70710678]}],)"));
    EXPECT_NEAR(mesh_of(scene).positions[1].y, 2, 1e-5f);
    EXPECT_NEAR(mesh_of(scene).positions[1].z, 5, 1e-5f);
    const auto matrix = read_gltf(with_triangle(R"("nodes":[{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,7,8,9,1]}],)"));
    EXPECT_EQ(mesh_of(matrix).positions[0], (Vec3{7, 8, 9}));  // without "scenes" all roots stand
}

// The mesh is "chair", two nodes stand for it; so artists know them, and so do mattes.
TEST(Gltf, CallsWhatStandsByItsNodeAndWhatItIsMadeOfByItsMesh) {
    const auto named = [](const std::string& nodes) {
        auto text = with_triangle(nodes);
        const std::string meshes = R"("meshes":[{)";
        return read_gltf(text.insert(text.find(meshes) + meshes.size(), R"("name":"chair",)"));
    };
    const auto two =
        named(R"("nodes":[{"mesh":0,"name":"left"},{"mesh":0,"name":"right"}],"scenes":[{"nodes":[0,1]}],)");
    EXPECT_THAT(surface_names(two, NamedBy::object).of_instance, ElementsAre("left", "right"));
    EXPECT_THAT(surface_names(two, NamedBy::mesh).of_instance, ElementsAre("chair", "chair"));
    const auto one = named(R"("nodes":[{"mesh":0,"name":"throne"}],"scenes":[{"nodes":[0]}],)");
    EXPECT_THAT(surface_names(one, NamedBy::object).of_shape, ElementsAre("throne"));
    EXPECT_THAT(surface_names(one, NamedBy::mesh).of_shape, ElementsAre("chair"));
    EXPECT_THAT(surface_names(named(one_node), NamedBy::object).of_shape, ElementsAre("chair"))
        << "a node without a name";
}

TEST(Gltf, MakesInstancesOfMeshesThatStandTwice) {
    const auto scene = read_gltf(with_triangle(
        R"("nodes":[{"mesh":0},{"mesh":0,"translation":[3,0,0]},{"mesh":0,"scale":[0,1,1]}],"scenes":[{"nodes":[0,1,2]}],)"));
    EXPECT_THAT(scene.objects, SizeIs(1));
    ASSERT_THAT(scene.instances, SizeIs(2));
    EXPECT_EQ(scene.instances[1].to_world.m[0][3], 3);
    EXPECT_THAT(warnings_of(scene), HasSubstr("meshes without a size are left out"));
    const auto lamps = read_gltf(with_triangle(
        R"("materials":[{"emissiveFactor":[1,1,1]}],"nodes":[{"mesh":0},{"mesh":0}],"scenes":[{"nodes":[0,1]}],)"));
    EXPECT_THAT(lamps.instances, IsEmpty());
    EXPECT_THAT(lamps.shapes, SizeIs(2));
}

TEST(Gltf, KeepsTheOutsideOfMirroredMeshes) {
    const auto scene = read_gltf(with_triangle(R"("nodes":[{"mesh":0,"scale":[-1,1,1]}],)"));
    EXPECT_EQ(normal_of(mesh_of(scene)), (Vec3{0, 0, 1}));
}

TEST(GltfMaterial, IsMetallicRough) {
    const auto scene = with_material(
        R"("pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1],"metallicFactor":0.5,"roughnessFactor":0.25})");
    const auto& model = model_of<PrincipledMaterial>(scene);
    EXPECT_EQ(colour_of(scene, model.base_colour), (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(model.metallic, 0.5f);
    EXPECT_EQ(model.roughness.u, 0.25f);
    EXPECT_EQ(model.roughness.means, Roughness::Means::square);
    EXPECT_EQ(
        model_of<PrincipledMaterial>(read_gltf(with_triangle(one_node, R"({"attributes":{"POSITION":0}})"))).metallic,
        1);
}

TEST(GltfMaterial, TakesItsExtensions) {
    const auto scene = with_material(
        R"("extensions":{"KHR_materials_ior":{"ior":1.33},"KHR_materials_transmission":{"transmissionFactor":0.75},
      "KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[0.5,1,1]},
      "KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatRoughnessFactor":0.25},"KHR_materials_sheen":{"sheenColorFactor":[1,0,0]},
      "KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[1,0.5,1]}})");
    const auto& model = model_of<PrincipledMaterial>(scene);
    EXPECT_EQ(model.eta, 1.33f);
    EXPECT_EQ(model.transmission, 0.75f);
    EXPECT_FALSE(model.thin);
    EXPECT_EQ(model.clearcoat, 0.5f);
    EXPECT_EQ(model.sheen_colour, (Rgb{1, 0, 0}));
    EXPECT_EQ(model.specular_colour.g, 0.5f);
    EXPECT_NEAR(material_of(scene).absorption.r, std::log(2.0f) / 2, 1e-6f);
    EXPECT_EQ(material_of(scene).absorption.g, 0);
}

TEST(GltfMaterial, MayShineAndBeCutOut) {
    const auto scene =
        with_material(R"("emissiveFactor":[1,0.5,0],"doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,
      "pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]},"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}})");
    ASSERT_TRUE(scene.shapes[0].emission);
    EXPECT_EQ(scene.shapes[0].emission->radiance, (Rgb{4, 2, 0}));
    EXPECT_TRUE(scene.shapes[0].emission->two_sided);
    EXPECT_THAT(warnings_of(scene), HasSubstr("only its own glowing surfaces light the scene"));
    EXPECT_EQ(colour_of(scene, material_of(scene).opacity.value()).r, 0.5f);
    EXPECT_EQ(material_of(scene).opacity_cutoff, 0.25f);
    const auto unlit = with_material(R"("extensions":{"KHR_materials_unlit":{}})");
    EXPECT_TRUE(unlit.shapes[0].emission);
    EXPECT_THAT(warnings_of(unlit), HasSubstr("KHR_materials_unlit is approximated"));
}

TEST(GltfMaterial, LaysPicturesAsTransformsSay) {
    const std::string map = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" +
                            std::string("\x80\0\0\x81\0\x80\0\x81\0\0\x80\x81\x80\x80\x80\x81", 16);
    const auto colour = [&](const std::string& transform, Vec2 uv) {
        const std::string json = with_triangle(
            one_node + R"("images":[{"uri":"p.hdr"}],"samplers":[{"magFilter":9728,"wrapS":33071,"wrapT":33648}],
          "textures":[{"source":0,"sampler":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0)" +
            transform + "}}}],");
        const auto scene = read_as("a.glb", glb(json, bytes), {{"p.hdr", map}});
        return look_up(scene.textures, model_of<PrincipledMaterial>(scene).base_colour, {uv});
    };
    const auto moved = [](const std::string& t) { return R"(,"extensions":{"KHR_texture_transform":{)" + t + "}}"; };
    EXPECT_EQ(colour("", {0.25f, 0.75f}), (Rgb{1, 0, 0}));  // the top left, by our v
    EXPECT_EQ(colour(moved(R"("offset":[0.5,0])"), {0.25f, 0.75f}), (Rgb{0, 1, 0}));
    EXPECT_EQ(colour(moved(R"("offset":[0,0.5])"), {0.25f, 0.75f}), (Rgb{0, 0, 1}));
    // anticlockwise by a right angle: glTF's (0.75, 0.25) becomes (0.25, -0.75), mirrored to (0.25, 0.75)
    EXPECT_EQ(colour(moved(R"("rotation":1.57079633)"), {0.75f, 0.75f}), (Rgb{0, 0, 1}));
}

TEST(GltfLights, AreThoseOfKhrLightsPunctual) {
    const auto scene = read_gltf(
        with_triangle(R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":3,"color":[1,0,0]},
      {"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.5}},{"type":"directional","intensity":2}]}},"scenes":[{"nodes":[0,1,2,3]}],
      "nodes":[{"mesh":0},{"translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}},{"extensions":{"KHR_lights_punctual":{"light":1}}},
      {"extensions":{"KHR_lights_punctual":{"light":2}}}],)"));
    ASSERT_THAT(scene.lights, SizeIs(3));
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).position, (Vec3{1, 2, 3}));
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).intensity, (Rgb{3, 0, 0}));
    EXPECT_EQ(std::get<SpotLight>(scene.lights[1]).falloff, SpotLight::Falloff::squared_linear);
    EXPECT_EQ(std::get<DirectionalLight>(scene.lights[2]).direction, (Vec3{0, 0, -1}));
}

// straight down is -z of the node, here +x; 90 degrees from it, horizontally 0, is its x, here z
TEST(GltfLights, MayHaveTheProfilesOfLuminaires) {
    const std::string file = with_triangle(
        R"("extensions":{"EXT_lights_ies":{"lights":[{"uri":"a.ies","mimeType":"application/x-ies-lm-63"}]}},"extensionsUsed":["EXT_lights_ies"],
      "nodes":[{"mesh":0},{"name":"hall","translation":[1,2,3],"rotation":[0,-0.70710678,0,0.70710678],
      "extensions":{"EXT_lights_ies":{"light":0,"multiplier":2,"color":[1,0.5,0]}}},{"extensions":{"EXT_lights_ies":{"light":0}}}],"scenes":[{"nodes":[0,1,2]}],)");
    const auto scene =
        read_as("a.glb", glb(file, bytes), {{"a.ies", light_profile("2 3", "0 90\n0 90 180\n8 4\n8 4\n8 0")}});
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("ies")));
    ASSERT_THAT(scene.lights, SizeIs(2));
    const auto& lamp = std::get<PointLight>(scene.lights[0]);
    EXPECT_EQ(lamp.position, (Vec3{1, 2, 3}));
    EXPECT_EQ(lamp.label.name, "hall");
    EXPECT_EQ(lamp.intensity, (Rgb{2, 1, 0}));
    const Environment pattern(lamp.pattern.value());
    EXPECT_NEAR(pattern.radiance({1, 0, 0}).g, 8, 0.05f);
    EXPECT_NEAR(pattern.radiance(normalize({1, 0, 1})).g, 6, 0.05f);
    EXPECT_NEAR(pattern.radiance(normalize({1, 0, -1})).g, 4, 0.05f);
    // a vertical lamp that lies here
    const auto lying =
        read_as("a.glb", glb(file, bytes),
                {{"a.ies", "TILT=INCLUDE\n1 2 0 90 1 .5\n1 100 1 2 1 1 1 0 0 0\n1 1 9\n0 90\n0\n7 7\n"}});
    EXPECT_NEAR(std::get<PointLight>(lying.lights[0]).intensity.r, 1, 1e-3f);
    EXPECT_THAT(warnings_of(lying), Not(HasSubstr("tilted")));
    EXPECT_THAT(errors_as("a.glb", glb(file, bytes), {{"a.ies", "x"}}), HasSubstr("lights[0]"));
    EXPECT_THAT(errors_as("a.glb", glb(file, bytes)), HasSubstr("a.ies"));
}

TEST(GltfCamera, LooksAlongMinusZWithXOnTheRight) {
    const auto scene = read_gltf(
        with_triangle(R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"aspectRatio":2,"znear":0.1}}],
      "scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"camera":0,"translation":[0,0,4],"scale":[2,2,2]}],)"));
    ASSERT_TRUE(scene.camera_given);
    EXPECT_EQ(transform_direction(scene.camera.to_world, {0, 0, 1}), (Vec3{0, 0, -1}));
    EXPECT_EQ(transform_direction(scene.camera.to_world, {1, 0, 0}), (Vec3{1, 0, 0}));
    EXPECT_NEAR(scene.camera.fov, 57.29578f, 1e-3f);
    EXPECT_EQ(scene.film.width, 2 * scene.film.height);
    EXPECT_THAT(
        errors_of_gltf(with_triangle(R"("cameras":[{"perspective":{"yfov":9}}],"nodes":[{"mesh":0},{"camera":0}],)")),
        HasSubstr("cameras[0].perspective.yfov must lie"));
}

TEST(GltfCamera, IsTheFirstOfSeveralThatCanBeChosenByName) {
    const auto scene = read_gltf(with_triangle(
        R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"aspectRatio":2,"znear":0.1}},
                      {"name":"own","type":"perspective","perspective":{"yfov":0.5,"aspectRatio":1,"znear":0.1}}],
      "nodes":[{"mesh":0},{"camera":0,"name":"front"},{"camera":1,"translation":[0,0,4]}],"scenes":[{"nodes":[0,1,2]}],)"));
    ASSERT_THAT(scene.cameras, SizeIs(2));
    EXPECT_EQ(scene.cameras[0].name, "front") << "by its node";
    EXPECT_EQ(scene.cameras[1].name, "own");
    EXPECT_EQ(scene.camera.to_world, scene.cameras[0].camera.to_world);
    EXPECT_EQ(scene.film.width, 2 * scene.film.height);
    EXPECT_EQ(scene.cameras[1].film.width, scene.film.height);
    for (const auto& warning : scene.warnings)
        EXPECT_EQ(warning.what.find("camera"), std::string::npos) << warning.what;
}

TEST(GltfMistakes, AreAllSaidWithTheirPaths) {
    const std::string errors =
        errors_of_gltf(document(R"("nodes":[{"mesh":7},{"mesh":0,"translation":[1,2]},{"mesh":1}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":9}}]},{"primitives":[{"attributes":{"POSITION":0},"indices":0,"material":-1}]}],)" +
                                accessors + views));
    EXPECT_THAT(errors, HasSubstr("a.glb: nodes[0].mesh index 7 is out of range: there are 2"));
    EXPECT_THAT(errors, HasSubstr("nodes[1].translation must have 3 numbers"));
    EXPECT_THAT(errors, HasSubstr("meshes[0].primitives[0].attributes.POSITION index 9 is out of range: there are 4"));
    EXPECT_THAT(errors, HasSubstr("accessors[0].componentType must be a type of whole numbers"));
}

TEST(GltfMistakes, InBuffersReachBeyondThem) {
    const auto error = [](const std::string& accessor, const std::string& view = R"({"buffer":0,"byteLength":36})") {
        return errors_of_gltf(
            document(one_node + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[)" +
                     accessor + R"(],"bufferViews":[)" + view + R"(],"buffers":[{"byteLength":80}])"));
    };
    EXPECT_THAT(error(R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})"),
                HasSubstr("accessors[0] reaches beyond its buffer view"));
    EXPECT_THAT(error(R"({"bufferView":0,"componentType":5126,"count":9e14,"type":"VEC3"})"),
                HasSubstr("accessors[0] reaches beyond"));
    EXPECT_THAT(error(R"({"componentType":5126,"count":900000000000,"type":"VEC3"})"),
                HasSubstr("asks for far more than the file holds"));
    EXPECT_THAT(error(R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})",
                      R"({"buffer":0,"byteOffset":50,"byteLength":36})"),
                HasSubstr("bufferViews[0] reaches beyond its buffer"));
    EXPECT_THAT(error(R"({"bufferView":0,"componentType":99,"count":3,"type":"VEC3"})"),
                HasSubstr("is no component type"));
    EXPECT_THAT(errors_as("a.glb", glb(with_triangle(one_node), "1234")),
                HasSubstr("buffers[0] has 4 bytes, but promises 80"));
    std::string nan = bytes;
    nan.replace(0, 4, raw(std::nanf("")));
    EXPECT_THAT(errors_as("a.glb", glb(with_triangle(one_node), nan)), HasSubstr("a position that is not finite"));
    std::string far = bytes;
    far.replace(36, 2, raw(std::uint16_t{77}));
    EXPECT_THAT(errors_as("a.glb", glb(with_triangle(one_node), far)),
                HasSubstr("the vertex index 77, but there are 3 vertices"));
}

TEST(GltfMistakes, InTheTreeAreNoLoops) {
    EXPECT_THAT(errors_of_gltf(
                    with_triangle(R"("nodes":[{"mesh":0,"children":[1]},{"children":[0]}],"scenes":[{"nodes":[0]}],)")),
                HasSubstr("nodes[1].children[0] names node 0, which stands elsewhere already"));
}

TEST(GltfMaterial, NamesColoursThatReflectMoreThanAll) {
    const auto of = [](const std::string& factor) {
        return warnings_of(read_gltf(
            with_triangle(R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[)" + factor + "]}}]," + one_node,
                          R"({"attributes":{"POSITION":0},"material":0})")));
    };
    EXPECT_THAT(of("1, 0.5, 0, 1"), Not(HasSubstr("above 1")));
    EXPECT_THAT(of("2, 0.5, 0, 1"), HasSubstr("a baseColorFactor is above 1"));
}

TEST(Gltf, NamesWhatItNeedsOfLaterVersions) {
    const auto of = [](const std::string& least) {
        std::string json = with_triangle(one_node);
        const std::string asset = R"("version":"2.0")";
        return warnings_of(
            read_gltf(json.replace(json.find(asset), asset.size(), asset + R"(,"minVersion":")" + least + '"')));
    };
    EXPECT_THAT(of("2.0"), Not(HasSubstr("asks for")));
    EXPECT_THAT(of("2.1"), HasSubstr("it asks for glTF 2.1"));
}

TEST(GltfMistakes, InTheContainerAreRefused) {
    EXPECT_THAT(errors_as("a.gltf", "{"), HasSubstr("malformed JSON: not sound at byte 2"));
    EXPECT_THAT(errors_as("a.gltf", "{}"), HasSubstr("asset.version is missing"));
    EXPECT_THAT(errors_as("a.gltf", R"({"asset":{"version":"1.0"}})"), HasSubstr("only glTF 2.0 is read"));
    EXPECT_THAT(errors_as("a.gltf", R"({"asset":{"version":"2.0","extras":)" + std::string(500000, '[') + "}}"),
                HasSubstr("nested too deeply"));
    EXPECT_THAT(errors_as("a.glb", "glTF"), HasSubstr("the .glb ends early"));
    EXPECT_THAT(errors_as("a.glb", "glTF" + raw(2u, 30u, 0xFFFFFFF0u, 0x4E4F534Au) + std::string(10, ' ')),
                HasSubstr("the .glb ends early"));
    EXPECT_THAT(errors_of_gltf(with_triangle(R"("extensionsRequired":["KHR_texture_basisu_of_tomorrow"],)" + one_node)),
                HasSubstr("the file needs the extension 'KHR_texture_basisu_of_tomorrow', which is not supported"));
    EXPECT_THAT(warnings_of(read_gltf(with_triangle(
                    R"("materials":[{}],"extensionsUsed":["KHR_materials_volume_scatter"],)" + one_node))),
                HasSubstr("extension 'KHR_materials_volume_scatter' is left out"));
}

}  // namespace
}  // namespace lightnet::test::gltf_reader_test
