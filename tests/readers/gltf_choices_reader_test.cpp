// What glTF lets one choose from: variants of materials, and sets of texture coordinates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/textures/look_up.hpp"
#include "tests/support/gltf_text.hpp"

namespace lightnet::test::gltf_choices_reader_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

const std::string with_variants =
    R"("extensionsRequired":["KHR_materials_variants"],"nodes":[{"mesh":0}],
    "extensions":{"KHR_materials_variants":{"variants":[{"name":"beach"},{"name":"night"},{"name":"dawn"}]}},
    "materials":[{"name":"own"},{"name":"sand"},{"name":"dark","emissiveFactor":[1,1,1]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0,"extensions":{"KHR_materials_variants":{"mappings":
      [{"material":1,"variants":[0]},{"material":2,"variants":[2,1]}]}}}]}],)";

SceneData read_variant(const std::string& name) {
    MemoryFiles files;
    files.add("a.glb", triangle_text().file(with_variants));
    return read_scene(files, "a.glb", {{"variant", name}});
}
std::string material_in(const std::string& variant) {
    const auto scene = read_variant(variant);
    return scene.materials[scene.shapes[0].material].name;
}
std::string error_in(const SceneConstants& constants, const std::string& document = with_variants) {
    MemoryFiles files;
    files.add("a.glb", triangle_text().file(document));
    try {
        read_scene(files, "a.glb", constants);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(GltfVariants, ChooseMaterials) {
    EXPECT_EQ(material_in("beach"), "sand");
    EXPECT_EQ(material_in("night"), "dark");
    EXPECT_TRUE(read_variant("dawn").shapes[0].emission);
    const auto usual = triangle_text().read(with_variants);
    EXPECT_EQ(usual.materials[usual.shapes[0].material].name, "own");
}

TEST(GltfVariants, AreListedWithTheOneThatIsShown) {
    const auto scene = read_variant("night");
    ASSERT_EQ(scene.variants.size(), 3u);
    EXPECT_EQ(scene.variants[0].name, "beach");
    EXPECT_FALSE(scene.variants[0].shown);
    EXPECT_TRUE(scene.variants[1].shown);
    for (const auto& variant : triangle_text().read(with_variants).variants) EXPECT_FALSE(variant.shown);
}

TEST(GltfVariants, ThatTheFileLacksAreMistakes) {
    EXPECT_THAT(error_in({{"variant", "beech"}}),
                HasSubstr("has no variant 'beech', but beach, night, dawn (did you mean 'beach'?)"));
    EXPECT_THAT(error_in({{"variant", "x"}},
                         R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"),
                HasSubstr("has no variants: there is no 'x'"));
    EXPECT_THAT(error_in({{"colour", "x"}}), HasSubstr("no variables but 'variant': there is no 'colour' to define"));
}

const std::string map =
    "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + std::string("\x80\0\0\x81\0\x80\0\x81", 8);

SceneData with_sets(const std::string& material, const std::string& attributes = R"(,"TEXCOORD_0":1,"TEXCOORD_1":2)") {
    GltfText text = triangle_text();
    text.vectors("VEC2", {0.25f, 0, 0.25f, 0, 0.25f, 0});
    text.vectors("VEC2", {0.75f, 0, 0.75f, 0, 0.75f, 0});
    text.vectors("VEC4", {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1});
    text.vectors("VEC4", {1, 1, 1, 0.5f, 1, 1, 1, 0.5f, 1, 1, 1, 0.5f});
    text.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    return read_as("a.glb",
                   text.file(R"("nodes":[{"mesh":0}],"images":[{"uri":"p.hdr"}],"samplers":[{"magFilter":9728}],
        "textures":[{"source":0,"sampler":0}],"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":0)" +
                             attributes + R"(}}]}],"materials":[{)" + material + "}],"),
                   {{"p.hdr", map}});
}
Rgb seen(const SceneData& scene, TextureId texture) {
    const Mesh& mesh = mesh_of(scene);
    TexturePlace place{mesh.uvs[0]};
    place.vertices.values = &mesh.values;
    return look_up(scene.textures, texture, place);
}

TEST(GltfTextureCoordinates, AreThoseThatEachImageAsksFor) {
    const Rgb red{1, 0, 0}, green{0, 1, 0};
    const auto scene = with_sets(R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"emissiveFactor":[1,1,1],
        "emissiveTexture":{"index":0,"texCoord":1})");
    EXPECT_EQ(seen(scene, model_of<PrincipledMaterial>(scene).base_colour), red);
    EXPECT_EQ(seen(scene, *scene.shapes[0].emission->texture), green);
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("coordinates")));
    const auto moved = with_sets(
        R"("emissiveFactor":[1,1,1],"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}},"emissiveTexture":
        {"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":{"texCoord":0}}})");
    EXPECT_EQ(seen(moved, model_of<PrincipledMaterial>(moved).base_colour), green);
    EXPECT_EQ(seen(moved, *moved.shapes[0].emission->texture), red);
}

TEST(GltfTextureCoordinates, OfANormalMapAreTheMainOnes) {
    const auto scene = with_sets(
        R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"normalTexture":{"index":0,"texCoord":1})");
    EXPECT_EQ(mesh_of(scene).uvs[0].x, 0.75f) << "it is turned along them";
    EXPECT_EQ(seen(scene, model_of<PrincipledMaterial>(scene).base_colour), (Rgb{1, 0, 0}));
}

TEST(GltfTextureCoordinates, ThatAreNotThereAreNamed) {
    EXPECT_THAT(warnings_of(with_sets(R"("emissiveFactor":[1,1,1],"emissiveTexture":{"index":0,"texCoord":1})", "")),
                HasSubstr("lacks the texture coordinates that its material asks for"));
}

TEST(GltfTextureCoordinates, MayBeAnyNumberOfSets) {
    const auto scene = with_sets(R"("emissiveFactor":[1,1,1],"emissiveTexture":{"index":0,"texCoord":7},
        "pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0,"texCoord":1}})",
                                 R"(,"TEXCOORD_0":1,"TEXCOORD_1":1,"TEXCOORD_7":2)");
    EXPECT_EQ(seen(scene, model_of<PrincipledMaterial>(scene).base_colour), (Rgb{1, 0, 0}));
    EXPECT_EQ(seen(scene, *scene.shapes[0].emission->texture), (Rgb{0, 1, 0}));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("coordinates")));
}

TEST(GltfTangents, AreTakenWhereSomethingIsTurnedAlongThem) {
    const std::string with_normals = R"(,"TEXCOORD_0":1,"NORMAL":5,"TANGENT":3)";
    const auto scene = with_sets(R"("normalTexture":{"index":0})", with_normals);
    ASSERT_EQ(mesh_of(scene).tangents.size(), 3u);
    EXPECT_EQ(mesh_of(scene).tangents[2].along, (Vec3{0, 1, 0}));
    EXPECT_EQ(mesh_of(scene).tangents[2].hand, -1);
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("angent")));
    const auto tangents_in = [](const std::string& material, const std::string& attributes) {
        return mesh_of(with_sets(material, attributes)).tangents.size();
    };
    EXPECT_EQ(tangents_in(R"("extensions":{"KHR_materials_anisotropy":{"anisotropyStrength":1}})", with_normals), 3u);
    EXPECT_EQ(tangents_in(R"("doubleSided":true)", with_normals), 0u) << "nothing asks for them";
    EXPECT_EQ(tangents_in(R"("normalTexture":{"index":0})", R"(,"TEXCOORD_0":1,"TANGENT":3)"), 0u)
        << "without normals they have no effect, as glTF says";
}

TEST(GltfTangents, ThatAreDamagedAreNamed) {
    const auto scene = with_sets(R"("normalTexture":{"index":0})", R"(,"TEXCOORD_0":1,"NORMAL":5,"TANGENT":5)");
    EXPECT_TRUE(mesh_of(scene).tangents.empty());
    EXPECT_THAT(warnings_of(scene), HasSubstr("tangents that are not four numbers for each vertex are left out"));
}

float opacity_in(const std::string& material) {
    const auto scene = with_sets(material, R"(,"COLOR_0":4,"TEXCOORD_0":1)");
    const auto& opacity = scene.materials[scene.shapes[0].material].opacity;
    return opacity ? seen(scene, *opacity).r : 1;
}

TEST(GltfVertexColours, HaveAnAlphaThatCounts) {
    EXPECT_EQ(opacity_in(R"("alphaMode":"BLEND")"), 0.5f);
    EXPECT_EQ(opacity_in(R"("alphaMode":"MASK","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]})"), 0.25f);
    EXPECT_EQ(opacity_in(R"("alphaMode":"OPAQUE")"), 1);
}

// Of what no primitive in the chosen variant is made, the picture shows nothing anyway.
TEST(GltfVariants, ThatAreNotChosenAreNotNamedAsLeftOut) {
    EXPECT_THAT(warnings_of(triangle_text().read(
                    R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "materials":[{"emissiveFactor":[1,1,1],"pbrMetallicRoughness":{"metallicFactor":0}}],)")),
                Not(HasSubstr("is left out")));
}

}  // namespace
}  // namespace lightnet::test::gltf_choices_reader_test
