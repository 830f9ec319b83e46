// Nothing that a glTF file says goes by in silence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/json.hpp"
#include "tests/support/gltf_text.hpp"

namespace lightnet::test::gltf_left_out_reader_test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string map = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x80\x80\x81", 4);
const std::string info = R"({"index":0,"texCoord":0,"extensions":{"KHR_texture_transform":{"offset":[0,0],"rotation":0,
    "scale":[1,1],"texCoord":0}}})";

/// A scene with all that is read, each object once at least.
std::string everything() {
    std::string text = R"("scene":0,"scenes":[{"nodes":[0,1,2,3,4]}],"nodes":[{"mesh":0,"skin":0,"weights":[0.5]},
      {"mesh":1,"extensions":{"KHR_node_visibility":{"visible":true},"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}},
      {"camera":0,"translation":[0,0,3],"rotation":[0,0,0,1],"scale":[1,1,1],"extensions":{"KHR_lights_punctual":{"light":0}}},
      {"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"children":[5]},{"camera":1},{}],
    "cameras":[{"type":"perspective","perspective":{"yfov":1,"aspectRatio":1,"znear":0.1,"zfar":9}},
      {"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0.1,"zfar":9}}],
    "skins":[{"joints":[5],"inverseBindMatrices":4,"skeleton":5}],
    "extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","color":[1,1,1],"intensity":1,"spot":{"innerConeAngle":0,"outerConeAngle":1}}]},
      "KHR_materials_variants":{"variants":[{"name":"a"}]}},
    "images":[{"uri":"p.hdr","mimeType":"image/hdr"}],"samplers":[{"magFilter":9729,"minFilter":9987,"wrapS":10497,"wrapT":10497}],
    "textures":[{"source":0,"sampler":0}],
    "meshes":[{"weights":[1],"primitives":[{"mode":4,"material":0,"indices":3,"attributes":{"POSITION":0,"TEXCOORD_0":1,"JOINTS_0":2,
        "WEIGHTS_0":5,"_OWN":1},"targets":[{"POSITION":0}],"extensions":{"KHR_materials_variants":{"mappings":[{"material":0,"variants":[0]}]}}}]},
      {"primitives":[{"material":1,"attributes":{"POSITION":0,"TEXCOORD_0":1}}]}],
    "materials":[{"alphaMode":"MASK","alphaCutoff":0.5,"doubleSided":true,"emissiveFactor":[1,1,1],"normalTexture":INFO,"emissiveTexture":INFO,
      "pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1],"baseColorTexture":INFO,"metallicFactor":0,"roughnessFactor":1,"metallicRoughnessTexture":INFO},
      "extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatTexture":INFO,"clearcoatRoughnessFactor":0,
          "clearcoatRoughnessTexture":INFO,"clearcoatNormalTexture":INFO},
        "KHR_materials_sheen":{"sheenColorFactor":[1,1,1],"sheenColorTexture":INFO,"sheenRoughnessFactor":1,"sheenRoughnessTexture":INFO},
        "KHR_materials_specular":{"specularFactor":1,"specularTexture":INFO,"specularColorFactor":[1,1,1],"specularColorTexture":INFO},
        "KHR_materials_anisotropy":{"anisotropyStrength":1,"anisotropyRotation":1,"anisotropyTexture":INFO},
        "KHR_materials_iridescence":{"iridescenceFactor":1,"iridescenceTexture":INFO,"iridescenceIor":1.3,"iridescenceThicknessMinimum":1,
          "iridescenceThicknessMaximum":9,"iridescenceThicknessTexture":INFO},
        "KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":1,"diffuseTransmissionTexture":INFO,
          "diffuseTransmissionColorFactor":[1,1,1],"diffuseTransmissionColorTexture":INFO},
        "KHR_materials_transmission":{"transmissionFactor":0,"transmissionTexture":INFO},"KHR_materials_ior":{"ior":1.5},
        "KHR_materials_volume":{"thicknessFactor":1,"thicknessTexture":INFO,"attenuationDistance":1,"attenuationColor":[1,1,1]},
        "KHR_materials_dispersion":{"dispersion":1},"KHR_materials_emissive_strength":{"emissiveStrength":1}}},
      {"extensions":{"KHR_materials_unlit":{}}}],)";
    for (auto at = text.find("INFO"); at != text.npos; at = text.find("INFO")) text.replace(at, 4, info);
    return text;
}

GltfText buffers() {
    GltfText text = triangle_text();
    text.vectors("VEC2", {0, 0, 1, 0, 0, 1});
    text.accessor<std::uint8_t>("VEC4", 5121, std::vector<std::uint8_t>(12), 3);
    text.accessor<std::uint8_t>("SCALAR", 5121, {0, 1, 2}, 3, R"(,"min":[0],"max":[2])");
    text.vectors("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    text.vectors("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    return text;
}
std::string warnings(const std::string& json) {
    return warnings_of(read_as("a.glb", buffers().file(json), {{"p.hdr", map}}));
}

TEST(GltfLeftOut, IsNothingOfWhatIsRead) { EXPECT_THAT(warnings(everything()), Not(HasSubstr("is left out"))); }

/// The text with one more member in the object that begins at `brace`.
std::string with_more(const std::string& text, std::size_t brace) {
    const bool empty = text[brace + 1] == '}';
    return text.substr(0, brace + 1) + R"("strange":1)" + (empty ? "" : ",") + text.substr(brace + 1);
}

TEST(GltfLeftOut, IsNamedWhereverItStands) {
    const std::string text = everything();
    std::size_t objects = 0;
    for (auto brace = text.find('{'); brace != text.npos; brace = text.find('{', brace + 1)) {
        const std::string before = text.substr(0, brace);
        // names of one's own, and what is not looked into as nothing is read of it
        if (before.ends_with(R"("attributes":)") || before.ends_with(R"("targets":[)")) continue;
        if (const auto inside = before.rfind("thicknessTexture"); inside != before.npos && brace - inside < 150)
            continue;
        EXPECT_THAT(warnings(with_more(text, brace)), HasSubstr("strange' is left out"))
            << before.substr(brace > 60 ? brace - 60 : 0);
        ++objects;
    }
    EXPECT_GT(objects, 80u);
}

TEST(GltfLeftOut, IsNamedByItsPath) {
    EXPECT_THAT(
        warnings(
            R"("extensions":{"FOO_bar":{"a":1}},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},
        "extensions":{"FOO_cut":{"by":1}}}]}],)"),
        testing::AllOf(HasSubstr("'extensions.FOO_bar' is left out"),
                       HasSubstr("'meshes.primitives.extensions.FOO_cut' is left out")));
}

TEST(GltfLeftOut, IsSaidOnceWhereTheFileNamesTheExtension) {
    const std::string said =
        warnings(R"("extensionsUsed":["FOO_cut"],"nodes":[{"mesh":0,"extensions":{"FOO_cut":{"by":1}}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)");
    EXPECT_THAT(said, HasSubstr("extension 'FOO_cut' is left out"));
    EXPECT_THAT(said, Not(HasSubstr("nodes.extensions")));
}

TEST(GltfLeftOut, IsNotWhatNoPictureShows) {
    const std::string said = warnings(
        R"("extensionsUsed":["KHR_xmp_json_ld"],"extensionsRequired":["KHR_xmp_json_ld"],"extensions":{"KHR_xmp_json_ld":
        {"packets":[{"a":1}]}},"nodes":[{"mesh":0}],"meshes":[{"extensions":{"KHR_xmp_json_ld":{"packet":0}},
        "primitives":[{"attributes":{"POSITION":0}}]}],)");
    EXPECT_THAT(said, Not(HasSubstr("left out")));
}

TEST(GltfLeftOut, AreRanges) {
    const std::string said = warnings(R"("nodes":[{"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}}],
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","range":3}]}},
        "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1}}]}],)");
    EXPECT_THAT(said, HasSubstr("ranges of lights are left out"));
}

}  // namespace
}  // namespace lightnet::test::gltf_left_out_reader_test
