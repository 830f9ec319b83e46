// What the eye sees first, for compositing: alpha, and mattes by name.
#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "core/base/name_id.hpp"
#include "core/film/addition.hpp"
#include "core/scene/data/surface_names.hpp"
#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::compositing_test {
namespace {

using namespace test;
using testing::HasSubstr;

Shape& wall(SceneData& data, float from, float to, const char* name, const char* material, float emitted = 0) {
    add(data, quad({from, -100, 0}, {to - from, 0, 0}, {0, 200, 0}), diffuse(data, 0.5f));
    data.materials.back().name = material;
    Shape& shape = data.shapes.back();
    shape.name = name;
    if (emitted > 0) shape.emission = AreaEmission{{emitted, emitted, emitted}, true, {}, {}};
    return shape;
}

// Seen from 2 before it: on the left a wall, in the middle a lamp, and nothing on the right; white all around.
SceneData scene() {
    SceneData data;
    wall(data, -100, -0.25f, "wall", "plaster");
    wall(data, -0.25f, 0.75f, "", "tube", 3).emission->label.name = "neon";
    data.environments.push_back({});
    data.camera = camera({0, 0, 2}, {0, 0, 0}, 90);
    data.camera_given = true;
    return data;
}

SmallNetwork network() {
    SmallNetwork made(scene(), 8, 8);
    made.add("direct", "DirectLighting").lit_by("direct");
    return made;
}

Value word(const char* text) { return Value{std::string(text)}; }

// Pixel x of the fourth row. Pixels are half a unit wide: the lamp begins in the middle of pixel 3, and ends in that of
// pixel 5.
constexpr std::size_t row = 8 * 3;

TEST(Cryptomatte, CountsInHowManySamplesANameIsSeen) {
    auto small = network();
    for (const char* of : {"object", "material", "lamp"})
        small.add(of, "Cryptomatte", {}, {{"of", word(of)}, {"ranks", Value{2.0}}});
    const auto seen = small.show({"object", "material", "lamp"}).pictures(16);
    const auto times = [&](const char* matte, std::size_t x, const char* name) {
        float count = 0;
        for (const char* rank : {" 0", " 1"}) {
            const Rgb& id = seen.at(matte + std::string(rank))[row + x];
            if (id.r * 16 == name_id(name)) count += id.g * 16;  // what is added up is divided by 16
        }
        return count;
    };
    EXPECT_EQ(times("object", 1, "wall"), 16);
    EXPECT_EQ(times("object", 4, "tube"), 16) << "what has no name goes by its material";
    EXPECT_NEAR(times("object", 3, "tube"), 8, 1);
    EXPECT_EQ(times("object", 3, "tube") + times("object", 3, "wall"), 16);
    EXPECT_NEAR(times("object", 5, "tube"), 8, 1);
    EXPECT_EQ(times("material", 1, "plaster"), 16);
    EXPECT_EQ(times("material", 4, "tube"), 16);
    EXPECT_EQ(times("lamp", 4, "neon"), 16);
    EXPECT_EQ(times("lamp", 1, "wall"), 0) << "no lamp";
    EXPECT_EQ(seen.at("object 0")[row + 7], Rgb{}) << "nothing is there";
}

TEST(Cryptomatte, TakesAnEvenNumberOfRanks) {
    auto small = network();
    small.add("things", "Cryptomatte", {}, {{"of", word("object")}, {"ranks", Value{5.0}}}).show({"things"});
    try {
        small.pictures(1);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("'ranks' must be even"));
    }
}

TEST(Cryptomatte, IsNoLight) {
    auto small = network();
    small.add("things", "Cryptomatte", {}, {{"of", word("object")}}).add("sum", "Combine", {"direct", "things"});
    try {
        small.lit_by("sum").picture(1);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("'things', gives facts about surfaces and no light"));
    }
}

TEST(SurfaceNames, AreThoseOfObjectsInTheirInstances) {
    SceneData data = scene();
    wall(data, 0, 1, "leaf", "green");
    data.objects = {{"tree", {2}}, {"", {2}}};
    data.instances = {{0, {}}, {1, {}}};
    const auto names = surface_names(data, NamedBy::object);
    EXPECT_THAT(names.of_shape, testing::ElementsAre("wall", "tube", "leaf"));
    EXPECT_THAT(names.of_instance, testing::ElementsAre("tree", ""));
    data.shapes[1].name = data.materials[data.shapes[1].material].name = "";
    EXPECT_EQ(surface_names(data, NamedBy::object).of_shape[1], unnamed);
    EXPECT_THAT(surface_names(data, NamedBy::lamp).of_shape, testing::ElementsAre("", "neon", ""));
}

TEST(Alpha, IsThePartThatSurfacesCover) {
    auto small = network();
    const auto seen = small.with("alpha", true).pictures(16);
    const auto& alpha = seen.at("A");
    EXPECT_EQ(alpha[row + 1], (Rgb{1, 1, 1}));
    EXPECT_NEAR(alpha[row + 5].r, 0.5f, 0.07f);
    EXPECT_EQ(alpha[row + 7], Rgb{});
}

TEST(Background, CanBeLeftOutOfThePictureAndLightsItNonetheless) {
    auto with = network(), without = network();
    const auto all = with.pictures(16), alone = without.with("background", false).pictures(16);
    EXPECT_EQ(all.at("emission")[row + 7], (Rgb{1, 1, 1}));
    EXPECT_EQ(alone.at("emission")[row + 7], Rgb{});
    EXPECT_EQ(alone.at("emission")[row + 4], all.at("emission")[row + 4]) << "lamps are things";
    EXPECT_TRUE(alone.at("direct") == all.at("direct")) << "to the bit";
    EXPECT_GT(alone.at("direct")[row + 1].r, 0);
}

}  // namespace
}  // namespace lightnet::compositing_test
