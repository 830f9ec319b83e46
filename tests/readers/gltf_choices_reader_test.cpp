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
    return read_as("a.glb",
                   text.file(R"("nodes":[{"mesh":0}],"images":[{"uri":"p.hdr"}],"samplers":[{"magFilter":9728}],
        "textures":[{"source":0,"sampler":0}],"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":0)" +
                             attributes + R"(}}]}],"materials":[{)" + material + "}],"),
                   {{"p.hdr", map}});
}
Rgb seen(const SceneData& scene, TextureId texture) {
    const Mesh& mesh = mesh_of(scene);
    TexturePlace place{mesh.uvs[0]};
    if (!mesh.second_uvs.empty()) place.second_uv = mesh.second_uvs[0];
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

TEST(GltfTextureCoordinates, ThatAreNotThereOrTooManyAreNamed) {
    EXPECT_THAT(warnings_of(with_sets(R"("emissiveFactor":[1,1,1],"emissiveTexture":{"index":0,"texCoord":1})", "")),
                HasSubstr("lacks the texture coordinates that its material asks for"));
    EXPECT_THAT(warnings_of(with_sets(R"("emissiveFactor":[1,1,1],"emissiveTexture":{"index":0,"texCoord":1},
        "pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0,"texCoord":2}})")),
                HasSubstr("on more than two sets of texture coordinates"));
}

}  // namespace
}  // namespace lightnet::test::gltf_choices_reader_test
