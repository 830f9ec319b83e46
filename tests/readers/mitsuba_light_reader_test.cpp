// Mitsuba's spectra, of light and of surfaces.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scene_text.hpp"

namespace lightnet::test::mitsuba_light_reader_test {
namespace {

Rgb reflectance(const std::string& colour) {
    const auto scene = read_mitsuba_bsdf("<bsdf type='diffuse'>" + colour + "</bsdf>");
    return colour_of(scene, model_of<DiffuseMaterial>(scene).reflectance);
}

Rgb radiance(const std::string& colour) {
    return read_mitsuba("<shape type='sphere'><emitter type='area'>" + colour + "</emitter></shape>")
        .shapes[0]
        .emission->radiance;
}

void expect_near(Rgb got, Rgb wanted, float share) {
    EXPECT_NEAR(got.r, wanted.r, share * wanted.r);
    EXPECT_NEAR(got.g, wanted.g, share * wanted.g);
    EXPECT_NEAR(got.b, wanted.b, share * wanted.b);
}

// By the CIE's tables of 1931 alone.
TEST(MitsubaColours, OfLightAreSeenWithoutDaylight) {
    const Rgb flat{1.2048f, 0.9483f, 0.9087f};
    for (const std::string table :
         {"<spectrum name='radiance' value='360:1, 830:1'/>",
          "<spectrum name='radiance' type='irregular'><string name='wavelengths' value='360, 830'/>"
          "<string name='values' value='1, 1'/></spectrum>",
          "<spectrum name='radiance' type='regular'><string name='values' value='1, 1'/></spectrum>",
          "<spectrum name='radiance' type='uniform'/>"})
        expect_near(radiance(table), flat, 0.01f);
    // the lamp of Mitsuba's Cornell box
    const Rgb lamp = radiance("<spectrum name='radiance' value='400:0, 500:8, 600:15.6, 700:18.4'/>");
    EXPECT_NEAR(lamp.r / lamp.g, 1.891f, 0.02f);
    EXPECT_NEAR(lamp.b / lamp.g, 0.2533f, 0.003f);
    for (const std::string grey : {"<spectrum name='radiance' value='3'/>", "<rgb name='radiance' value='3'/>",
                                   "<spectrum name='radiance' type='d65'><float name='scale' value='3'/></spectrum>"})
        EXPECT_EQ(radiance(grey), (Rgb{3, 3, 3}));
}

TEST(MitsubaColours, OfEveryEmitterAreLight) {
    const Rgb flat{1.2048f, 0.9483f, 0.9087f};
    const MemoryFiles files{{"flat.spd", "360 1\n830 1\n"}};
    const auto emitter = [&](const std::string& type, const std::string& name) {
        return read_mitsuba("<shape type='sphere'/><emitter type='" + type + "'><spectrum name='" + name +
                                "' filename='flat.spd'/></emitter>",
                            files);
    };
    expect_near(std::get<PointLight>(emitter("point", "intensity").lights.at(0)).intensity, flat, 0.01f);
    expect_near(std::get<SpotLight>(emitter("spot", "intensity").lights.at(0)).intensity, flat, 0.01f);
    expect_near(std::get<DirectionalLight>(emitter("directional", "irradiance").lights.at(0)).irradiance, flat, 0.01f);
    expect_near(emitter("constant", "radiance").environments.at(0).radiance, flat, 0.01f);
    // in a texture of light, and in the same one of a surface
    const auto both = read_mitsuba(
        "<texture type='checkerboard' id='t'><spectrum name='color0' value='360:.5, 830:.5'/></texture>"
        "<shape type='sphere'><bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf>"
        "<emitter type='area'><ref name='radiance' id='t'/></emitter></shape>");
    const auto first = [&](TextureId id) {
        return colour_of(both, std::get<CheckerTexture>(both.textures[id].pattern).even);
    };
    expect_near(first(*both.shapes[0].emission->texture), flat * 0.5f, 0.01f);
    expect_near(first(model_of<DiffuseMaterial>(both).reflectance), {0.5f, 0.5f, 0.5f}, 0.01f);
}

TEST(MitsubaEmitters, MayShineOnBothSidesUnseenAndFromADisk) {
    const auto emission = [](const std::string& more) {
        return read_mitsuba("<shape type='sphere'><emitter type='area'>" + more + "</emitter></shape>")
            .shapes[0]
            .emission;
    };
    EXPECT_FALSE(emission("")->two_sided);
    EXPECT_FALSE(emission("")->unseen);
    EXPECT_TRUE(emission("<boolean name='two_sided' value='true'/>")->two_sided);
    EXPECT_TRUE(emission("<boolean name='unseen' value='true'/>")->unseen);
    const auto unseen = read_mitsuba(
        "<shape type='sphere'><bsdf type='diffuse'/><emitter type='area'><boolean "
        "name='unseen' value='true'/></emitter></shape>");
    EXPECT_EQ(colour_of(unseen, unseen.materials[unseen.shapes[0].material].opacity.value()), (Rgb{0, 0, 0}));
    EXPECT_EQ(warnings_of(unseen), "");
    const auto sun =
        read_mitsuba("<shape type='sphere'/><emitter type='directional'><float name='angle' value='2'/></emitter>");
    EXPECT_NEAR(std::get<DirectionalLight>(sun.lights.at(0)).half_angle, 0.0174533f, 1e-6f);
}

TEST(MitsubaColours, OfLightThatNoScreenShowsAreNamed) {
    const auto said = [](const std::string& colour) {
        return warnings_of(read_mitsuba("<shape type='sphere'><emitter type='area'>" + colour + "</emitter></shape>"));
    };
    const auto cut = testing::HasSubstr("is of a colour that sRGB can't show, and is cut");
    EXPECT_THAT(said("<spectrum name='radiance' value='585:1, 595:1'/>"), cut);
    EXPECT_THAT(said("<blackbody name='radiance' temperature='1200'/>"), cut);
    EXPECT_THAT(said("<spectrum name='radiance' value='400:1, 700:1'/>"), testing::Not(cut));
}

TEST(MitsubaColours, AreNothingBeyondTheirTables) {
    const Rgb red = reflectance("<spectrum name='reflectance' value='620:.5, 760:.5'/>");
    EXPECT_GT(red.r, 0.2f);
    EXPECT_LT(red.g, 0.05f);
    const Rgb line = radiance("<spectrum name='radiance' value='585:1, 595:1'/>");
    EXPECT_LT(luminance(line), 0.1f);
    EXPECT_GT(luminance(line), 0.05f);
}

}  // namespace
}  // namespace lightnet::test::mitsuba_light_reader_test
