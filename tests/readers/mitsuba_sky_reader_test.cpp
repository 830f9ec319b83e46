// Mitsuba's skies and suns.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_sky_reader_test {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr float degrees = std::numbers::pi_v<float> / 180;

const std::string one_ball = "<shape type='sphere'/>";

/// Of version 0.6, which has y up.
SceneData under_sky(const std::string& emitters) {
    return read_as("scene.xml", "<scene version='0.6.0'>" + one_ball + emitters + "</scene>");
}
std::string mistakes_of_sky(const std::string& inside) {
    return errors_as("scene.xml",
                     "<scene version='0.6.0'>" + one_ball + "<emitter type='sunsky'>" + inside + "</emitter></scene>");
}
const DirectionalLight& sun_in(const SceneData& scene) { return std::get<DirectionalLight>(scene.lights.at(0)); }

TEST(MitsubaSky, IsBlueAndHasASunAsWideAsTheRealOne) {
    const auto scene =
        under_sky("<emitter type='sunsky' id='day'><vector name='sunDirection' x='1' y='1' z='0'/></emitter>");
    ASSERT_THAT(scene.environments, SizeIs(1));
    ASSERT_THAT(scene.lights, SizeIs(1));
    EXPECT_NEAR(sun_in(scene).direction.x, -std::sqrt(0.5f), 1e-5f);
    EXPECT_NEAR(sun_in(scene).half_angle, 0.2679f * degrees, 1e-6f);
    EXPECT_EQ(sun_in(scene).label.name, "day");
    const auto& sky = *scene.environments[0].image;
    EXPECT_EQ(sky.width, 512u);
    const Rgb near = sky.colour(sky.width / 2, sky.height / 4), far = sky.colour(0, sky.height / 4);
    EXPECT_GT(luminance(near), 3 * luminance(far));
    EXPECT_GT(far.b, far.r);
    EXPECT_GT(luminance(far), 0.01f);  // per nanometre: some thousand candela per square metre over 73,000 lm·nm/W
    EXPECT_LT(luminance(far), 1);
    EXPECT_THAT(warnings_of(scene), testing::IsEmpty());
}

TEST(MitsubaSky, IsAloneOrTheSunIs) {
    EXPECT_THAT(under_sky("<emitter type='sky'/>").lights, testing::IsEmpty());
    EXPECT_THAT(under_sky("<emitter type='sun'/>").environments, testing::IsEmpty());
}

TEST(MitsubaSky, HasItsSunWhereTimeAndPlacePutIt) {
    const auto afternoon = under_sky("<emitter type='sun'/>");  // Tokyo, in the west
    EXPECT_GT(sun_in(afternoon).direction.x, 0.6f);
    EXPECT_NEAR(-sun_in(afternoon).direction.y, std::sin(46 * degrees), 5e-3f);
    const auto morning = under_sky("<emitter type='sun'><float name='hour' value='7'/></emitter>");
    EXPECT_LT(sun_in(morning).direction.x, -0.6f);
    const auto lying =
        under_sky("<emitter type='sun'><transform name='toWorld'><rotate x='1' angle='90'/></transform></emitter>");
    EXPECT_NEAR(-sun_in(lying).direction.z, -sun_in(afternoon).direction.y, 1e-5f);
}

TEST(MitsubaSky, TakesTheDirectionOfItsSunInTheWorld) {
    const auto lying = under_sky(
        "<emitter type='sunsky'><vector name='sunDirection' x='0' y='-1' z='1'/>"
        "<transform name='toWorld'><rotate x='1' angle='90'/></transform></emitter>");
    EXPECT_NEAR(sun_in(lying).direction.y, std::sqrt(0.5f), 1e-5f);
    EXPECT_NEAR(transform_direction(lying.environments[0].to_world, {0, 1, 0}).z, 1, 1e-6f);
}

TEST(MitsubaSky, ScalesAsItSays) {
    const std::string at = "<vector name='sunDirection' x='0' y='1' z='1'/>";
    const auto plain = under_sky("<emitter type='sunsky'>" + at + "</emitter>");
    const auto scaled = under_sky("<emitter type='sunsky'>" + at +
                                  "<float name='scale' value='3'/><float name='sunScale' value='2'/>"
                                  "<float name='sunRadiusScale' value='10'/></emitter>");
    EXPECT_EQ(scaled.environments[0].radiance, (Rgb{3, 3, 3}));
    EXPECT_NEAR(sun_in(scaled).irradiance.g / sun_in(plain).irradiance.g, 2, 2e-3f);
    EXPECT_NEAR(sun_in(scaled).half_angle, 2.679f * degrees, 1e-5f);
    const auto point = under_sky("<emitter type='sunsky'>" + at + "<float name='sunRadiusScale' value='0'/></emitter>");
    EXPECT_EQ(sun_in(point).half_angle, 0);
}

TEST(MitsubaSky, OfVersionThreeHasZUp) {
    const auto scene = read_mitsuba(one_ball +
                                    "<emitter type='sunsky'><vector name='sun_direction' x='0' y='1' z='1'/>"
                                    "<float name='sun_aperture' value='2'/></emitter>");
    EXPECT_NEAR(transform_direction(scene.environments[0].to_world, {0, 1, 0}).z, 1, 1e-6f);
    EXPECT_NEAR(sun_in(scene).half_angle, 1 * degrees, 1e-6f);
    EXPECT_THAT(warnings_of(scene), HasSubstr("as Mitsuba 0.6 has it"));
}

TEST(MitsubaSky, SaysWhatItCannotBe) {
    EXPECT_THAT(mistakes_of_sky("<vector name='sunDirection' x='0' y='-1' z='1'/>"),
                HasSubstr("scene.xml:1: the sun is 45.0° below the horizon"));
    EXPECT_THAT(mistakes_of_sky("<float name='turbidity' value='11'/>"),
                HasSubstr("'turbidity' is 11, but must be 1 … 10"));
    EXPECT_THAT(mistakes_of_sky("<float name='stretch' value='3'/>"), HasSubstr("'stretch' is 3, but must be 1 … 2"));
    EXPECT_THAT(mistakes_of_sky("<vector name='sunDirection' x='0' y='1' z='1'/><float name='hour' value='3'/>"),
                HasSubstr("a direction or a time and a place, not both"));
    EXPECT_THAT(mistakes_of_sky("<integer name='month' value='13'/>"), HasSubstr("there is no day 10 of month 13"));
}

}  // namespace
}  // namespace lightnet::test::mitsuba_sky_reader_test
