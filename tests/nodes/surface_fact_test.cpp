#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::surface_fact_test {
namespace {

using namespace test;

// A wall at z = 0 over the left half of the picture, seen from 2 before it.
SceneData half_a_wall(float mirrored = 0) {
    SceneData data;
    Mesh wall = quad({-100, -100, 0}, {100, 0, 0}, {0, 200, 0});
    wall.uvs = {{0, 0}, {1, 0}, {1, 2}, {0, 2}};
    add(data, std::move(wall), mirrored > 0 ? mirror(data, mirrored) : diffuse(data, 0.5f));
    data.camera = camera({0, 0, 2}, {0, 0, 0}, 90);
    data.camera_given = true;
    data.film.scale = 3;
    return data;
}

using Pictures = std::map<std::string, std::vector<Rgb>>;

Pictures facts_of(SceneData data, std::uint32_t samples = 4) {
    SmallNetwork network(std::move(data), 8, 8);
    std::vector<std::string> shown;
    for (const char* of : {"coverage", "depth", "distance", "position", "normal", "camera_normal", "uv", "albedo"}) {
        network.add(of, "SurfaceFact", {}, {{"of", Value{std::string(of)}}});
        shown.emplace_back(of);
    }
    network.add("direct", "DirectLighting").lit_by("direct").show(shown);
    return network.pictures(samples);
}

const Rgb& left(const Pictures& pictures, const std::string& name) { return pictures.at(name)[8 * 3 + 1]; }
const Rgb& right(const Pictures& pictures, const std::string& name) { return pictures.at(name)[8 * 3 + 6]; }

void expect_near(const Rgb& a, const Rgb& b, float most) {
    EXPECT_NEAR(a.r, b.r, most);
    EXPECT_NEAR(a.g, b.g, most);
    EXPECT_NEAR(a.b, b.b, most);
}

TEST(SurfaceFact, TellsWhatIsSeenAndNothingOfWhatIsNot) {
    const auto facts = facts_of(half_a_wall());
    EXPECT_EQ(left(facts, "coverage"), (Rgb{1, 1, 1}));
    expect_near(left(facts, "depth"), {2, 2, 2}, 1e-5f);
    EXPECT_GT(left(facts, "distance").r, 2.1f);
    expect_near(left(facts, "normal"), {0, 0, 1}, 1e-5f);
    expect_near(left(facts, "camera_normal"), {0, 0, 1}, 1e-5f);
    EXPECT_NEAR(left(facts, "position").b, 0, 1e-5f);
    const Rgb place = left(facts, "position");
    expect_near(left(facts, "uv"), {place.r / 100 + 1, place.g / 100 + 1, 0}, 1e-3f);
    const Rgb at = left(facts, "position");
    EXPECT_NEAR(std::sqrt(at.r * at.r + at.g * at.g + 4), left(facts, "distance").r, 0.02f);
    EXPECT_LT(at.r, -0.5f) << "on the left";
    for (const auto& [name, pixels] : facts) EXPECT_EQ(right(facts, name), Rgb{}) << name;
}

TEST(SurfaceFact, IsAskedOfMirrorsToo) {
    const auto facts = facts_of(half_a_wall(0.5f));
    EXPECT_EQ(left(facts, "coverage"), (Rgb{1, 1, 1})) << "not what lies behind the mirror, nor weighted by it";
    expect_near(left(facts, "albedo"), {0.5f, 0.5f, 0.5f}, 0.02f);
}

TEST(SurfaceFact, IsTheAlbedoOfItsMaterial) {
    SceneData data;
    add(data, quad({-100, -100, 0}, {200, 0, 0}, {0, 200, 0}), diffuse(data, 0.25f));
    data.camera = camera({0, 0, 2}, {0, 0, 0}, 60);
    data.camera_given = true;
    expect_near(left(facts_of(std::move(data)), "albedo"), {0.25f, 0.25f, 0.25f}, 1e-5f);
}

TEST(SurfaceFact, IsNoLight) {
    SmallNetwork network(half_a_wall(), 8, 8);
    network.add("depth", "SurfaceFact", {}, {{"of", Value{std::string("depth")}}}).add("sum", "Combine", {"depth"});
    try {
        network.picture(1);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("'depth', gives facts about surfaces and no light: name it in the "
                                                     "renderer's 'show'"));
    }
}

}  // namespace
}  // namespace lightnet::surface_fact_test
