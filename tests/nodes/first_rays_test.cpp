// Two nodes whose paths begin alike: worked out once, and the same to the bit as if each were alone.
#include <gtest/gtest.h>

#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::first_rays_test {
namespace {

using namespace test;

constexpr std::uint32_t size = 8;

struct Case {
    const char* name;
    bool sky, lamp;
    double direct_samples, path_samples;
    bool direct_first;
    bool once;  // are they worked out once?
    double error = 0;
};

SceneData things_of_all_kinds(const Case& wanted) {
    SceneData data;
    data.camera = camera({0.5f, 0.5f, 2.6f}, {0.5f, 0.4f, 0}, 45);
    data.camera_given = true;
    data.film.width = data.film.height = size;
    if (wanted.sky) data.environments.push_back({{0.7f, 0.8f, 1}});
    if (wanted.lamp)
        add(data, quad({0.3f, 0.95f, 0.1f}, {0.3f, 0, 0}, {0, 0, 0.3f}), diffuse(data, 0)).emission =
            AreaEmission{{20, 20, 20}, true};
    add(data, quad({-2, 0, -2}, {0, 0, 5}, {5, 0, 0}), diffuse(data, 0.6f));
    add(data, ball({0.8f, 0.2f, 0.5f}, 0.2f), material(data, DielectricMaterial{}));
    add(data, ball({0.2f, 0.2f, 0.4f}, 0.2f), material(data, CoatedDiffuseMaterial{colour(data, {.7f, .7f, .7f})}));
    return data;
}

class FirstRaysOf : public testing::TestWithParam<Case> {
protected:
    struct Rendered {
        std::vector<Rgb> pixels;
        std::uint64_t rays = 0;
    };
    Rendered rendered(bool shares) const {
        const Case& wanted = GetParam();
        const Scene scene(things_of_all_kinds(wanted));
        Rig rig(scene, 1, shares);
        rig.add("DirectLighting", "direct", {},
                {{"samples", Value{wanted.direct_samples}}, {"error", Value{wanted.error}}});
        rig.add("PathTracing", "bounce", {}, {{"samples", Value{wanted.path_samples}}});
        const std::vector<std::string> inputs{wanted.direct_first ? "direct" : "bounce",
                                              wanted.direct_first ? "bounce" : "direct"};
        rig.add("Combine", "lighting", inputs);
        const auto renderer = rig.renderer("lighting");
        const auto before = Scene::rays_of_this_thread();
        return {picture(*renderer, size, size, 4), Scene::rays_of_this_thread() - before};
    }
};

TEST_P(FirstRaysOf, TwoNodesGiveTheSameBitsAsOfEachAlone) {
    const auto together = rendered(true), alone = rendered(false);
    EXPECT_EQ(together.pixels, alone.pixels);
    if (GetParam().once)
        EXPECT_LT(together.rays, alone.rays);
    else
        EXPECT_EQ(together.rays, alone.rays);
}

INSTANTIATE_TEST_SUITE_P(Layers, FirstRaysOf,
                         testing::Values(Case{"UnderASky", true, false, 1, 1, true, true},
                                         Case{"UnderALamp", false, true, 1, 1, true, true},
                                         Case{"InTheOtherOrder", true, true, 1, 1, false, true},
                                         Case{"OfThreeSamples", true, true, 3, 3, true, true},
                                         Case{"OfMoreSamplesThanAreKept", true, true, 16, 16, true, false},
                                         Case{"OfDifferentSamples", true, true, 1, 2, true, false},
                                         Case{"ForAnError", true, true, 1, 1, true, false, 0.1}),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace lightnet::first_rays_test
