// glTF's animations in all the ways that files have them; each value was worked out by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/readers/read_scene.hpp"
#include "tests/support/gltf_text.hpp"
#include "tests/support/memory_files.hpp"
#include "tests/support/mistake.hpp"

namespace lightnet::test::gltf_animations_reader_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

const std::string one_mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)";
const std::string one_node = R"("nodes":[{"mesh":0}],)";
const float half = std::sqrt(0.5f);

/// A channel of node `node`, whose sampler has the same number as the channel.
struct Channel {
    std::size_t input = 0, output = 0;
    std::string path = "translation", between = "LINEAR";
    std::size_t node = 0;
    std::string target{};  // instead of node and path
};
std::string animated(const std::vector<Channel>& channels, const std::string& name = "go") {
    std::string samplers, list;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const auto& c = channels[i];
        const std::string target =
            c.target.empty() ? R"("node":)" + std::to_string(c.node) + R"(,"path":")" + c.path + '"' : c.target;
        samplers += (i ? "," : "") + std::string(R"({"input":)") + std::to_string(c.input) + R"(,"output":)" +
                    std::to_string(c.output) + R"(,"interpolation":")" + c.between + R"("})";
        list += (i ? "," : "") + std::string(R"({"sampler":)") + std::to_string(i) + R"(,"target":{)" + target + "}}";
    }
    return R"({"name":")" + name + R"(","samplers":[)" + samplers + R"(],"channels":[)" + list + "]}";
}
std::string animations(const std::string& list) { return R"("animations":[)" + list + "],"; }
std::string pointer(const std::string& to) {
    return R"("path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":")" + to + R"("}})";
}

SceneData read_with(const GltfText& text, const std::string& document, const SceneConstants& constants) {
    MemoryFiles files;
    files.add("a.glb", text.file(document));
    return read_scene(files, "a.glb", constants);
}
SceneData at(const GltfText& text, const std::string& document, const std::string& seconds,
             const std::string& animation = "") {
    SceneConstants constants{{std::string(time_constant), seconds}};
    if (!animation.empty()) constants[std::string(animation_constant)] = animation;
    return read_with(text, document, constants);
}
SceneData in_shutter(const GltfText& text, const std::string& document) {
    return read_with(text, document, {{std::string(time_constant), "0"}, {std::string(shutter_constant), "0 1"}});
}

void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z; }
Vec3 corner(const SceneData& scene, std::size_t i = 1) { return mesh_of(scene).positions.at(i); }

/// The triangle's node moves along these keys, which are accessors 1 and 2.
GltfText keyed(const std::vector<float>& times, const std::string& type, const std::vector<float>& values) {
    GltfText text = triangle_text();
    text.vectors("SCALAR", times);
    text.vectors(type, values);
    return text;
}
SceneData moved(const GltfText& text, const Channel& channel, const std::string& seconds) {
    return at(text, one_mesh + one_node + animations(animated({channel})), seconds);
}

TEST(GltfAnimations, TakeWholeNumbersAsShares) {
    GltfText text = triangle_text();
    text.vectors("SCALAR", {0, 1});
    // no turn, and half a turn about z
    text.accessor<std::int16_t>("VEC4", 5122, {0, 0, 0, 32767, 0, 0, 32767, 0}, 2, R"(,"normalized":true)");
    expect_near(corner(moved(text, {1, 2, "rotation"}, "0.5")), {0, 1, 0});
    GltfText small = triangle_text();
    small.vectors("SCALAR", {0, 1});
    small.accessor<std::int8_t>("VEC4", 5120, {0, 0, 0, 127, 0, 0, -128, 0}, 2, R"(,"normalized":true)");
    expect_near(corner(moved(small, {1, 2, "rotation"}, "1")), {-1, 0, 0});
}

TEST(GltfAnimations, TakeWeightsOfBytes) {
    GltfText text = triangle_text();
    text.vectors("SCALAR", {0, 1});
    text.accessor<std::uint8_t>("SCALAR", 5121, {0, 255, 51, 0}, 4, R"(,"normalized":true)");
    text.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});  // 3
    text.vectors("VEC3", {0, 4, 0, 0, 4, 0, 0, 4, 0});  // 4
    const auto document =
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":3},{"POSITION":4}]}]}],)" +
        one_node + animations(animated({{1, 2, "weights"}}));
    expect_near(corner(at(text, document, "0.5")), {1, 2, 0.1f});
    expect_near(corner(at(text, document, "2")), {1, 0, 0.2f});
}

TEST(GltfAnimations, MayHaveSparseValues) {
    GltfText text = triangle_text();
    text.vectors("SCALAR", {0, 1, 2});
    const auto indices = text.view(raw(std::uint8_t{2})), values = text.view(raw(0.f, 6.f, 0.f));
    text.empty_accessor("VEC3", 5126, 3,
                        R"(,"sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(indices) +
                            R"(,"componentType":5121},"values":{"bufferView":)" + std::to_string(values) + "}}");
    expect_near(corner(moved(text, {1, 2}, "1.5")), {1, 3, 0});
}

TEST(GltfAnimations, OfOneKeyStandThereAtAllTimes) {
    for (const char* seconds : {"0", "2", "3"})
        expect_near(corner(moved(keyed({2}, "VEC3", {0, 0, 7}), {1, 2}, seconds)), {1, 0, 7});
    const auto cubic = keyed({2}, "VEC3", {9, 9, 9, 0, 0, 7, 9, 9, 9});
    for (const char* seconds : {"0", "2", "3"})
        expect_near(corner(moved(cubic, {1, 2, "translation", "CUBICSPLINE"}, seconds)), {1, 0, 7});
}

// Slopes are per second: over two seconds from 1 to 1 with slopes 4 and -4, half-way 1 + 2 (4 - -4) / 8.
TEST(GltfAnimations, ScaleSlopesOfSplinesByTheTimeBetweenKeys) {
    const auto sizes = keyed({1, 3}, "VEC3", {9, 9, 9, 1, 1, 1, 4, 0, 0, -4, 0, 0, 1, 1, 1, 9, 9, 9});
    expect_near(corner(moved(sizes, {1, 2, "scale", "CUBICSPLINE"}, "2")), {3, 0, 0});
    GltfText weights = keyed({0, 2}, "SCALAR", {9, 0, 4, -4, 0, 9});
    weights.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const auto document = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":3}]}]}],)" +
                          one_node + animations(animated({{1, 2, "weights", "CUBICSPLINE"}}));
    expect_near(corner(at(weights, document, "1")), {1, 0, 2});
}

// Half-way between no turn and half a turn about z lies (0, 0, .5, .5), which is a quarter once it has length 1.
TEST(GltfAnimations, TurnBySplinesOfAnyLength) {
    std::vector<float> values(24);
    values[4 + 3] = 1, values[12 + 4 + 2] = 1;
    expect_near(corner(moved(keyed({0, 1}, "VEC4", values), {1, 2, "rotation", "CUBICSPLINE"}, "0.5")), {0, 1, 0});
}

TEST(GltfAnimations, TurnFromATurnToItself) {
    const auto text = keyed({0, 1, 2}, "VEC4", {0, 0, half, half, 0, 0, half, half, 0, 0, -half, -half});
    for (const char* seconds : {"0.3", "1", "1.7"})
        expect_near(corner(moved(text, {1, 2, "rotation"}, seconds)), {0, 1, 0});
}

TEST(GltfAnimations, MoveAllPartsOfANodeByKeysThatTheyShare) {
    GltfText text = keyed({0, 2}, "VEC3", {0, 0, 0, 0, 0, 8});
    text.vectors("VEC4", {0, 0, 0, 1, 0, 0, 1, 0});  // 3: half a turn about z
    text.vectors("VEC3", {1, 1, 1, 3, 1, 1});        // 4
    const auto document = one_mesh + R"("nodes":[{"mesh":0,"translation":[5,5,5],"scale":[9,9,9]}],)" +
                          animations(animated({{1, 2}, {1, 3, "rotation"}, {1, 4, "scale"}}));
    // twice as long, then a quarter about z, then 4 away
    expect_near(corner(at(text, document, "1"), 1), {0, 2, 4});
    expect_near(corner(at(text, document, "1"), 2), {-1, 0, 4});
}

TEST(GltfAnimations, MirrorWhatTheyScaleBelowNothing) {
    const auto text = keyed({0, 1}, "VEC3", {1, 1, 1, -3, 1, 1});
    const auto scene = moved(text, {1, 2, "scale"}, "1");
    expect_near(corner(scene), {-3, 0, 0});
    expect_near(normal_of(mesh_of(scene)), {0, 0, 1});
}

TEST(GltfAnimations, JumpBetweenKeysOfOneTime) {
    const auto text = keyed({0, 1, 1, 2}, "VEC3", {0, 0, 0, 0, 0, 2, 0, 0, 8, 0, 0, 8});
    expect_near(corner(moved(text, {1, 2}, "0.5")), {1, 0, 1});
    const auto scene = moved(text, {1, 2}, "1");
    expect_near(corner(scene), {1, 0, 8});
    EXPECT_THAT(warnings_of(scene), HasSubstr("samplers[0] has several keys at one time: it jumps there"));
}

TEST(GltfAnimations, NameWhatMovesNothing) {
    const auto text = keyed({0, 1}, "VEC3", {0, 0, 0, 0, 0, 2});
    EXPECT_THAT(warnings_of(moved(text, {1, 2, "", "LINEAR", 0, R"("path":"translation")"}, "1")),
                HasSubstr("channels[0].target names no node: it moves nothing"));
    const auto matrix = at(text,
                           one_mesh + R"("nodes":[{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1]}],)" +
                               animations(animated({{1, 2}})),
                           "1");
    expect_near(corner(matrix), {6, 0, 0});
    EXPECT_THAT(warnings_of(matrix), HasSubstr("a node with a 'matrix' is animated: it stands still"));
}

TEST(GltfAnimations, SayWhereWeightsDoNotFitTheMesh) {
    GltfText text = keyed({0, 1}, "SCALAR", {0, 1, 1, 0});
    text.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const auto scene = at(text,
                          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":3}]}]}],)" +
                              one_node + animations(animated({{1, 2, "weights"}})),
                          "1");
    expect_near(corner(scene), {1, 0, 1});
    EXPECT_THAT(warnings_of(scene), HasSubstr("2 weights for a mesh with 1 morph target"));
}

/// Two that go to (0,0,1) and (0,2,0) and back along the same keys, and one that has no name.
const GltfText& choices() {
    static const GltfText text = [] {
        GltfText made = keyed({0, 1}, "VEC3", {0, 0, 0, 0, 0, 1});
        made.vectors("VEC3", {0, 0, 0, 0, 2, 0});
        return made;
    }();
    return text;
}
const std::string three =
    one_mesh + R"("nodes":[{"mesh":0,"children":[1]},{"mesh":0,"name":"child"}],)" +
    animations(animated({{1, 2}}, "up") + "," + animated({{1, 3, "translation", "LINEAR", 1}}, "2") + "," +
               animated({{1, 3}}, ""));

Vec3 place(const SceneData& scene, std::size_t which) {
    const auto& m = scene.instances.at(which).to_world.m;
    return {float(m[0][3]), float(m[1][3]), float(m[2][3])};
}

TEST(GltfAnimations, AreChosenByNameOrNumberOrAllAtOnce) {
    expect_near(place(at(choices(), three, "1"), 1), {0, 0, 1});
    expect_near(place(at(choices(), three, "1", "2"), 0), {0, 0, 0});
    expect_near(place(at(choices(), three, "1", "2"), 1), {0, 2, 0});
    expect_near(place(at(choices(), three, "1", "1"), 0), {0, 0, 1});
    expect_near(place(at(choices(), three, "1", "3"), 0), {0, 2, 0});
    // the third one moves what the first does: it comes last
    expect_near(place(at(choices(), three, "1", "*"), 0), {0, 2, 0});
    expect_near(place(at(choices(), three, "1", "*"), 1), {0, 4, 0});
    EXPECT_THAT(mistake_of([&] { at(choices(), three, "1", "4"); }), HasSubstr("there is no animation '4'"));
    EXPECT_THAT(mistake_of([&] { at(choices(), three, "1", "0"); }), HasSubstr("there is no animation '0'"));
}

TEST(GltfAnimations, SayThatTheOthersStandStill) {
    EXPECT_THAT(warnings_of(at(choices(), three, "1")),
                HasSubstr("its first animation, 'up', moves; the 2 others stand still (--animation, or the "
                          "scene's 'animation', chooses another, or all: '*')"));
    EXPECT_THAT(warnings_of(at(choices(), three, "1", "up")), Not(HasSubstr("others stand still")));
}

TEST(GltfAnimations, SayWhereTheyEnd) {
    const auto text = keyed({0.5f, 1.5f}, "VEC3", {0, 0, 0, 0, 0, 2});
    EXPECT_THAT(warnings_of(moved(text, {1, 2}, "1.5")), Not(HasSubstr("ends at")));
    EXPECT_THAT(warnings_of(moved(text, {1, 2}, "1.6")),
                HasSubstr("its animation ends at 1.5 s: behind that it stands still (a graph may repeat it: "
                          "'time = time % 1.5' in its scene)"));
    const auto pose = keyed({0}, "VEC3", {0, 0, 2});
    EXPECT_THAT(warnings_of(moved(pose, {1, 2}, "1")), Not(HasSubstr("ends at")));
}

// What joints stand in need not be in the scene.
TEST(GltfAnimations, MoveJointsOutsideOfTheScene) {
    GltfText text = keyed({0, 2}, "VEC3", {0, 0, 0, 0, 0, 6});
    text.accessor<std::uint16_t>("VEC4", 5123, std::vector<std::uint16_t>(12), 3);  // 3
    text.accessor<std::uint16_t>("VEC4", 5123, {65535, 0, 0, 0, 65535, 0, 0, 0, 32767, 0, 0, 0}, 3,
                                 R"(,"normalized":true)");  // 4: of any sum
    text.vectors("VEC3", {0, 1, 0, 0, 1, 0, 0, 1, 0});      // 5: morphs before it hangs
    const auto document =
        R"("meshes":[{"weights":[2],"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":4},
           "targets":[{"POSITION":5}]}]}],"skins":[{"joints":[2],"skeleton":1}],"scene":1,"scenes":[{"nodes":[1]},{"nodes":[3,4]}],
           "nodes":[{"children":[2]},{},{"translation":[0,0,1],"scale":[2,1,1]},
           {"mesh":0,"skin":0,"translation":[50,0,0]},{"mesh":0,"skin":0,"weights":[0]}],)" +
        animations(animated({{1, 2}}));
    const auto scene = at(text, document, "1");
    ASSERT_THAT(scene.shapes, SizeIs(2));
    std::vector<Vec3> corners;
    for (const auto& shape : scene.shapes) corners.push_back(std::get<Mesh>(shape.geometry).positions[1]);
    if (corners[0].y > corners[1].y) std::swap(corners[0], corners[1]);
    expect_near(corners[0], {2, 0, 4});
    expect_near(corners[1], {2, 2, 4});
    EXPECT_THAT(warnings_of(scene), HasSubstr("1 other scene of the file is left out"));
}

TEST(GltfAnimations, FollowPointersToWhatIsNotThereYet) {
    GltfText text = keyed({0, 1}, "VEC4", {0, 0, 0, 1, 1, 0.5f, 0, 1});
    text.vectors("SCALAR", {1, 2});
    const auto document =
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{}],
           "extensionsUsed":["KHR_animation_pointer"],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],
           "nodes":[{"mesh":0},{"camera":0,"translation":[0,0,5]}],)" +
        animations(animated({{1, 2, "", "LINEAR", 0, pointer("/materials/0/pbrMetallicRoughness/baseColorFactor")},
                             {1, 3, "", "LINEAR", 0, pointer("/cameras/0/perspective/yfov")}}));
    const auto scene = at(text, document, "1");
    EXPECT_NEAR(scene.camera.fov, 2 * 180 / 3.14159265, 1e-3);
    EXPECT_THAT(warnings_of(scene), AllOf(Not(HasSubstr("animated")), Not(HasSubstr("left out"))));
    bool coloured = false;
    for (const auto& texture : scene.textures) coloured |= texture.scale == Rgb{1, 0.5f, 0};
    EXPECT_TRUE(coloured);
}

/// Of one mesh, whose two nodes morph from 0 to 1 and from 1 to 0; the second stands 10 aside.
TEST(GltfAnimations, KeepNodesApartWhoseWeightsMove) {
    GltfText text = keyed({0, 1}, "SCALAR", {0, 1});
    text.vectors("SCALAR", {1, 0});
    text.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    for (const bool by_mesh : {false, true}) {
        const Channel second{1, 3, "weights", "LINEAR", 1};
        const Channel first =
            by_mesh ? Channel{1, 2, "", "LINEAR", 0, pointer("/meshes/0/weights")} : Channel{1, 2, "weights"};
        const auto scene = in_shutter(
            text,
            R"("meshes":[{"weights":[0],"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":4}]}]}],
                       "nodes":[{"mesh":0},{"mesh":0,"translation":[10,0,0]}],)" +
                animations(animated({first, second})));
        EXPECT_THAT(warnings_of(scene), Not(HasSubstr("stands still")));
        ASSERT_THAT(scene.shapes, SizeIs(2));
        ASSERT_THAT(scene.motion.shapes, SizeIs(2));
        for (const auto& [which, later] : scene.motion.shapes) {
            const auto& from = std::get<Mesh>(scene.shapes.at(which).geometry).positions[0];
            const auto& to = std::get<Mesh>(later.back()).positions[0];
            EXPECT_EQ(from.x, to.x) << "neither takes the other's place";
            EXPECT_NEAR(from.z, 1 - to.z, 1e-6);
        }
    }
}

// A joint turns the triangle over, but its normals, of another joint, stay: corners are ordered by normals.
TEST(GltfAnimations, MoveWhatTurnsItsBackInTheShutter) {
    GltfText text = keyed({0, 1}, "VEC3", {1, 1, 1, 1, -1, 1});
    text.vectors("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});                                   // 3: normals
    text.accessor<std::uint8_t>("VEC4", 5121, {1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0}, 3);  // 4
    text.vectors("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});                          // 5
    text.vectors("VEC3", {0, 0, 0, 0, -4, 0});                                           // 6
    const auto scene = in_shutter(
        text, R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":3,"JOINTS_0":4,"WEIGHTS_0":5}}]}],
             "skins":[{"joints":[1,1,2]}],"nodes":[{"mesh":0,"skin":0},{},{}],)" +
                  animations(animated({{1, 6, "translation", "LINEAR", 2}})));
    EXPECT_THAT(warnings_of(scene), Not(HasSubstr("stands still")));
    ASSERT_THAT(scene.motion.shapes, SizeIs(1));
    expect_near(std::get<Mesh>(scene.motion.shapes[0].later.back()).positions[2], {0, -3, 0});
}

TEST(GltfAnimations, NameLooksThatStandStillInTheShutter) {
    GltfText text = keyed({0, 1}, "VEC4", {0, 0, 0, 1, 0, 1, 0, 1});
    text.vectors("VEC3", {0, 0, 0, 1, 1, 1});              // 3
    text.vectors("VEC4", {0, 0, 0, 1, half, 0, 0, half});  // 4
    text.vectors("SCALAR", {1, 2});                        // 5
    const auto said = [&](const Channel& channel) {
        return warnings_of(in_shutter(
            text,
            R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{"emissiveFactor":
            [1,0,0]}],"extensionsUsed":["KHR_animation_pointer","KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":
            {"lights":[{"type":"directional"},{"type":"point","intensity":1}]}},
            "nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}}},
            {"extensions":{"KHR_lights_punctual":{"light":1}}}],)" +
                animations(animated({channel}))));
    };
    const auto pointed = [](std::size_t output, const std::string& to) {
        return Channel{1, output, "", "LINEAR", 0, pointer(to)};
    };
    const auto stands = HasSubstr("colours, brightness or suns change while the shutter is open");
    EXPECT_THAT(said(pointed(2, "/materials/0/pbrMetallicRoughness/baseColorFactor")), stands);
    EXPECT_THAT(said(pointed(3, "/materials/0/emissiveFactor")), stands);
    EXPECT_THAT(said({1, 4, "rotation", "LINEAR", 1}), stands) << "a sun";
    EXPECT_THAT(said(pointed(5, "/extensions/KHR_lights_punctual/lights/0/intensity")), stands);
    EXPECT_THAT(said(pointed(5, "/extensions/KHR_lights_punctual/lights/1/intensity")), Not(stands)) << "it moves";
    EXPECT_THAT(said({1, 3, "translation"}), Not(stands));
}

TEST(GltfAnimations, MoveWhatHasNoSizeAtTimes) {
    const auto text = keyed({0, 1}, "VEC3", {0, 0, 0, 2, 2, 2});
    const auto document = one_mesh + R"("nodes":[{"mesh":0},{"mesh":0,"translation":[5,0,0]}],)" +
                          animations(animated({{1, 2, "scale"}}));
    const auto scene = in_shutter(text, document);
    EXPECT_THAT(warnings_of(scene), AllOf(Not(HasSubstr("stands still")), Not(HasSubstr("other parts"))));
    ASSERT_THAT(scene.motion.instances, SizeIs(1));
    EXPECT_NEAR(scene.motion.instances[0].later.back().m[0][0], 2, 1e-5);
    EXPECT_NEAR(scene.instances.at(0).to_world.m[0][0], 0, 1e-5);
}

}  // namespace
}  // namespace lightnet::test::gltf_animations_reader_test
