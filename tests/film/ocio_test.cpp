// Views of OpenColorIO, and curves that run into white.
#include "core/film/ocio.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/base/error.hpp"
#include "core/film/png.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::ocio_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A display whose views are plain powers of what a scene has.
constexpr const char* colours = R"(ocio_profile_version: 2
roles:
  default: raw
  scene_linear: SPACE
ROLES
displays:
  screen:
    - !<View> {name: Square root, colorspace: root}
    - !<View> {name: Raw, colorspace: raw}
  wall:
    - !<View> {name: Square root, colorspace: root}
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: SPACE}
  - !<ColorSpace>
    name: root
    from_scene_reference: !<GroupTransform>
      children:
        - !<MatrixTransform> {matrix: [MATRIX]}
        - !<ExponentTransform> {value: 2, direction: inverse}
)";

std::string with(std::string text, const std::string& word, const std::string& by) {
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + by.size()))
        text.replace(at, word.size(), by);
    return text;
}

class Ocio : public ::testing::Test {
protected:
    ~Ocio() override { ::unsetenv("OCIO"); }
    void config(const std::string& space, const std::string& roles = "",
                const std::string& matrix = "1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1") {
        const auto text = with(with(with(colours, "SPACE", space), "ROLES", roles), "MATRIX", matrix);
        ::setenv("OCIO", folder_.write("config.ocio", text).c_str(), 1);
    }
    std::string error_of(const std::string& view) const {
        std::vector<Rgb> pixels{{}};
        try {
            ocio::show(pixels, view);
            return "";
        } catch (const Error& error) {
            return error.what();
        }
    }
    const test::Folder folder_;
};

TEST_F(Ocio, HasNoViewsWithoutAConfig) {
    ::unsetenv("OCIO");
    EXPECT_THAT(ocio::views(), IsEmpty());
    EXPECT_THAT(error_of("Filmic"), HasSubstr("$OCIO names no config"));
}

TEST_F(Ocio, NamesViewsOfTheUsualDisplayAndOfAll) {
    config("lin_rec709");
    EXPECT_THAT(ocio::views(),
                ElementsAre("Square root", "Raw", "screen/Square root", "screen/Raw", "wall/Square root"));
    EXPECT_THAT(error_of("Sqare root"), HasSubstr("did you mean 'Square root'?"));
    ::setenv("OCIO", folder_.write("broken.ocio", "colours: many").c_str(), 1);
    EXPECT_THAT(error_of("Raw"), HasSubstr("broken.ocio: is no config of OpenColorIO"));
}

TEST_F(Ocio, ShowsPicturesAsTheConfigSays) {
    for (const char* space : {"lin_rec709", "Linear Rec.709 (sRGB)", "Utility - Linear - sRGB"}) {
        config(space);
        const Picture picture{2, 1, {{0.25f, 1, 0.01f}, {0.0625f, 4, 0}}, {}};
        for (const char* view : {"Square root", "wall/Square root"}) {
            auto pixels = picture.beauty;
            ocio::show(pixels, view);
            EXPECT_NEAR(pixels[0].r, 0.5, 1e-5) << space;
            EXPECT_NEAR(pixels[1].g, 2, 1e-5) << space;
            EXPECT_EQ(png_of(picture, {0, Tone::ocio, view}), png_of(picture, {0, Tone::ocio, "Square root"}));
        }
        EXPECT_NE(png_of(picture, {1, Tone::ocio, "Square root"}), png_of(picture, {0, Tone::ocio, "Square root"}));
        EXPECT_THAT(tone_of({1, Tone::ocio, "Square root"}),
                    HasSubstr("exposure 2^1.0, OpenColorIO's view Square root"));
    }
}

// The config's reference is ACES 2065-1, whose red of BT.709 has these parts (by the primaries and whites of both,
// adapted by Bradford).
TEST_F(Ocio, FindsItsWayThroughTheRolesOfInterchange) {
    config("ACES2065-1", "  aces_interchange: ACES2065-1");
    std::vector<Rgb> pixels{{1, 0, 0}, {1, 1, 1}};
    ocio::show(pixels, "Square root");
    EXPECT_NEAR(pixels[0].r, std::sqrt(0.43963), 1e-4);
    EXPECT_NEAR(pixels[0].g, std::sqrt(0.08978), 1e-4);
    EXPECT_NEAR(pixels[0].b, std::sqrt(0.01754), 1e-4);
    for (const float part : {pixels[1].r, pixels[1].g, pixels[1].b}) EXPECT_NEAR(part, 1, 1e-5) << "white stays white";
    config("secret");
    EXPECT_THAT(error_of("Square root"), HasSubstr("no colour space that is linear with the primaries of BT.709"));
}

TEST(Tones, KeepGreyGreyAndRiseFromBlackToWhite) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), far = std::numeric_limits<float>::infinity();
    for (const Tone tone : {Tone::filmic, Tone::aces, Tone::agx}) {
        float before = -1;
        for (float grey = 1e-3f; grey < 200; grey *= 1.1f) {
            const Rgb shown = toned({grey, grey, grey}, tone);
            EXPECT_NEAR(shown.r, shown.g, 0.01);
            EXPECT_NEAR(shown.g, shown.b, 0.01);
            EXPECT_GE(shown.g, before - 1e-4f) << grey;
            before = shown.g;
        }
        EXPECT_NEAR(toned({0, 0, 0}, tone).g, 0, 2e-3);
        EXPECT_NEAR(toned({nan, -1, nan}, tone).g, 0, 2e-3);
        EXPECT_GT(toned({far, far, far}, tone).g, 0.97f);
    }
}

// ACES shows 18 % grey at a tenth of its white; AgX at half of the signal of a display of gamma 2.2.
TEST(Tones, ShowMiddleGreyWhereTheirMakersWantIt) {
    EXPECT_NEAR(toned({0.18f, 0.18f, 0.18f}, Tone::aces).g, 0.1, 0.01);
    EXPECT_NEAR(std::pow(toned({0.18f, 0.18f, 0.18f}, Tone::agx).g, 1 / 2.2f), 0.5, 0.04);
}

// What is bright and saturated loses its colour, as film does; per channel it would stay what it is.
TEST(Tones, LetBrightColoursRunIntoWhite) {
    for (const Tone tone : {Tone::aces, Tone::agx}) {
        const Rgb dim = toned({0.2f, 0.02f, 0.02f}, tone), bright = toned({200, 20, 20}, tone);
        EXPECT_LT(dim.g / dim.r, 0.5f);
        EXPECT_GT(bright.g / bright.r, 0.9f);
    }
}

}  // namespace
}  // namespace lightnet::ocio_test
