// The scene that ships with the project; and scenes that others made, where a folder with them is known
// (references.hpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/pbrt_text.hpp"

namespace lightnet::test::real_scenes_reader_test {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

std::size_t triangles_of(const SceneData& scene) {
    std::size_t count = 0;
    for (const auto& shape : scene.shapes)
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) count += mesh->triangles.size();
    return count;
}

TEST(CornellBox, ShipsWithTheProject) {
    DiskFiles files;
    const auto scene = read_scene(files, std::string(LIGHTNET_GRAPHS) + "/cornell_box.pbrt");
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_THAT(scene.shapes, SizeIs(8));
    EXPECT_EQ(triangles_of(scene), 32u);
    EXPECT_EQ(scene.shapes[0].emission->radiance, (Rgb{17, 12, 4}));
    EXPECT_LT(normal_of(mesh_of(scene)).y, -0.999f);  // the lamp shines down
    EXPECT_THAT(files.seen(), SizeIs(1));
}

TEST(DiskFiles, RememberWhatWasRead) {
    DiskFiles files;
    const std::string path = std::string(LIGHTNET_GRAPHS) + "/cornell_box.pbrt";
    const Bytes bytes = files.read(path);
    EXPECT_EQ(files.read(path), bytes);  // the very same
    EXPECT_EQ(files.seen().at(path), bytes);
    EXPECT_THROW(files.read(path + ".not"), Error);
    EXPECT_THROW(files.read(LIGHTNET_GRAPHS), Error);  // a folder
    EXPECT_THAT(files.seen(), SizeIs(1));
}

TEST(Beside, IsInTheFolderOfTheOther) {
    EXPECT_EQ(beside("a/b.pbrt", "c/d.ply"), "a/c/d.ply");
    EXPECT_EQ(beside("b.pbrt", "d.ply"), "d.ply");
    EXPECT_EQ(beside("a/b.pbrt", "../d.ply"), "d.ply");
    EXPECT_EQ(beside("a/b.pbrt", "/x/./d.ply"), "/x/d.ply");
}

#ifdef LIGHTNET_SHARED_FOLDER
const std::string shared_scenes = LIGHTNET_SHARED_FOLDER "/scenes/";

TEST(RealScenes, VeachAjarIsReadCompletely) {
    DiskFiles files;
    const auto scene = read_scene(files, shared_scenes + "veach-ajar-pbrt/veach-ajar.pbrt");
    EXPECT_EQ(triangles_of(scene), 382'690u);
    EXPECT_THAT(scene.shapes, SizeIs(22));
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_THAT(files.seen(), SizeIs(21));  // main file, 17 meshes, 3 pictures
    std::size_t pictures = 0;
    for (const auto& texture : scene.textures) pictures += std::holds_alternative<ImageTexture>(texture.pattern);
    EXPECT_EQ(pictures, 3u);
}

TEST(RealScenes, CornellBoxesAndVeachMisAreReadWithoutWarnings) {
    for (const char* name : {"cornell-box-pbrt/cornell-box.pbrt", "cornell-box-pbrt/cornell-box-silver.pbrt",
                             "cornell-box-pbrt/cornell-box-specular.pbrt", "cornell-box-pbrt/smallpt.pbrt",
                             "veach-mis-pbrt/veach-mis.pbrt", "veach-mis-pbrt/veach-mis-colorized.pbrt"}) {
        DiskFiles files;
        const auto scene = read_scene(files, shared_scenes + name);
        EXPECT_THAT(scene.warnings, IsEmpty()) << name;
        EXPECT_GE(scene.shapes.size(), 8u) << name;
    }
}
#endif

}  // namespace
}  // namespace lightnet::test::real_scenes_reader_test
