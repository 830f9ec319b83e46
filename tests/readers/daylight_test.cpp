// Clear skies, their suns, and where those stand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/readers/daylight/clear_sky.hpp"
#include "core/readers/daylight/daylight.hpp"
#include "core/readers/daylight/sun_position.hpp"
#include "core/scene/bare_lights/environment.hpp"

namespace lightnet::daylight_test {
namespace {

constexpr double pi = std::numbers::pi, degrees = pi / 180;
constexpr double lumens = 683 * 106.856980;  // per W/nm of a mean over wavelengths

Vec3 at_height(double angle) { return {0, float(std::sin(angle)), -float(std::cos(angle))}; }

Daylight day(double height, float turbidity = 3) {
    Daylight made;
    made.to_sun = at_height(height);
    made.turbidity = turbidity;
    return made;
}

// The model's formula with its last row of coefficients for turbidity 1: all that counts when the sun is in the zenith.
TEST(ClearSky, IsTheFormulaOfItsAuthors) {
    const auto value = [](std::array<double, 9> c, double strength, double cos_zenith, double from_sun) {
        const double near = std::cos(from_sun), shape = 1 + c[8] * c[8] - 2 * c[8] * near;
        return strength * (1 + c[0] * std::exp(c[1] / (cos_zenith + 0.01))) *
               (c[2] + c[3] * std::exp(c[4] * from_sun) + c[5] * near * near +
                c[6] * (1 + near * near) / std::sqrt(shape * shape * shape) + c[7] * std::sqrt(cos_zenith)) /
               106.856980;
    };
    const std::array<double, 9> red{-1.139072, -1.796056e-1, 1.923311, 6.788529,   -2.364389,
                                    -1.064041, 1.717010e-1,  1.534681, 5.015810e-1};
    const std::array<double, 9> blue{-1.087457, -1.888896e-1, 8.156686e-1, 3.101712e-1, -2.155419,
                                     1.422205,  9.692261e-2,  3.122404,    4.999430e-1};
    const ClearSky sky(1, {0, 0, 0}, pi / 2);
    for (const double angle : {0.0, 0.5, 1.2, 1.5}) {
        const Rgb seen = sky.radiance(std::cos(angle), angle);
        EXPECT_NEAR(double{seen.r} / value(red, 4.324573, std::cos(angle), angle), 1, 1e-5);
        EXPECT_NEAR(double{seen.b} / value(blue, 1.390238e1, std::cos(angle), angle), 1, 1e-5);
    }
}

// A number that was copied wrongly would stand out: between whole turbidities, and over them, nothing jumps.
TEST(ClearSky, ChangesSmoothlyWithAllThatItDependsOn) {
    const auto along = [](const auto& sky_at, double from, double to, int steps) {
        std::array<Rgb, 3> last{};
        for (int i = 0; i <= steps; ++i) {
            const ClearSky sky = sky_at(from + (to - from) * i / steps);
            for (std::size_t k = 0; k < 3; ++k) {
                const Rgb seen = sky.radiance(std::cos(0.5 * double(k) + 0.1), 1 - 0.4 * double(k));
                ASSERT_GT(seen.r, 0);
                ASSERT_GT(seen.g, 0);
                ASSERT_GT(seen.b, 0);
                if (i > 0) {
                    for (const float ratio : {seen.r / last[k].r, seen.g / last[k].g, seen.b / last[k].b})
                        ASSERT_NEAR(ratio, 1, 0.15) << from + (to - from) * i / steps << ' ' << k;
                }
                last[k] = seen;
            }
        }
    };
    for (const float ground : {0.0f, 0.3f, 1.0f})
        for (const double height : {0.01, 0.2, 0.7, 1.4}) {
            along([&](double haze) { return ClearSky(haze, Rgb{1, 1, 1} * ground, height); }, 1, 10, 90);
            if (HasFatalFailure()) FAIL() << ground << ' ' << height;
        }
    for (const double haze : {1.0, 2.5, 6.0, 10.0}) {
        along([&](double height) { return ClearSky(haze, {0.2f, 0.2f, 0.2f}, height); }, 0.1, pi / 2, 200);
        along([&](double ground) { return ClearSky(haze, Rgb{1, 1, 1} * float(ground), 0.6); }, 0, 1, 20);
        if (HasFatalFailure()) FAIL() << haze;
    }
}

// Irradiance of the ground, lux: what people measure below clear skies.
double light_of_sky(const Environment& sky) {
    double sum = 0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < 2 * n; ++j) {
            const double theta = (i + 0.5) * pi / 2 / n, phi = (j + 0.5) * pi / n;
            const Vec3 d{float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)),
                         float(std::sin(theta) * std::sin(phi))};
            sum += double{luminance(sky.radiance(d))} * std::cos(theta) * std::sin(theta) * (pi / 2 / n) * (pi / n);
        }
    return sum;
}

TEST(Daylight, IsAsBrightAsItIsMeasured) {
    const double high = light_of_sky(Environment(sky_of(day(60 * degrees)))) * lumens;
    EXPECT_GT(high, 8e3);
    EXPECT_LT(high, 25e3);
    const double sun = double{luminance(sun_of(day(60 * degrees)).irradiance)} * lumens;
    EXPECT_GT(sun, 60e3);
    EXPECT_LT(sun, 110e3);
    EXPECT_LT(double{luminance(sun_of(day(2 * degrees)).irradiance)} * lumens, 0.2 * sun);
}

TEST(Daylight, IsBlueAbove) {
    const Environment sky(sky_of(day(50 * degrees, 2)));
    const Rgb away = sky.radiance(normalize({0, 1, 1}));
    EXPECT_GT(away.b, 2 * away.r);
    EXPECT_GT(luminance(sky.radiance(at_height(47 * degrees))), 2 * luminance(away));  // beside the sun
}

TEST(Daylight, HasASunThatReddensTowardsTheHorizon) {
    const Rgb noon = radiance_of_sun(0, 3), evening = radiance_of_sun(87 * degrees, 3);
    EXPECT_GT(noon.b / noon.r, 0.6f);
    EXPECT_LT(evening.b / evening.r, 0.1f);
    EXPECT_GT(luminance(noon), 2e4f * 0.6f);
}

// The picture against the formula that it was made of.
TEST(Daylight, IsAPictureThatHasTheLightOfTheFormula) {
    for (const double height : {1.0, 10.0, 40.0, 85.0})
        for (const float haze : {1.0f, 3.0f, 9.5f}) {
            const Daylight made = day(height * degrees, haze);
            const Environment picture(sky_of(made));
            const ClearSky sky(double{haze}, made.albedo, height * degrees);
            double of_picture = 0, of_sky = 0;
            constexpr int n = 720;
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < 2 * n; ++j) {
                    const double theta = (i + 0.5) * pi / 2 / n, phi = (j + 0.5) * pi / n;
                    const Vec3 d{float(std::sin(theta) * std::sin(phi)), float(std::cos(theta)),
                                 -float(std::sin(theta) * std::cos(phi))};
                    const double near = std::acos(std::min(1.0, double{dot(d, made.to_sun)}));
                    const double part = std::sin(theta) * std::cos(theta);
                    of_picture += double{luminance(picture.radiance(d))} * part;
                    of_sky += double{luminance(sky.radiance(std::cos(theta), near))} * part;
                }
            EXPECT_NEAR(of_picture / of_sky, 1, 5e-3) << height << ' ' << haze;
        }
}

TEST(Daylight, StandsAroundWhateverIsUp) {
    Daylight made = day(30 * degrees);
    const Environment upright(sky_of(made));
    made.up = {0, 0, 1};
    made.to_sun = {float(std::cos(30 * degrees)), 0, float(std::sin(30 * degrees))};
    const Environment lying(sky_of(made));
    for (const Vec3 d : {Vec3{0.3f, 0.8f, -0.2f}, Vec3{-0.7f, 0.2f, 0.5f}, Vec3{0, 0.6f, -0.8f}}) {
        const Rgb a = upright.radiance(normalize(d)), b = lying.radiance(normalize({-d.z, -d.x, d.y}));
        EXPECT_NEAR(a.g, b.g, 2e-3f * a.g);
        EXPECT_EQ(lying.radiance(normalize({-d.z, -d.x, -d.y - 0.2f})), (Rgb{}));
    }
}

TEST(Daylight, IsStretchedWithItsSun) {
    Daylight made = day(50 * degrees);
    made.stretch = 1.5f;
    const Vec3 towards = -sun_of(made).direction;
    EXPECT_NEAR(std::asin(towards.y) / float(degrees), 90 - 1.5f * 40, 1e-3f);
    EXPECT_EQ(sun_of(made).irradiance, sun_of(day(50 * degrees)).irradiance);
    const Environment sky(sky_of(made)), plain(sky_of(day(50 * degrees)));
    EXPECT_NEAR(sky.radiance(at_height(0)).g, plain.radiance(at_height(30 * degrees)).g, 2e-4f);
    EXPECT_GT(sky.radiance(at_height(-40 * degrees)).g, 0);
    EXPECT_EQ(sky.radiance(at_height(-50 * degrees)), (Rgb{}));
}

// All that arrives head-on stays; what is spread over a wide disk lights a plane across it a bit less.
TEST(Daylight, HasASunOfTheSameLightWhateverItsAngle) {
    const Daylight made = day(1);
    const float small = sun_of(made).irradiance.g, none = sun_of(made, 0).irradiance.g;
    EXPECT_NEAR(small / none, 1, 1e-4f);
    const double wide = 0.5;
    EXPECT_NEAR(double{sun_of(made, float(wide)).irradiance.g / none}, (1 + std::cos(wide)) / 2, 1e-5);
    EXPECT_EQ(sun_of(made, 0.5f).half_angle, 0.5f);
}

TEST(SunPosition, IsWhereAlmanacsHaveIt) {
    // Solstice in Greenwich: as high as the obliquity of the ecliptic makes it, in the south
    const auto summer = sun_position({2000, 6, 21, 12, 2, 0, 51.4769, 0, 0});
    EXPECT_NEAR(summer.from_zenith / degrees, 51.4769 - 23.438, 0.02);
    EXPECT_NEAR(summer.azimuth / degrees, 180, 1);
    // Equinox of 20 March 2010, 17:32 UT: on the equator of the sky; at 90° W that is before noon by the equation of
    // time
    const auto spring = sun_position({2010, 3, 20, 17, 32, 0, 0, 0, 0});
    EXPECT_NEAR(std::cos(spring.from_zenith), std::cos((17 + 32 / 60.0 - 12 - 7.5 / 60) * 15 * degrees), 2e-3);
    EXPECT_NEAR(spring.azimuth / degrees, 270, 0.1);
    // Tokyo, 10 July 2010 at 15:00, by declination 22.2° and equation of time -5.3 minutes
    const auto tokyo = sun_position({});
    EXPECT_NEAR(90 - tokyo.from_zenith / degrees, 46.0, 0.3);
    EXPECT_NEAR(tokyo.azimuth / degrees, 265.7, 0.6);
    // Noon in the south of Australia is in the north
    const auto adelaide = sun_position({2012, 12, 21, 13, 14, 0, -34.93, 138.6, 10.5});
    EXPECT_NEAR(90 - adelaide.from_zenith / degrees, 78.5, 0.2);
    EXPECT_TRUE(adelaide.azimuth / degrees < 15 || adelaide.azimuth / degrees > 345);
}

}  // namespace
}  // namespace lightnet::daylight_test
