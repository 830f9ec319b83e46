// Scenes come from anywhere, and what they name is sent to hosts: it should be theirs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/error.hpp"
#include "core/readers/read_scene.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::outside_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string gltf_with(const std::string& uri) {
    return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":")" + uri +
           R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]})";
}

std::string refusal_of(const std::string& scene) {
    DiskFiles files;
    try {
        read_scene(files, scene);
        return "";
    } catch (const UserError& error) {
        return error.what();
    }
}

std::string warnings_of(const std::string& scene) {
    DiskFiles files;
    std::string all;
    for (const auto& warning : read_scene(files, scene).warnings)
        if (warning.what.find("outside") != std::string::npos) all += to_string(warning) + "\n";
    return all;
}

TEST(FilesOutside, AreNotForGltf) {
    const test::Folder folder;
    const std::string bytes(36, '\x01');
    folder.write("home/id_rsa", bytes);
    folder.write("model/below/x.bin", bytes);
    fs::create_symlink(folder / "home", folder / "model" / "way");
    const auto refusal = [&](const std::string& uri) {
        return refusal_of(folder.write("model/x.gltf", gltf_with(uri)));
    };
    EXPECT_THAT(refusal("below/x.bin"), IsEmpty());
    EXPECT_THAT(refusal("below/../below/x.bin"), IsEmpty());
    for (const std::string uri : {"../home/id_rsa", "%2e%2e/home/id_rsa", "below/../../home/id_rsa", "way/id_rsa"})
        EXPECT_THAT(refusal(uri), HasSubstr("outside of the scene's folder")) << uri;
    EXPECT_THAT(refusal((folder / "home" / "id_rsa").string()), HasSubstr("outside of the scene's folder"));
    folder.write("model/x.gltf", gltf_with("below/x.bin"));
    fs::create_symlink(folder / "model" / "x.gltf", folder / "model" / "link.gltf");
    EXPECT_THAT(refusal_of(folder / "model" / "link.gltf"), IsEmpty());
    const auto before = fs::current_path();
    fs::current_path(folder / "model");
    EXPECT_THAT(refusal_of("x.gltf"), IsEmpty());
    fs::current_path(before);
}

TEST(FilesOutside, AreSaidOnceInOtherFormats) {
    const test::Folder folder;
    for (const char* name : {"a", "b"}) folder.write(std::string("shared/") + name + ".mtl", "newmtl m\n");
    const auto outside =
        folder.write("model/x.obj", std::string("mtllib ../shared/a.mtl\nmtllib ../shared/b.mtl\n") + triangle);
    EXPECT_THAT(warnings_of(outside), AllOf(HasSubstr("reads files outside of its folder, such as '"),
                                            HasSubstr("shared/a.mtl': hosts are"), testing::Not(HasSubstr("b.mtl"))));
    folder.write("model/materials/a.mtl", "newmtl m\n");
    EXPECT_THAT(warnings_of(folder.write("model/y.obj", std::string("mtllib materials/a.mtl\n") + triangle)),
                IsEmpty());
}

TEST(FilesOutside, AreToldFromOthersByNameOnHosts) {
    EXPECT_TRUE(lies_within("a", "a/b/c"));
    EXPECT_TRUE(lies_within("", "b"));
    EXPECT_TRUE(lies_within("../a", "../a/b"));
    EXPECT_TRUE(lies_within("/a", "/a/../a/b"));
    EXPECT_FALSE(lies_within("a", "ab"));
    EXPECT_FALSE(lies_within("a", "a/../b"));
    EXPECT_FALSE(lies_within("/a", "/b"));
    EXPECT_FALSE(lies_within("a", "/a/b"));
}

}  // namespace
}  // namespace lightnet::outside_test
