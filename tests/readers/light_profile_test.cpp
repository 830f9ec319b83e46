// Profiles of luminaires (.ies), by hand.
#include "core/readers/common/light_profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/math/sampling.hpp"
#include "core/scene/bare_lights/environment.hpp"
#include "tests/support/light_profile_text.hpp"
#include "tests/support/scene_text.hpp"

namespace lightnet::test::light_profile_test {
namespace {

using testing::HasSubstr;

/// `up` degrees from straight down, turned by `around` degrees from +x.
Vec3 direction(float up, float around) {
    const float a = up * pi / 180, b = around * pi / 180;
    return {std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), -std::cos(a)};
}

float candela(const std::string& text, float up, float around) {
    return read_light_profile(text).towards(direction(up, around));
}

TEST(LightProfiles, AreLinearBetweenTheirAngles) {
    const auto text = light_profile("3 1", "0 45 90\n0\n100 60, 20");
    for (const float around : {0.0f, 77.0f, 200.0f}) {
        EXPECT_NEAR(candela(text, 0, around), 100, 1e-3f);
        EXPECT_NEAR(candela(text, 22.5f, around), 80, 1e-2f);
        EXPECT_NEAR(candela(text, 67.5f, around), 40, 1e-2f);
        EXPECT_EQ(candela(text, 91, around), 0);
    }
}

TEST(LightProfiles, MayShineUpwardsOnly) {
    const auto text = light_profile("2 1", "90 180\n0\n10 30");
    EXPECT_EQ(candela(text, 45, 0), 0);
    EXPECT_NEAR(candela(text, 135, 0), 20, 1e-2f);
}

// plane by plane, at 45 degrees up: 10, 20, 30 …
TEST(LightProfiles, OfAQuarterAreMirroredTwice) {
    const auto text = light_profile("2 3", "0 90\n0 45 90\n10 10\n20 20\n30 30");
    for (const float around : {45.0f, 135.0f, 225.0f, 315.0f}) EXPECT_NEAR(candela(text, 45, around), 20, 1e-2f);
    for (const float around : {90.0f, 270.0f}) EXPECT_NEAR(candela(text, 45, around), 30, 1e-2f);
    EXPECT_NEAR(candela(text, 45, 180), 10, 1e-2f);
}

TEST(LightProfiles, OfAHalfAreMirroredOnce) {
    const auto text = light_profile("2 3", "0 90\n0 90 180\n10 10\n20 20\n30 30");
    EXPECT_NEAR(candela(text, 45, 180), 30, 1e-2f);
    EXPECT_NEAR(candela(text, 45, 270), 20, 1e-2f);
    EXPECT_NEAR(candela(text, 45, 315), 15, 1e-2f);
}

// of 1995: alike on both sides of the plane through 90 and 270 degrees
TEST(LightProfiles, OfTheOtherHalfAreMirroredToo) {
    const auto text = light_profile("2 3", "0 90\n90 180 270\n10 10\n20 20\n30 30");
    EXPECT_NEAR(candela(text, 45, 0), 20, 1e-2f);
    EXPECT_NEAR(candela(text, 45, 45), 15, 1e-2f);
    EXPECT_NEAR(candela(text, 45, 315), 25, 1e-2f);
}

TEST(LightProfiles, OfTheWholeAreNotMirrored) {
    const auto text = light_profile("2 5", "0 90\n0 90 180 270 360\n10 10\n20 20\n30 30\n40 40\n10 10");
    EXPECT_NEAR(candela(text, 45, 45), 15, 1e-2f);
    EXPECT_NEAR(candela(text, 45, 270), 40, 1e-2f);
    EXPECT_NEAR(candela(text, 45, 315), 25, 1e-2f);
    const auto open = light_profile("2 4", "0 90\n0 90 180 270.5\n10 10\n20 20\n30 30\n40 40");
    EXPECT_NEAR(candela(open, 45, 315.25f), 25, 1e-2f);
}

// a floodlight: vertical angles around x, horizontal ones along it, both from -z
TEST(LightProfiles, OfTypeBTurnAroundTheHorizontal) {
    const auto text = light_profile("3 3", "-90 0 90\n-60 0 60\n1 2 3\n4 5 6\n7 8 9", 2);
    const auto profile = read_light_profile(text);
    const float s = std::sqrt(0.5f), sixty = std::sqrt(0.75f);
    EXPECT_NEAR(profile.towards({0, 0, -1}), 5, 1e-3f);
    EXPECT_NEAR(profile.towards({0, s, -s}), 5.5f, 1e-3f);
    EXPECT_NEAR(profile.towards({0.5f, 0, -sixty}), 6.5f, 1e-3f);
    EXPECT_NEAR(profile.towards({-0.5f, 0, -sixty}), 3.5f, 1e-3f);
    EXPECT_NEAR(profile.towards({0.5f, -sixty, 0}), 5.5f, 1e-3f);
    EXPECT_EQ(profile.towards({1, 0, 0}), 0);
    EXPECT_EQ(profile.towards({0, s, s}), 0);
}

TEST(LightProfiles, OfTypeATurnAroundTheVertical) {
    const auto profile = read_light_profile(light_profile("3 2", "-30 0 30\n0 90\n1 2 3\n4 5 6", 3));
    const float s = std::sqrt(0.5f);
    EXPECT_NEAR(profile.towards({0, 0, -1}), 2, 1e-3f);
    EXPECT_NEAR(profile.towards({s, 0, -s}), 3.5f, 1e-3f);
    EXPECT_NEAR(profile.towards({-s, 0, -s}), 3.5f, 1e-3f);  // mirrored
    EXPECT_NEAR(profile.towards(normalize({0, std::tan(15 * pi / 180), -1})), 2.5f, 1e-3f);
    EXPECT_EQ(profile.towards({0, s, -s}), 0);
}

TEST(LightProfiles, AreMultipliedByTheirFactors) {
    const std::string rest = "TILT=NONE\n1 100 1 2 1 1 2 0 0 0 0.5 0.8 60 0 90 0 10 10";
    EXPECT_NEAR(candela(rest, 45, 0), 4, 1e-3f) << "of 1986: of the ballast, and of ballast and lamp";
    EXPECT_NEAR(candela("IESNA91\n" + rest, 45, 0), 4, 1e-3f);
    for (const std::string edition : {"IESNA:LM-63-1995", "IESNA:LM-63-2002", "IES:LM-63-2019"})
        EXPECT_NEAR(candela(edition + "\r\n" + rest, 45, 0), 5, 1e-3f) << edition << ": of the ballast alone";
    EXPECT_NEAR(candela("TILT=NONE\n1 -1 2.5 2 1 1 1 0 0 0 1 1 0 0 90 0 10 10", 45, 0), 25, 1e-3f);
}

/// A lamp of `lying` (1 to 3) that gives .9 at 45 degrees, .7 at 90, and 9 cd all around below.
std::string tilting(const std::string& lying, const std::string& more = "") {
    const std::string angles = more.empty() ? "0 45 90" : "0 45 90 180", factors = "1 .9 .7 " + more;
    return "A LAMP OF OLD\nTILT=INCLUDE\n" + lying + "\n" + (more.empty() ? "3\n" : "4\n") + angles + "\n" + factors +
           "\n1 100 1 2 1 1 1 0 0 0\n1 1 9\n0 90\n0\n9 9\n";
}

/// A luminaire that was turned by so many degrees around its axis x or y.
Matrix tilted(float degrees, char around) {
    const double c = std::cos(double{degrees} * pi / 180), s = std::sin(double{degrees} * pi / 180);
    Matrix turn;
    if (around == 'x') turn.m[1] = {0, c, -s, 0}, turn.m[2] = {0, s, c, 0};
    if (around == 'y') turn.m[0] = {c, 0, s, 0}, turn.m[2] = {-s, 0, c, 0};
    return turn;
}

// of 1986, without a first line that says so
TEST(LightProfiles, MayHaveFactorsOfTilt) {
    const auto profile = read_light_profile(tilting("1"));
    EXPECT_TRUE(profile.tilt.varies());
    EXPECT_NEAR(profile.towards({0, 0, -1}), 9, 1e-4f);
    EXPECT_FALSE(read_light_profile(light_profile("2 1", "0 90 0 1 1")).tilt.varies());
    EXPECT_FALSE(read_light_profile(" TILT = NONE \n1 100 1 2 1 1 1 0 0 0\n1 1 9\n0 90\n0\n7 7\n").tilt.varies());
    EXPECT_EQ(read_light_profile(light_profile("2 1", "0 90 0 1 1")).tilt.factor(tilted(50, 'x'), {0, 0, 1}), 1);
}

TEST(LightProfiles, ChangeAsTheirLampIsTilted) {
    const auto factor = [](const std::string& text, float degrees, char around) {
        return read_light_profile(text).tilt.factor(tilted(degrees, around), {0, 0, 1});
    };
    for (const char around : {'x', 'y'}) {
        EXPECT_NEAR(factor(tilting("1"), 0, around), 1, 1e-3f);
        EXPECT_NEAR(factor(tilting("1"), 45, around), 0.9f, 1e-3f);
        EXPECT_NEAR(factor(tilting("1"), -60, around), 0.833f, 1e-3f);
        EXPECT_NEAR(factor(tilting("1"), 150, around), 0.7f, 1e-3f) << "beyond the last angle";
        EXPECT_NEAR(factor(tilting("1", "1.3"), 135, around), 1, 1e-3f);
    }
    EXPECT_NEAR(factor(tilting("2"), 45, 'y'), 1, 1e-3f) << "a horizontal lamp turns around itself";
    EXPECT_NEAR(factor(tilting("2"), 45, 'x'), 0.9f, 1e-3f);
    EXPECT_NEAR(factor(tilting("3"), 45, 'x'), 1, 1e-3f);
    EXPECT_NEAR(factor(tilting("3"), 45, 'y'), 0.9f, 1e-3f);
    EXPECT_NEAR(factor(tilting("3"), 135, 'y'), 0.9f, 1e-3f) << "no table beyond 90: as far from the horizontal";
    EXPECT_NEAR(factor(tilting("3", "1.3"), 135, 'y'), 1, 1e-3f);
}

TEST(LightProfiles, MayNameAFileOfFactorsOfTilt) {
    const std::string text = "TILT=lamps\\a.tlt\n1 100 1 2 1 1 1 0 0 0\n1 1 9\n0 90\n0\n7 7\n";
    const auto profile = read_light_profile(text, [](const std::string& name) {
        return name == "lamps\\a.tlt" ? std::optional<std::string>("1\n2\n0 90\n1 .5\n") : std::nullopt;
    });
    EXPECT_NEAR(profile.tilt.factor(tilted(45, 'x'), {0, 0, 1}), 0.75f, 1e-3f);
    EXPECT_EQ(lacks_of_tilt(profile, true), "");
    EXPECT_THAT(lacks_of_tilt(profile, false), HasSubstr("nothing says where down is"));
    EXPECT_THAT(lacks_of_tilt(read_light_profile(text), true), HasSubstr("'lamps\\a.tlt' can't be read"));
}

TEST(LightProfiles, SayWhatIsWrong) {
    const auto problem = [](const std::string& text) -> std::string {
        try {
            (void)read_light_profile(text);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(problem(""), HasSubstr("there is no line that begins with 'TILT='"));
    EXPECT_THAT(problem("IESNA91\nTILT=NONE\n"), HasSubstr("it ends before the number of lamps"));
    EXPECT_THAT(problem(light_profile("2 1", "0 90 0 1")), HasSubstr("it ends before the last candela"));
    EXPECT_THAT(problem(light_profile("2 1", "0 90 0 1 x")), HasSubstr("the last candela is not a number"));
    EXPECT_THAT(problem(light_profile("2 1", "90 0 0 1 1")), HasSubstr("a vertical angle does not ascend"));
    EXPECT_THAT(problem(light_profile("2 1", "0 720 0 1 1")), HasSubstr("a vertical angle is 720"));
    EXPECT_THAT(problem(light_profile("-2 1", "0 90 0 1 1")), HasSubstr("the number of vertical angles is -2"));
    EXPECT_THAT(problem(light_profile("60000 60000", "0 90 0 1 1")), HasSubstr("it ends before the number of vert"));
    EXPECT_THAT(problem(light_profile("2 1", "0 90 0 1 1", 4)), HasSubstr("there is no type of photometry 4"));
    EXPECT_THAT(problem(light_profile("2 1", "0 90 0 1 nan")), HasSubstr("not a number"));
    EXPECT_THAT(problem(tilting("4")), HasSubstr("a lamp lies by 1, 2 or 3, not by 4"));
    EXPECT_THAT(problem(tilting("1", "-1")), HasSubstr("a factor of tilt is -1"));
}

// of a surface that shines evenly, I cos: π I in all
TEST(LightProfilePatterns, HaveTheFluxOfTheirLamp) {
    std::string angles, candelas;
    for (int up = 0; up <= 90; up += 5) {
        angles += std::to_string(up) + " ";
        candelas += std::to_string(200 * std::cos(up * std::numbers::pi / 180)) + " ";
    }
    const Environment pattern(
        pattern_of(read_light_profile(light_profile("19 1", angles + " 0 " + candelas)), Matrix{}));
    EXPECT_NEAR(pattern.total().g, 200 * pi, 0.002f * 200 * pi);
    EXPECT_NEAR(pattern.radiance({0, 0, -1}).g, 200, 0.1f);
}

TEST(LightProfilePatterns, LieAsTheLuminaireDoes) {
    const auto profile =
        read_light_profile(light_profile("2 5", "0 90\n0 90 180 270 360\n10 10 20 20 30 30 40 40 10 10"));
    const Environment pattern(pattern_of(profile, Matrix{}));
    for (const float up : {20.0f, 50.0f, 80.0f})
        for (const float around : {10.0f, 100.0f, 190.0f, 300.0f}) {
            const Vec3 d = direction(up, around);
            EXPECT_NEAR(pattern.radiance(d).r, profile.towards(d), 0.1f) << up << " " << around;
        }
}

const std::string down = light_profile("2 1", "0 90 0 8 8");

TEST(PbrtProfiles, AreWhatGoniometricLightsMayName) {
    const auto scene = read_as("scene.pbrt",
                               "WorldBegin\nTranslate 0 0 3\nLightSource \"goniometric\" \"string filename\" \"a.IES\" "
                               "\"rgb I\" [ 1 1 1 ] \"float scale\" 2\n",
                               {{"a.IES", down}});
    const auto& light = std::get<PointLight>(scene.lights.at(0));
    EXPECT_EQ(light.position, (Vec3{0, 0, 3}));
    ASSERT_TRUE(light.pattern);
    const Environment pattern(*light.pattern);
    EXPECT_NEAR(pattern.radiance(direction(45, 30)).g * light.intensity.g, 16, 1e-2f);
    EXPECT_EQ(pattern.radiance({0, 0, 1}).g, 0);
}

// nothing in a pbrt file says where down is
TEST(PbrtProfiles, HangStraight) {
    const std::string light = "WorldBegin\nLightSource \"goniometric\" \"string filename\" \"a.ies\"\n";
    const auto straight = read_as("scene.pbrt", light, {{"a.ies", tilting("1")}});
    const auto turned =
        read_as("scene.pbrt", "WorldBegin\nRotate 45 1 0 0\n" + light.substr(11), {{"a.ies", tilting("1")}});
    for (const auto& scene : {straight, turned}) {
        EXPECT_NEAR(Environment(*std::get<PointLight>(scene.lights.at(0)).pattern).total().g, 18 * pi, 0.5f);
        EXPECT_THAT(warnings_of(scene), HasSubstr("how the lamp's light changes as it is tilted is left out"));
    }
}

TEST(PbrtProfiles, HaveThePowerThatIsAsked) {
    const auto scene = read_as(
        "scene.pbrt", "WorldBegin LightSource \"goniometric\" \"string filename\" \"a.ies\" \"float power\" 100\n",
        {{"a.ies", down}});
    const auto& light = std::get<PointLight>(scene.lights.at(0));
    EXPECT_NEAR(luminance(Environment(light.pattern.value()).total() * light.intensity), 100, 0.5f);
}

TEST(PbrtProfiles, ThatCantBeReadAreErrors) {
    EXPECT_THAT(
        errors_as("scene.pbrt", "WorldBegin\nLightSource \"goniometric\" \"string filename\" \"a.ies\"\n",
                  {{"a.ies", "TILT=NONE"}}),
        HasSubstr(
            "scene.pbrt:2: LightSource 'goniometric': 'a.ies': light profile: it ends before the number of lamps"));
}

}  // namespace
}  // namespace lightnet::test::light_profile_test
