#include <gmock/gmock.h>

#include <cmath>

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
    for (const char* of :
         {"coverage", "depth", "distance", "position", "normal", "camera_normal", "uv", "motion", "albedo"}) {
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

// 8 pixels for 90 degrees: at distance d one unit to the right is 4 / d pixels.

TEST(SurfaceFact, IsTheMotionOfAMeshUntilTheNextFrame) {
    SceneData data = half_a_wall();
    Mesh moved = std::get<Mesh>(data.shapes[0].geometry);
    for (Vec3& vertex : moved.positions) vertex = vertex + Vec3{0.5f, 0.25f, 0};
    data.next.emplace().motion.shapes = {{0, {moved}}};
    expect_near(left(facts_of(std::move(data)), "motion"), {1, 0.5f, 0}, 1e-4f);
}

TEST(SurfaceFact, IsTheMotionThatTheCameraMakes) {
    SceneData data = half_a_wall();
    data.camera.next = {camera({0.5f, 0, 2}, {0.5f, 0, 0}, 90)};
    expect_near(left(facts_of(data), "motion"), {-1, 0, 0}, 1e-4f);
    data.camera.next = {camera({0, 0, -2}, {0, 0, -5}, 90)};
    EXPECT_EQ(left(facts_of(data), "motion"), Rgb{}) << "then it is behind the eye";
    data.camera.next.clear();
    EXPECT_EQ(left(facts_of(data), "motion"), Rgb{}) << "nothing is said of the next frame";
}

TEST(SurfaceFact, IsTheMotionOfAnInstance) {
    SceneData data = half_a_wall();
    data.objects.push_back({"", {0}});
    const auto moved_by = [](double x) {
        Matrix m;
        m.m[0][3] = x;
        return m;
    };
    data.instances = {{0, moved_by(-0.25), {}}};
    data.next.emplace().motion.instances = {{0, {moved_by(0.25)}}};
    expect_near(left(facts_of(std::move(data)), "motion"), {1, 0, 0}, 1e-4f);
}

TEST(SurfaceFact, IsTheMotionOfASphereThatTurns) {
    SceneData data;
    add(data, ball({}, 1), diffuse(data, 0.5f));
    data.camera = camera({0, 0, 2}, {0, 0, 0}, 90);
    data.camera_given = true;
    const double turn = 0.2;
    Sphere later{{}, 1};
    later.to_world.m = {
        {{std::cos(turn), 0, std::sin(turn), 0}, {0, 1, 0, 0}, {-std::sin(turn), 0, std::cos(turn), 0}, {0, 0, 0, 1}}};
    data.next.emplace().motion.shapes = {{0, {later}}};
    const auto facts = facts_of(std::move(data), 256);
    const Rgb at = facts.at("position")[8 * 3 + 3];
    const auto seen = [](double x, double z) { return 4 * x / (2 - z); };
    const double x = std::cos(turn) * at.r + std::sin(turn) * at.b, z = -std::sin(turn) * at.r + std::cos(turn) * at.b;
    EXPECT_NEAR(facts.at("motion")[8 * 3 + 3].r, seen(x, z) - seen(at.r, at.b), 0.1);
    EXPECT_GT(facts.at("motion")[8 * 3 + 3].r, 0.5);
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
