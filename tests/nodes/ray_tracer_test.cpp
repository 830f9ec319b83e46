#include <gtest/gtest.h>

#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet {
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
}  // namespace lightnet
