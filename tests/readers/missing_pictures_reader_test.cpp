// Pictures that can't be read are mid-grey in scenes of every format, and each is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/readers/files/files.hpp"
#include "core/scene/textures/look_up.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/picture_kinds.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::missing_pictures_reader_test {
namespace {

using testing::HasSubstr;

const MemoryFiles all_bad{{"broken.png", "\x89PNG\r\n\x1A\nand no more"}, {"unknown.png", "hello, no picture at all"}};
const std::pair<const char*, const char*> bad[] = {
    {"gone.png", "no such file"}, {"broken.png", "PNG: "}, {"unknown.png", "not an image of a known format"}};

void expect_grey(const SceneData& scene, TextureId texture, const std::string& name, const std::string& why) {
    EXPECT_EQ(look_up(scene.textures, texture, {{0.3f, 0.8f}}), (Rgb{0.5f, 0.5f, 0.5f})) << name;
    EXPECT_THAT(warnings_of(scene), testing::AllOf(HasSubstr(name), HasSubstr(why), HasSubstr("mid-grey is taken")));
}

TEST(MissingPictures, AreGreyInMitsubasScenes) {
    for (const auto& [name, why] : bad) {
        const std::string file = "<string name='filename' value='" + std::string(name) + "'/>";
        const auto scene = read_mitsuba("<emitter type='envmap'>" + file +
                                            "</emitter><shape type='rectangle'><bsdf type='diffuse'><texture "
                                            "name='reflectance' type='bitmap'>" +
                                            file + "</texture></bsdf></shape>",
                                        all_bad);
        expect_grey(scene, model_of<DiffuseMaterial>(scene).reflectance, name, why);
        EXPECT_EQ(scene.environments.at(0).image->colour(0, 0), (Rgb{0.5f, 0.5f, 0.5f}));
    }
}

TEST(StrangePictures, HaveSoundNumbersAndAreNamed) {
    const float infinite = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
    std::string text = "PF\n1 1\n-1\n";
    for (const float number : {infinite, none, 0.25f}) text.append(reinterpret_cast<const char*>(&number), 4);
    const MemoryFiles files{{"s.pfm", text}};
    const auto expect_sound = [](const SceneData& scene, TextureId texture) {
        EXPECT_EQ(look_up(scene.textures, texture, {{0.5f, 0.5f}}), (Rgb{65504, 0, 0.25f}));
        EXPECT_THAT(warnings_of(scene),
                    HasSubstr("s.pfm': 1 of its pixels are infinite or no numbers: 65504 and 0 are taken"));
    };
    const auto xml = read_mitsuba_bsdf(
        "<bsdf type='diffuse'><texture type='bitmap' name='reflectance'><string name='filename' value='s.pfm'/>"
        "</texture></bsdf>",
        files);
    expect_sound(xml, model_of<DiffuseMaterial>(xml).reflectance);
    const auto pbrt = read_world(
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"s.pfm\"\nMaterial \"diffuse\" "
        "\"texture reflectance\" \"t\"\nShape \"sphere\"\n",
        files);
    expect_sound(pbrt, model_of<DiffuseMaterial>(pbrt).reflectance);
    MemoryFiles with_library = files;
    with_library.add("m.mtl", "newmtl a\nmap_Kd s.pfm\n");
    const auto obj = read_as("m.obj", "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", with_library);
    expect_sound(obj, model_of<DiffuseMaterial>(obj).reflectance);
}

std::string pfm_of(const std::vector<float>& numbers) {
    std::string text = "PF\n" + std::to_string(numbers.size() / 3) + " 1\n-1\n";
    for (const float number : numbers) text.append(reinterpret_cast<const char*>(&number), 4);
    return text;
}

TEST(StrangePictures, BelowBlackAreNamedButForRelief) {
    const MemoryFiles files{{"s.pfm", pfm_of({-1, 0.5f, 0.5f, 0.25f, 0.25f, -2, 1, 1, 1})}};
    const auto expect_named = [](const SceneData& scene) {
        EXPECT_THAT(warnings_of(scene), HasSubstr("s.pfm': 2 of its pixels are negative: 0 is taken"));
    };
    const auto expect_silent = [](const SceneData& scene) {
        EXPECT_THAT(warnings_of(scene), testing::Not(HasSubstr("negative")));
    };
    const auto bitmap = [](const std::string& name) {
        return "<texture type='bitmap' name='" + name + "'><string name='filename' value='s.pfm'/></texture>";
    };
    expect_named(read_mitsuba_bsdf("<bsdf type='diffuse'>" + bitmap("reflectance") + "</bsdf>", files));
    expect_named(read_mitsuba(
        "<shape type='sphere'/><emitter type='envmap'><string name='filename' value='s.pfm'/></emitter>", files));
    for (const std::string relief : {"normalmap", "bumpmap"})
        expect_silent(
            read_mitsuba_bsdf("<bsdf type='" + relief + "'>" + bitmap("map") + "<bsdf type='diffuse'/></bsdf>", files));

    expect_named(read_world("LightSource \"infinite\" \"string filename\" \"s.pfm\"\n", files));
    const std::string pictured = "\"imagemap\" \"string filename\" \"s.pfm\"\n";
    expect_named(read_world("Texture \"a\" \"spectrum\" " + pictured +
                                "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" 2\n"
                                "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n",
                            files));
    expect_silent(read_world("Texture \"t\" \"float\" " + pictured +
                                 "Material \"diffuse\" \"texture displacement\" \"t\"\nShape \"sphere\"\n",
                             files));
    expect_silent(read_world("Material \"diffuse\" \"string normalmap\" \"s.pfm\"\nShape \"sphere\"\n", files));

    const auto obj = [&](const std::string& key) {
        MemoryFiles all = files;
        all.add("m.mtl", "newmtl a\n" + key + " s.pfm\n");
        return read_as("m.obj", "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", all);
    };
    expect_named(obj("map_Kd"));
    expect_silent(obj("norm"));
    expect_silent(obj("bump"));
}

TEST(MissingPictures, AreGreyInPbrtsScenes) {
    for (const auto& [name, why] : bad) {
        const std::string file = "\"string filename\" \"" + std::string(name) + "\"";
        const auto scene =
            read_world("LightSource \"infinite\" " + file + "\nTexture \"t\" \"spectrum\" \"imagemap\" " + file +
                           "\nMaterial \"diffuse\" \"texture reflectance\" \"t\" \"string normalmap\" \"" + name +
                           "\"\nShape \"sphere\"\n",
                       all_bad);
        expect_grey(scene, model_of<DiffuseMaterial>(scene).reflectance, name, why);
        EXPECT_EQ(scene.environments.at(0).image->colour(0, 0), (Rgb{0.5f, 0.5f, 0.5f}));
    }
}

SceneData gltf_with(const std::string& image, const std::string& texture, MemoryFiles files,
                    const std::string& more = "") {
    files.add("p.bin", std::string(36, '\0'));
    return read_as("a.gltf",
                   R"({"asset":{"version":"2.0"},)" + more +
                       R"("buffers":[{"byteLength":36,"uri":"p.bin"}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],
        "images":[)" + image +
                       R"(],"textures":[)" + texture +
                       R"(],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}]})",
                   std::move(files));
}

const std::string dot_of_hdr =
    "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\0\0\x81", 4);  // red

TEST(MissingPictures, AreLookedForAsTheirMachineCalledThem) {
    for (const std::string name : {"tex/Wood.PNG", "C:/textures/wood.hdr", "TEX/WOOD.hdr"}) {
        const MemoryFiles files{{"tex/wood.PNG", dot_of_hdr}, {"wood.hdr", dot_of_hdr}, {"tex/wood.hdr", dot_of_hdr}};
        const auto xml = read_mitsuba_bsdf(
            "<bsdf type='diffuse'><texture type='bitmap' name='reflectance'><string "
            "name='filename' value='" +
                name + "'/></texture></bsdf>",
            files);
        const auto& texture = xml.textures[model_of<DiffuseMaterial>(xml).reflectance];
        EXPECT_EQ(std::get<ImageTexture>(texture.pattern).image->colour(0, 0).r, 1) << name;
        EXPECT_THAT(warnings_of(xml), HasSubstr("no such file: '")) << name;
        const auto pbrt = read_as("scene.pbrt",
                                  "WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + name +
                                      "\" Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"",
                                  files);
        EXPECT_EQ(std::get<ImageTexture>(pbrt.textures[model_of<DiffuseMaterial>(pbrt).reflectance].pattern)
                      .image->colour(0, 0)
                      .r,
                  1)
            << name;
        EXPECT_THAT(warnings_of(pbrt), HasSubstr("is taken")) << name;
    }
}

TEST(MissingPictures, AreGreyInGltf) {
    for (const auto& [name, why] : bad) {
        const auto scene = gltf_with(R"({"uri":")" + std::string(name) + "\"}", R"({"source":0})", all_bad);
        expect_grey(scene, model_of<PrincipledMaterial>(scene).base_colour, "images[0]", why);
    }
    const auto outside = gltf_with(R"({"uri":"../../secret.png"})", R"({"source":0})", {{"../../secret.png", "x"}});
    expect_grey(outside, model_of<PrincipledMaterial>(outside).base_colour, "images[0]",
                "outside of the scene's folder");
    const auto data = gltf_with(R"({"uri":"data:image/png;base64,*"})", R"({"source":0})", {});
    expect_grey(data, model_of<PrincipledMaterial>(data).base_colour, "images[0]", "is no base64 data");
}

TEST(Gltf, TakesPicturesOfWebP) {
    const auto scene = gltf_with(R"({"uri":"gone.png"},{"uri":"a.webp"})",
                                 R"({"source":0,"extensions":{"EXT_texture_webp":{"source":1}}})",
                                 {{"a.webp", webp(true, false)}}, R"("extensionsRequired":["EXT_texture_webp"],)");
    EXPECT_THAT(warnings_of(scene),
                testing::AllOf(testing::Not(HasSubstr("images[")), testing::Not(HasSubstr("source"))));
    const auto& texture = scene.textures[model_of<PrincipledMaterial>(scene).base_colour];
    EXPECT_EQ(std::get<ImageTexture>(texture.pattern).image->width, Wheel::width);
}

TEST(Gltf, TakesWhatStandsInForBasisUniversal) {
    const MemoryFiles files{{"a.webp", webp(true, false)}, {"b.ktx2", ktx({.format = 0, .packing = 1}, "x")}};
    const std::string images = R"({"uri":"a.webp"},{"uri":"b.ktx2"})";
    const auto with = gltf_with(images, R"({"source":0,"extensions":{"KHR_texture_basisu":{"source":1}}})", files);
    const auto& texture = with.textures[model_of<PrincipledMaterial>(with).base_colour];
    EXPECT_EQ(std::get<ImageTexture>(texture.pattern).image->width, Wheel::width);
    const auto without = gltf_with(images, R"({"extensions":{"KHR_texture_basisu":{"source":1}}})", files,
                                   R"("extensionsRequired":["KHR_texture_basisu"],)");
    expect_grey(without, model_of<PrincipledMaterial>(without).base_colour, "images[1]", "Basis Universal");
}

/// A cache that has lost a file.
class LosingFiles final : public Files {
public:
    Bytes read(const std::string& path) override {
        if (path == "a.obj") return bytes_of("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
        if (path == "m.mtl") return bytes_of("newmtl a\nmap_Kd lost.png\n");
        throw MissingHere(path, "the cache has lost it");
    }
    std::optional<std::string> like(const std::string&) override { return std::nullopt; }
};

// or this host's picture would be another one
// Included files, meshes and spectra: in other letters, or beside the file that names them.
TEST(NamedFiles, AreFoundAsTheirMachineCalledThem) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
        "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const MemoryFiles files{
        {"sub/Part.pbrt", "Include \"deep.pbrt\"\n"},
        {"sub/deep.pbrt", "Shape \"plymesh\" \"string filename\" \"MESH.ply\"\n"},
        {"sub/mesh.ply", ply},
        {"sub/part.xml", "<scene><shape type='ply'><string name='filename' value='Mesh.PLY'/></shape></scene>"},
        {"sub/round.pbrt", "Include \"round.pbrt\"\n"}};
    const auto pbrt = read_world("Include \"SUB/part.pbrt\"\n", files);
    EXPECT_EQ(pbrt.shapes.size(), 1u);
    EXPECT_THAT(warnings_of(pbrt),
                testing::AllOf(HasSubstr("'sub/Part.pbrt' is taken"), HasSubstr("'sub/deep.pbrt' is taken"),
                               HasSubstr("'sub/mesh.ply' is taken")));
    const auto xml = read_mitsuba("<include filename='Sub/part.xml'/>", files);
    EXPECT_EQ(xml.shapes.size(), 1u);
    EXPECT_THAT(warnings_of(xml), HasSubstr("'sub/mesh.ply' is taken"));
    EXPECT_THAT(errors_as("a.pbrt", "WorldBegin\nInclude \"sub/round.pbrt\"\n", files), HasSubstr("includes itself"));
    EXPECT_THAT(errors_as("a.pbrt", "WorldBegin\nInclude \"none.pbrt\"\n", files), HasSubstr("can't read 'none.pbrt'"));
}

TEST(MissingPictures, EndTheWorkWhereOneMachineAloneMissesThem) {
    LosingFiles files;
    EXPECT_THROW(read_scene(files, "a.obj"), MissingHere);
}

TEST(DiskFiles, FindNamesOfAnotherCase) {
    const Folder folder;
    folder.write("Maps/Wood.PNG", "x");
    folder.write("Maps/stone.png", "y");
    DiskFiles files;
    EXPECT_EQ(files.like((folder / "maps/wood.png").string()), (folder / "Maps/Wood.PNG").string());
    EXPECT_EQ(files.like((folder / "Maps/stone.png").string()), (folder / "Maps/stone.png").string());
    EXPECT_FALSE(files.like((folder / "maps/stones.png").string()));
    EXPECT_FALSE(files.like((folder / "MAPS").string()));
}

}  // namespace
}  // namespace lightnet::test::missing_pictures_reader_test
