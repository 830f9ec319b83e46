// Media of pbrt's files that shine, and those of NanoVDB's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/readers/pbrt/older_light.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/scene_media.hpp"
#include "tests/support/pbrt_text.hpp"
#include "tests/support/vdb_bytes.hpp"

namespace lightnet::test::pbrt_glow_reader_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string smoke(const std::string& parameters, const std::string& before = "") {
    return before + "MakeNamedMedium \"smoke\" " + parameters +
           "\nMediumInterface \"smoke\" \"\" Material \"interface\" Shape \"sphere\" "
           "\"float radius\" 10";
}

NanovdbPoints cube(const std::string& name, float value) {
    NanovdbPoints grid;
    grid.name = name;
    grid.step = 0.1, grid.origin = {0.05, 0.05, 0.05};
    for (int x = 0; x < 20; ++x)
        for (int y = 0; y < 10; ++y)
            for (int z = 0; z < 10; ++z) grid.points[{x, y, z}] = value;
    return grid;
}

SceneData of_file(const std::vector<NanovdbPoints>& grids, const std::string& parameters,
                  const std::string& before = "") {
    return read_world(smoke("\"string type\" \"nanovdb\" \"string filename\" \"s.nvdb\" " + parameters, before),
                      {{"s.nvdb", nanovdb_file(grids)}});
}

void expect_near(Rgb found, Rgb wanted, float part) {
    EXPECT_NEAR(found.r, wanted.r, part * wanted.r);
    EXPECT_NEAR(found.g, wanted.g, part * wanted.g);
    EXPECT_NEAR(found.b, wanted.b, part * wanted.b);
}

TEST(PbrtNanovdb, IsASmokeOfItsDensity) {
    const auto scene = of_file(
        {cube("density", 2)}, "\"rgb sigma_a\" [ 1 0 1 ] \"rgb sigma_s\" [ 0 1 3 ] \"float scale\" 0.5 \"float g\" 0.3",
        "Translate 1 0 0 Scale 2 2 2\n");
    const Medium& medium = scene.media.at(0);
    EXPECT_EQ(medium.fault(), "");
    EXPECT_EQ(medium.phase.g, 0.3f);
    expect_near(medium.extinction.at({2, 1, 1}), {1, 1, 4}, 1e-4f);  // twice as far from x = 1
    EXPECT_EQ(medium.extinction.at({0.5f, 1, 1}), (Rgb{0, 0, 0}));
    expect_near(medium.albedo_at({2, 1, 1}), {0, 1, 0.75f}, 1e-4f);
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
}

// Light that goes along its longest side meets 2 m of it.
TEST(PbrtNanovdb, LetsAsMuchLightThroughAsTheLawSays) {
    const Scene scene(of_file({cube("density", 2)}, "\"rgb sigma_a\" [ .25 .25 .25 ] \"rgb sigma_s\" [ 0 0 0 ]"));
    double sum = 0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
        const Vec2 u{(float(i) + 0.5f) / count, float(i * 7919 % count) / count};
        sum += double{scene.media().transmittance({{-3, 0.5f, 0.5f}, {1, 0, 0}, 6}, u).g} / count;
    }
    EXPECT_NEAR(sum, std::exp(-1), 0.01);
}

TEST(PbrtNanovdb, ShinesByItsTemperature) {
    const auto scene = of_file({cube("density", 2), cube("temperature", 400)},
                               "\"float LeScale\" 3 \"float temperatureoffset\" 100 \"float temperaturescale\" 10 "
                               "\"rgb sigma_a\" [ 1 2 4 ] \"rgb sigma_s\" [ 1 1 1 ]");
    const Rgb hot = pbrt::peaked_blackbody(3000).rgb;
    expect_near(scene.media.at(0).emission.at({1, 0.5f, 0.5f}), hot * Rgb{1, 2, 4} * 6, 1e-3f);
    EXPECT_EQ(scene.media.at(0).fault(), "");
    EXPECT_THAT(warnings_of(scene), HasSubstr("is worked out at the points of its density"));
    const auto cold = of_file({cube("density", 2), cube("temperature", 90)}, "");
    EXPECT_FALSE(cold.media.at(0).emission.grid);
    EXPECT_EQ(cold.media.at(0).emission.value, (Rgb{0, 0, 0}));
    EXPECT_THAT(cold.warnings, IsEmpty()) << warnings_of(cold);
}

TEST(PbrtNanovdb, IsTheSameSmokeInAFileOfOpenVdb) {
    const std::vector<NanovdbPoints> grids{cube("density", 2), cube("temperature", 400)};
    const std::string hot = "\"float LeScale\" 3 \"float temperatureoffset\" 100 \"float temperaturescale\" 10 ";
    const auto expected = of_file(grids, hot);
    const auto found = read_world(smoke("\"string type\" \"nanovdb\" \"string filename\" \"s.vdb\" " + hot),
                                  {{"s.vdb", vdb_file(grids, {6, true})}});
    for (const auto field : {&Medium::extinction, &Medium::albedo, &Medium::emission}) {
        const VolumeField &one = found.media.at(0).*field, &other = expected.media.at(0).*field;
        EXPECT_EQ(one.value, other.value);
        EXPECT_EQ(one.grid->content(), other.grid->content());
    }
    EXPECT_THAT(errors_of_world(smoke("\"string type\" \"nanovdb\" \"string filename\" \"s.vdb\" "),
                                {{"s.vdb", vdb_file({cube("densitty", 1)})}}),
                HasSubstr("'s.vdb' has no grid 'density' (did you mean 'densitty'?)"));
}

TEST(PbrtNanovdb, SaysWhatIsWrong) {
    const auto wrong = [](const std::string& parameters, const std::string& bytes) {
        return errors_of_world(smoke("\"string type\" \"nanovdb\" " + parameters), {{"s.nvdb", bytes}});
    };
    const std::string named = "\"string filename\" \"s.nvdb\"";
    EXPECT_THAT(wrong("", ""), HasSubstr("scene.pbrt:2: MakeNamedMedium 'smoke': parameter 'filename' is missing"));
    EXPECT_THAT(wrong("\"string filename\" \"t.nvdb\"", ""), HasSubstr("can't read 't.nvdb'"));
    EXPECT_THAT(wrong(named, "nothing of that kind"), HasSubstr("'s.nvdb': it does not begin with"));
    EXPECT_THAT(wrong(named, nanovdb_file({cube("densitty", 1)})),
                HasSubstr("'s.nvdb' has no grid 'density' (did you mean 'densitty'?)"));
    EXPECT_THAT(warnings_of(of_file({cube("density", 1)}, "\"rgb Le\" [ 1 1 1 ]")), HasSubstr("'Le' is left out"));
}

const std::string grid =
    "\"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 1 \"integer nz\" 1 "
    "\"float density\" [ 1 2 ] \"rgb sigma_a\" [ 1 2 4 ] \"rgb sigma_s\" [ 1 1 1 ] ";

TEST(PbrtUniformGrid, ShinesByItsTemperature) {
    const auto scene = read_world(smoke(grid + "\"float temperature\" [ 2000 50 ] \"float Lescale\" 3"));
    const Rgb hot = pbrt::peaked_blackbody(2000).rgb;
    expect_near(scene.media.at(0).emission.at({0.25f, 0.5f, 0.5f}), hot * Rgb{1, 2, 4} * 3, 1e-4f);
    EXPECT_EQ(scene.media.at(0).emission.at({0.75f, 0.5f, 0.5f}), (Rgb{0, 0, 0}));
    EXPECT_THAT(errors_of_world(smoke(grid + "\"float temperature\" [ 2000 50 ] \"rgb Le\" [ 1 1 1 ]")),
                HasSubstr("'Le' and 'temperature' exclude each other"));
}

TEST(PbrtUniformGrid, ShinesByAGridOfScales) {
    const auto scene = read_world(smoke(grid + "\"rgb Le\" [ 1 1 1 ] \"float Lescale\" [ 0.5 3 ]"));
    expect_near(scene.media.at(0).emission.at({0.25f, 0.5f, 0.5f}), Rgb{1, 2, 4} * 0.5f, 1e-5f);
    expect_near(scene.media.at(0).emission.at({0.75f, 0.5f, 0.5f}), Rgb{1, 2, 4} * 6, 1e-5f);
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
    EXPECT_THAT(errors_of_world(smoke(grid + "\"rgb Le\" [ 1 1 1 ] \"float Lescale\" [ 1 2 3 ]")),
                HasSubstr("'Lescale' has 3 numbers where nx, ny and nz ask for 2"));
}

TEST(PbrtRgbGrid, ShinesByItsColours) {
    const std::string colours =
        "\"string type\" \"rgbgrid\" \"integer nx\" 1 \"integer ny\" 1 \"integer nz\" 1 \"float scale\" 2 ";
    const auto scene =
        read_world(smoke(colours + "\"rgb sigma_a\" [ 1 2 3 ] \"rgb Le\" [ 4 5 6 ] \"float Lescale\" 7"));
    expect_near(scene.media.at(0).emission.at({0.5f, 0.5f, 0.5f}), {56, 140, 252}, 1e-5f);
    EXPECT_THAT(scene.warnings, IsEmpty()) << warnings_of(scene);
    EXPECT_THAT(errors_of_world(smoke(colours + "\"rgb sigma_s\" [ 1 2 3 ] \"rgb Le\" [ 4 5 6 ]")),
                HasSubstr("'sigma_a' is missing"));
}

}  // namespace
}  // namespace lightnet::test::pbrt_glow_reader_test
