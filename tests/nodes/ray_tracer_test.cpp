#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::ray_tracer_test {
namespace {

using namespace test;

// Between two facing mirrors of reflectance r, one of which shines: each look finds it again and again.
TEST(RayTracer, FollowsMirrorsUntilNothingIsLeft) {
    SceneData data;
    const auto silver = mirror(data, 0.5f);
    add(data, quad({-100, -100, -1}, {200, 0, 0}, {0, 200, 0}), silver).emission = AreaEmission{{1, 1, 1}, false};
    add(data, quad({-100, -100, 1}, {0, 200, 0}, {200, 0, 0}), silver);
    data.camera = camera({0, 0, 0}, {0, 0, -1}, 2);
    data.camera_given = true;
    const Scene scene(data);
    Rig rig(scene);
    rig.add("AmbientOcclusion", "nothing");  // no surface here scatters: it is never asked
    const auto pixels = picture(*rig.renderer("nothing"), 16, 16, 64);
    double sum = 0;
    for (const Rgb& pixel : pixels) sum += pixel.r;
    // 1 + r² + r⁴ + …; Fresnel of the metal at near-normal incidence is r within 0.1 %
    EXPECT_NEAR(sum / double(pixels.size()), 1 / (1 - 0.25), 2e-2);
}

TEST(RayTracer, GlassBallUnderAWhiteSkyIsInvisible) {
    SceneData data;
    add(data, ball({0, 0, 0}, 1), material(data, DielectricMaterial{}));
    data.environments.push_back({{1, 1, 1}});
    data.camera = camera({0, 0, 4}, {0, 0, 0}, 40);
    data.camera_given = true;
    const Scene scene(data);
    Rig rig(scene);
    rig.add("AmbientOcclusion", "nothing");
    for (const Rgb& pixel : picture(*rig.renderer("nothing"), 32, 32, 16)) EXPECT_NEAR(pixel.r, 1, 2e-3f);
}

// A lamp behind the eye, in a pane: of a pixel's few looks each sees its faint reflection.
TEST(RayTracer, FollowsBothWaysOfGlass) {
    SceneData data;
    DielectricMaterial pane;
    pane.thin = true;
    add(data, quad({-100, -100, 0}, {200, 0, 0}, {0, 200, 0}), material(data, pane));
    add(data, quad({-100, -100, 5}, {0, 200, 0}, {200, 0, 0}), diffuse(data, 0)).emission =
        AreaEmission{{10, 10, 10}, true};
    data.camera = camera({0, 0, 2}, {0, 0, 0}, 2);
    data.camera_given = true;
    const Scene scene(data);
    Rig rig(scene);
    rig.add("AmbientOcclusion", "nothing");
    const double once = 0.04, reflected = 2 * once / (1 + once);  // of glass with an index of 1.5
    for (const Rgb& pixel : picture(*rig.renderer("nothing"), 8, 8, 4)) EXPECT_NEAR(pixel.r, 10 * reflected, 1e-2);
}

TEST(RayTracer, PutsWhatShinesIntoLayerZero) {
    const Scene scene(furnace(0.5f, 3));
    Rig rig(scene);
    rig.add("AmbientOcclusion", "dark");  // nothing is open in a closed room
    const auto renderer = rig.renderer("dark");
    std::vector<Rgb> pixels(2 * 16);
    renderer->render({0, 0, 4, 4, 0, 4}, pixels);
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(pixels[2 * i], (Rgb{12, 12, 12}));
        EXPECT_EQ(pixels[2 * i + 1], (Rgb{}));
    }
}

// The edge of a white half-plane between two pixels: each filter spreads it as far as it reaches, and symmetrically.
class Filters : public testing::TestWithParam<std::pair<const char*, float>> {};

TEST_P(Filters, SpreadAnEdgeAsFarAsTheyReach) {
    const auto [filter, beyond] = GetParam();  // share of a pixel's filter that lies outside the pixel, on one side
    SceneData data;
    add(data, quad({0, -100, -1}, {100, 0, 0}, {0, 200, 0}), diffuse(data, 0)).emission = AreaEmission{{1, 1, 1}, true};
    data.camera = camera({0, 0, 4}, {0, 0, 0}, 20);
    data.camera_given = true;
    const Scene scene(data);
    Rig rig(scene);
    rig.add("AmbientOcclusion", "nothing");
    const std::uint32_t width = scene.film().width, row = scene.film().height / 2;
    const auto renderer = rig.renderer("nothing", {{"filter", Value{filter}}});
    const Tile tile{width / 2 - 2, row, 4, 64, 0, 16};
    std::vector<Rgb> pixels(2 * tile.pixels());
    for (std::uint32_t block = 0; block < 4; ++block) {
        Tile part = tile;
        part.first_sample = 16 * block;
        renderer->render(part, pixels);
    }
    std::array<double, 4> columns{};
    for (std::size_t i = 0; i < tile.pixels(); ++i) {
        const Rgb seen = pixels[2 * i];  // what shines; the other layer is openness
        columns[i % 4] += double{seen.g} / (64.0 * double(tile.pixels() / 4));
    }
    if (columns[0] > 0.5) std::reverse(columns.begin(), columns.end());
    EXPECT_NEAR(columns[1], beyond, 0.01);
    EXPECT_NEAR(columns[1] + columns[2], 1, 0.01) << "both sides of the edge look alike";
    EXPECT_NEAR(columns[0] + columns[3], 1, 0.01);
}

// The tent of radius 1: ½ × (½)². The lowered gaussian of radius 1.5: its integral from 0.5 on, over the whole of it.
INSTANTIATE_TEST_SUITE_P(Shapes, Filters,
                         testing::Values(std::pair{"box", 0.0f}, std::pair{"tent", 0.125f},
                                         std::pair{"gaussian", 0.1529f}),
                         [](const auto& shape) { return std::string(shape.param.first); });

// A shining half-plane 4 m away, through a lens of 0.2 m: how much the pixels beside its edge see of it.
double blur_at(float focus_distance) {
    SceneData data;
    add(data, quad({0, -100, 0}, {100, 0, 0}, {0, 200, 0}), diffuse(data, 0)).emission = AreaEmission{{1, 1, 1}, true};
    data.camera = camera({0, 0, 4}, {0, 0, 0}, 20);
    data.camera_given = true;
    data.camera.lens_radius = 0.2f;
    data.camera.focus_distance = focus_distance;
    const Scene scene(data);
    Rig rig(scene);
    rig.add("AmbientOcclusion", "nothing");
    const std::uint32_t middle = scene.film().width / 2;
    std::vector<Rgb> pixels(2 * 40);
    rig.renderer("nothing")->render({middle - 20, scene.film().height / 2, 40, 1, 0, 16}, pixels);
    double mixed = 0;  // a pixel that sees both
    for (std::size_t i = 0; i < 40; ++i) {
        const double seen = double{pixels[2 * i].g} / 16;
        mixed += seen > 0.01 && seen < 0.99;
    }
    return mixed;
}

TEST(RayTracer, IsSharpInTheFocusOfItsLensAndNowhereElse) {
    EXPECT_LE(blur_at(4), 2);
    EXPECT_GE(blur_at(2), 38) << "the circle of confusion is far wider than 40 pixels";
}

TEST(RayTracer, TilesAndSamplesMakeNoDifference) {
    const Scene scene(furnace(0.5f, 1));
    Rig rig(scene);
    const auto renderer = rig.path_tracer();
    std::vector<Rgb> whole(2 * 12 * 10);
    renderer->render({0, 0, 12, 10, 16, 8}, whole);
    for (std::uint32_t y = 0; y < 10; y += 5)
        for (std::uint32_t x = 0; x < 12; x += 3) {
            std::vector<Rgb> part(2 * 3 * 5);
            renderer->render({x, y, 3, 5, 16, 8}, part);
            for (std::uint32_t i = 0; i < 15; ++i)
                for (std::size_t layer = 0; layer < 2; ++layer)
                    EXPECT_EQ(part[2 * i + layer], whole[2 * ((y + i / 3) * 12 + x + i % 3) + layer]);
        }
}

TEST(RayTracer, AsksAboutBothSidesOfACoat) {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}),
        material(data, CoatedDiffuseMaterial{colour(data, {0, 0, 0})}));
    data.environments.push_back({{1, 1, 1}});
    data.camera = camera({0, 4, 0.01f}, {0, 0, 0}, 10);
    data.camera_given = true;
    const Scene scene(data);
    Rig rig(scene);
    rig.add("DirectLighting", "direct");
    const auto pixels = picture(*rig.renderer("direct"), 32, 32, 64);
    double sum = 0;
    for (const Rgb& pixel : pixels) sum += pixel.r;
    EXPECT_NEAR(sum / double(pixels.size()), 0.04, 1e-3);  // the base is black: only the coat reflects
}

}  // namespace
}  // namespace lightnet::ray_tracer_test
