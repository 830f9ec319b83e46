#include "core/readers/common/spectra.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <type_traits>

#include "core/base/error.hpp"
#include "core/scene/bsdf/fresnel.hpp"

namespace lightnet::spectra_test {
namespace {

using testing::FloatNear;

TEST(Spectra, GiveTheSameValueEverywhereAsGrey) {
    const std::vector<SpectrumPoint> half{{400, 0.5f}, {700, 0.5f}};
    const Rgb colour = surface_colour(half).rgb;
    EXPECT_NEAR(colour.r, 0.5f, 1e-6f);
    EXPECT_NEAR(colour.g, 0.5f, 1e-6f);
    EXPECT_NEAR(colour.b, 0.5f, 1e-6f);
}

TEST(Spectra, GiveLongWavelengthsAsRed) {
    const std::vector<SpectrumPoint> red{{590, 0}, {610, 1}};
    const Rgb colour = surface_colour(red).rgb;
    EXPECT_GT(colour.r, 0.7f);
    EXPECT_LT(colour.g, 0.15f);
    EXPECT_LT(colour.b, 0.1f);
}

TEST(Spectra, GiveLightsLuminanceOne) {
    const std::vector<SpectrumPoint> sodium{{585, 0}, {590, 30}, {595, 0}};
    EXPECT_NEAR(luminance(light_colour(sodium).rgb), 1, 1e-5f);
    EXPECT_EQ(light_colour({}).rgb, (Rgb{0, 0, 0}));
}

static_assert(!std::is_convertible_v<LightColour, SurfaceColour> && !std::is_convertible_v<SurfaceColour, LightColour>,
              "nobody takes the one for the other");

// By the CIE's tables of 1931 at 5 nm, which the fits meet within some 0.6 %.
TEST(Spectra, OfLightAreSeenAsTheyAre) {
    const std::vector<SpectrumPoint> flat{{360, 2}, {830, 2}};
    for (const LightColour light : {mean_light(flat), mean_light_of_lines(flat)}) {
        EXPECT_NEAR(light.rgb.r, 2 * 1.2048f, 0.015f);
        EXPECT_NEAR(light.rgb.g, 2 * 0.9483f, 0.015f);
        EXPECT_NEAR(light.rgb.b, 2 * 0.9087f, 0.015f);
    }
}

// The eye's sensitivity to 555 nm is 1, and 106.857 nm in all.
TEST(Spectra, OfLightKeepTheirLines) {
    const std::vector<SpectrumPoint> line{{554, 0}, {555, 1000}, {556, 0}};
    EXPECT_NEAR(luminance(mean_light_of_lines(line).rgb), 1000 / 106.857f, 2.5f);
}

TEST(Spectra, OfLightOfLuminanceOneKeepTheirLines) {
    const Rgb green = light_colour_of_lines(std::vector<SpectrumPoint>{{554, 0}, {555, 1000}, {556, 0}}).rgb;
    EXPECT_NEAR(luminance(green), 1, 1e-5f);
    EXPECT_GT(green.g, 2 * green.r);
    const std::vector<SpectrumPoint> even{{380, 1}, {780, 1}};
    const Rgb fine = light_colour_of_lines(even).rgb, coarse = light_colour(even).rgb;
    EXPECT_NEAR(fine.r, coarse.r, 2e-3f);
    EXPECT_NEAR(fine.b, coarse.b, 2e-3f);
}

TEST(Spectra, MayBeOfColoursThatScreensCantShow) {
    EXPECT_TRUE(beyond_srgb(std::vector<SpectrumPoint>{{585, 0}, {590, 30}, {595, 0}}));
    EXPECT_FALSE(beyond_srgb(std::vector<SpectrumPoint>{{380, 1}, {780, 1}}));
    EXPECT_FALSE(beyond_srgb(std::vector<SpectrumPoint>{{400, 0}, {500, 8}, {600, 15.6f}, {700, 18.4f}}));
    EXPECT_FALSE(beyond_srgb({}));
    EXPECT_TRUE(blackbody_beyond_srgb(1500));
    EXPECT_FALSE(blackbody_beyond_srgb(2700));
    EXPECT_FALSE(blackbody_beyond_srgb(20000));
}

TEST(Spectra, MayBeDarkBeyondTheirEnds) {
    const std::vector<SpectrumPoint> some{{500, 1}, {600, 1}};
    const auto dark = dark_beyond_ends(some, 400, 700);
    EXPECT_LT(surface_colour(dark).rgb.b, 0.5f * surface_colour(some).rgb.b);
    EXPECT_NEAR(surface_colour(some).rgb.b, 1, 1e-4f);
    EXPECT_EQ(dark_beyond_ends(some, 500, 600).size(), some.size());
}

TEST(Blackbodies, TurnFromRedToBlue) {
    for (const float kelvin : {1000.0f, 2700.0f, 6500.0f, 20000.0f})
        EXPECT_NEAR(luminance(blackbody_colour(kelvin).rgb), 1, 1e-5f) << kelvin;
    const Rgb warm = blackbody_colour(2700).rgb, day = blackbody_colour(6500).rgb, cold = blackbody_colour(20000).rgb;
    EXPECT_GT(warm.r, 2 * warm.g);
    EXPECT_LT(warm.b, 0.5f * warm.g);
    EXPECT_NEAR(day.r, 1, 0.05f);
    EXPECT_NEAR(day.b, 1, 0.05f);
    EXPECT_GT(cold.b, 1.3f * cold.r);
}

TEST(NamedSpectra, KnowMetalsGlassesAndDaylight) {
    EXPECT_NEAR(named_index("metal-Ag-eta")->rgb.r, 0.155265f, 1e-6f);
    EXPECT_NEAR(named_index("metal-Al-k")->rgb.b, 4.837001f, 1e-6f);
    EXPECT_NEAR(named_index("glass-BK7")->rgb.g, 1.5185f, 1e-4f);
    EXPECT_EQ(named_light("stdillum-D65"), (LightColour{{1, 1, 1}}));
    EXPECT_FALSE(named_index("metal-Unobtainium-eta"));
    EXPECT_FALSE(named_light("metal-Ag-eta"));
}

// Head-on, as tables for artists have them in linear sRGB (Lagarde 2012, "Feeding a physically based shading model";
// gold's red lies outside of the colours that sRGB can show, and they clip it).
TEST(NamedIndices, OfMetalsReflectWhatTablesSay) {
    struct Case {
        std::string name;
        Rgb reflectance;
    };
    for (const auto& [name, expected] : {Case{"Ag", {0.972f, 0.960f, 0.915f}}, Case{"Al", {0.913f, 0.922f, 0.924f}},
                                         Case{"Au", {1.000f, 0.766f, 0.336f}}, Case{"Cu", {0.955f, 0.638f, 0.538f}},
                                         Case{"CuZn", {0.887f, 0.789f, 0.434f}}}) {
        const Rgb got =
            fresnel_conductor(1, named_index("metal-" + name + "-eta")->rgb, named_index("metal-" + name + "-k")->rgb);
        EXPECT_NEAR(got.r, expected.r, 0.04f) << name;
        EXPECT_NEAR(got.g, expected.g, 0.04f) << name;
        EXPECT_NEAR(got.b, expected.b, 0.04f) << name;
    }
}

// The same as their catalogue says of the yellow line between our red and green: SF11 has n_d = 1.78472.
TEST(NamedIndices, OfFlintsAreThoseOfTheDenseOnes) {
    const auto between = [](const char* name) {
        const Rgb n = named_index(name)->rgb;
        return n.r + (n.g - n.r) * (610 - 587.6f) / 60;
    };
    EXPECT_NEAR(between("glass-F5"), 1.6727f, 1e-3f);
    EXPECT_NEAR(between("glass-F10"), 1.72825f, 1e-3f);
    EXPECT_NEAR(between("glass-F11"), 1.78472f, 1e-3f);
    EXPECT_NEAR(between("glass-LASF9"), 1.85025f, 1e-3f);
    EXPECT_NEAR(between("glass-BK7"), 1.5168f, 1e-3f);
}

TEST(NamedLights, HaveTheirHueAndLuminanceOne) {
    for (const char* name : {"stdillum-A", "stdillum-D50", "stdillum-F2", "stdillum-F12", "illum-acesD60"})
        EXPECT_NEAR(luminance(named_light(name)->rgb), 1, 1e-4f) << name;
    EXPECT_GT(named_light("stdillum-A")->rgb.r, 2 * named_light("stdillum-A")->rgb.b);
}

TEST(SpectrumTables, AreReadInPairs) {
    const auto points = read_spd("# a remark\n400 1.5\n500\t2\r\n");
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[1].wavelength, 500);
    EXPECT_EQ(points[1].value, 2);
}

TEST(SpectrumTables, AreRefusedWhenBroken) {
    for (const char* text : {"", "400", "400 1 300 2", "400 one", "400 nan", "400 1e999"})
        EXPECT_THROW(read_spd(text), Error) << text;
}

}  // namespace
}  // namespace lightnet::spectra_test
