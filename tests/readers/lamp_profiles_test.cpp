// Lamps of a scene that a graph lets shine by a luminaire's profile: by the lamp's own axes, whoever looks.
#include "core/readers/lamp_profiles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "core/scene/bare_lights/environment.hpp"
#include "tests/support/light_profile_text.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::lamp_profiles_test {
namespace {

using testing::HasSubstr;
using testing::Not;

// 100 cd straight down, 20 all around, nothing above
const std::string downlight = light_profile("2 1", "0 90\n0\n100 20");
// 8 cd straight down; across it 4 along its own +x, 2 along +y
const std::string sideways = light_profile("3 4", "0 90 180\n0 90 180 270\n8 4 0\n8 2 0\n8 0 0\n8 0 0");

SceneOverrides profiles(std::vector<ProfileOverride> wanted) {
    SceneOverrides overrides;
    overrides.profiles = std::move(wanted);
    return overrides;
}

SceneData changed(SceneData scene, const SceneOverrides& overrides) {
    MemoryFiles files{{{"down.ies", downlight}, {"side.ies", sideways}, {"bad.ies", "IESNA"}}};
    apply(overrides, scene, files, {"g.lua", 3});
    return scene;
}

std::string error_of(const SceneData& scene, const SceneOverrides& overrides) {
    try {
        (void)changed(scene, overrides);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

float towards(const BareLight& light, Vec3 direction) {
    const auto& point = std::get<PointLight>(light);
    return point.intensity.g * Environment(point.pattern.value()).radiance(normalize(direction)).g;
}

SceneData with_lamps() {
    SceneData scene;
    SpotLight beam{{1, 3, 0}, {1, 0, 0}, {1, 1, 1}, 0.1f, 0.2f, {}, {"beam"}};
    beam.luminaire.m = {{{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}}};
    scene.lights = {PointLight{{0, 3, 0}, {2, 2, 2}, {"bulb"}}, beam, DirectionalLight{{0, -1, 0}, {1, 1, 1}, {"sun"}}};
    return scene;
}

TEST(LampProfiles, ShineAsManyTimesAsTheirLamps) {
    const auto scene = changed(with_lamps(), profiles({{"bulb", "down.ies"}, {"b*m", "down.ies"}}));
    EXPECT_NEAR(towards(scene.lights[0], {0, 0, -1}), 200, 1);
    EXPECT_NEAR(towards(scene.lights[0], {1, 0, -1}), 120, 1);
    EXPECT_NEAR(towards(scene.lights[1], {1, 0, 0}), 100, 1) << "of a spot, down is where that points";
    EXPECT_NEAR(towards(scene.lights[1], {-1, 0, 0}), 0, 1e-3f);
    EXPECT_EQ(std::get<PointLight>(scene.lights[1]).label.name, "beam");
    EXPECT_TRUE(std::holds_alternative<DirectionalLight>(scene.lights[2]));
}

TEST(LampProfiles, OfPointsHangAsTheGraphSays) {
    auto wanted = profiles({{"b*", "down.ies"}});
    wanted.profiles_down = Vec3{0, -3, 0};
    const auto scene = changed(with_lamps(), wanted);
    EXPECT_NEAR(towards(scene.lights[0], {0, -1, 0}), 200, 1);
    EXPECT_NEAR(towards(scene.lights[1], {1, 0, 0}), 100, 1) << "a spot points by itself";
    wanted.profiles_down = Vec3{0, 0, 0};
    EXPECT_THAT(error_of(with_lamps(), wanted), HasSubstr("g.lua:3: 'ies_down' must be a direction"));
}

// of a vertical lamp, as beside.ies and the file that side.ies names have it: half as bright when it lies
TEST(LampProfiles, AreDimmedByTheTiltOfTheirLamps) {
    const std::string numbers = "1 100 1 2 1 1 1 0 0 0\n1 1 9\n0 180\n0\n10 10\n", factors = "1\n2\n0 90\n1 .5\n";
    const auto shine = [&](const std::optional<Vec3>& down, const std::optional<Vec3>& up, const std::string& name) {
        auto wanted = profiles({{"b*", name}});
        wanted.profiles_down = down;
        SceneData scene = with_lamps();
        scene.up = up;
        MemoryFiles files{{{"l/a.ies", "TILT=INCLUDE\n" + factors + numbers},
                           {"l/b.ies", "TILT=C:\\x\\B.TLT\n" + numbers},
                           {"l/c.ies", "TILT=c.tlt\n" + numbers},
                           {"l/b.tlt", factors}}};
        apply(wanted, scene, files, {"g.lua", 3});
        return scene;
    };
    for (const std::string name : {"l/a.ies", "l/b.ies"}) {
        const auto scene = shine(Vec3{0, -1, 0}, std::nullopt, name);
        EXPECT_NEAR(towards(scene.lights[0], {1, 0, 0}), 20, 0.1f) << "it hangs as the graph says";
        EXPECT_NEAR(towards(scene.lights[1], {1, 0, 0}), 5, 0.1f) << "a spot that points to the side";
        EXPECT_THAT(warnings_of(scene), Not(HasSubstr("tilted")));
        EXPECT_NEAR(towards(shine({}, Vec3{1, 0, 0}, name).lights[1], {1, 0, 0}), 10 * 0.5f, 0.1f) << "no table";
        EXPECT_NEAR(towards(shine({}, Vec3{0, 0, 1}, name).lights[0], {1, 0, 0}), 20, 0.1f);
        EXPECT_THAT(warnings_of(shine({}, {}, name)), HasSubstr("nothing says where down is"));
    }
    EXPECT_THAT(warnings_of(shine({}, Vec3{0, 1, 0}, "l/c.ies")), HasSubstr("'l/c.ies': how the lamp's light changes "
                                                                            "as it is tilted is left out, as 'c.tlt'"));
}

TEST(LampProfiles, BelongToLampsThatCanHaveOne) {
    const auto error = [&](const std::string& lamp, const std::string& path) {
        return error_of(with_lamps(), profiles({{lamp, path}}));
    };
    EXPECT_THAT(error("blub", "down.ies"), HasSubstr("'ies': there is no lamp called 'blub' (did you mean 'bulb'?)"));
    EXPECT_THAT(error("sun", "down.ies"), HasSubstr("a lamp called 'sun' is a sun: it has no profile"));
    EXPECT_THAT(error("bulb", "none.ies"), HasSubstr("can't read 'none.ies'"));
    EXPECT_THAT(error("bulb", "bad.ies"), HasSubstr("can't read 'bad.ies'"));
    EXPECT_THAT(error_of(with_lamps(), profiles({{"bulb", "down.ies"}, {"b*", "down.ies"}})),
                HasSubstr("has another profile already"));
    SceneData scene = with_lamps();
    scene.environments.emplace_back();
    EXPECT_THAT(error_of(scene, profiles({{"environment", "down.ies"}})),
                HasSubstr("lamp 'environment' is no point and no spot"));
}

// what a scene's lamps shine into each direction, for a camera that looks as the file says, from above, from aside
template <class Read>
void expect_alike_from_everywhere(const Read& read, const std::vector<std::pair<Vec3, float>>& expected) {
    const std::vector<std::array<Vec3, 2>> views{{Vec3{}, Vec3{}},  // the file's own
                                                 {Vec3{0, 5, 0}, Vec3{0, 0, 1}},
                                                 {Vec3{5, 0, 0}, Vec3{0, 0, 1}}};
    for (const auto& [from, up] : views) {
        auto wanted = profiles({{"lamp", "side.ies"}});
        if (length(up) > 0) {
            auto& camera = wanted.camera.emplace();
            camera.from = from, camera.to = Vec3{}, camera.up = up;
        }
        const auto scene = changed(read(), wanted);
        for (const auto& [direction, candela] : expected)
            EXPECT_NEAR(towards(scene.lights.at(0), direction), candela, 0.03f * candela + 0.02f)
                << direction.x << ' ' << direction.y << ' ' << direction.z;
    }
}

const std::string pbrt_camera = "LookAt 0 5 0 0 0 0 0 0 1\nCamera \"perspective\"\nWorldBegin\n";

TEST(LampProfiles, LieInPbrtAsTheTransformOfTheLight) {
    const auto point = [] {
        return read_as("a.pbrt",
                       pbrt_camera + "LightSource \"point\" \"point3 from\" [0 0 3] \"string name\" \"lamp\"");
    };
    expect_alike_from_everywhere(point,
                                 {{{0, 0, -1}, 8}, {{1, 0, 0}, 4}, {{0, 1, 0}, 2}, {{-1, 0, 0}, 0}, {{0, 0, 1}, 0}});
    const auto turned = [] {
        return read_as("a.pbrt", pbrt_camera +
                                     "Translate 0 3 0 Rotate -90 1 0 0 Scale 2 2 2\n"
                                     "LightSource \"point\" \"string name\" \"lamp\"");
    };
    expect_alike_from_everywhere(turned, {{{0, -1, 0}, 8}, {{1, 0, 0}, 4}, {{0, 0, -1}, 2}, {{0, 1, 0}, 0}});
    const auto spot = [] {
        return read_as("a.pbrt", pbrt_camera +
                                     "LightSource \"spot\" \"point3 from\" [0 3 0] \"point3 to\" [0 1 0] "
                                     "\"string name\" \"lamp\"");
    };
    expect_alike_from_everywhere(spot, {{{0, -1, 0}, 8}, {{0, 1, 0}, 0}});
}

TEST(LampProfiles, LieInMitsubaByToWorld) {
    const std::string camera =
        R"(<sensor type="perspective"><transform name="to_world"><lookat origin="0,5,0" target="0,0,0" up="0,0,1"/></transform></sensor><shape type="rectangle"/>)";
    const auto point = [&] {
        return read_mitsuba(camera + R"(<emitter type="point" id="lamp"><transform name="to_world">
            <rotate x="1" angle="-90"/><scale value="3"/><translate y="3"/></transform></emitter>)");
    };
    expect_alike_from_everywhere(point, {{{0, -1, 0}, 8}, {{1, 0, 0}, 4}, {{0, 0, -1}, 2}, {{0, 1, 0}, 0}});
    // what points ahead is +z; half a turn around x leads to a luminaire's axes
    const auto spot = [&] {
        return read_mitsuba(camera + R"(<emitter type="spot" id="lamp"><transform name="to_world">
            <rotate x="1" angle="90"/></transform></emitter>)");
    };
    expect_alike_from_everywhere(spot, {{{0, -1, 0}, 8}, {{1, 0, 0}, 4}, {{0, 0, -1}, 2}, {{0, 1, 0}, 0}});
}

TEST(LampProfiles, LieInGltfAsTheirNodes) {
    for (const std::string type : {R"("type":"point")", R"("type":"spot","spot":{})"}) {
        const auto read = [&] {
            return read_as("a.gltf", R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
                "extensions":{"KHR_lights_punctual":{"lights":[{)" +
                                         type + R"(}]}},
                "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],
                "scenes":[{"nodes":[0,1]}],"nodes":[{"camera":0,"translation":[0,0,5]},
                {"name":"lamp","translation":[0,3,0],"scale":[2,2,2],"rotation":[-0.70710678,0,0,0.70710678],
                "extensions":{"KHR_lights_punctual":{"light":0}}}]})");
        };
        expect_alike_from_everywhere(read, {{{0, -1, 0}, 8}, {{1, 0, 0}, 4}, {{0, 0, -1}, 2}, {{0, 1, 0}, 0}});
    }
}

}  // namespace
}  // namespace lightnet::test::lamp_profiles_test
