// Lamps that paths come to.
#include "core/estimate/lamps_met.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::lamps_met_test {
namespace {

using namespace test;

// The sixth is dark, and all are within a ball that is no lamp.
SceneData among(std::uint32_t lamps) {
    SceneData data;
    const auto black = diffuse(data, 0);
    add(data, ball({0, 0, 0}, 9), black);
    for (std::uint32_t i = 0; i < lamps; ++i) {
        Samples samples(3, i);
        const Vec3 at = sphere(samples.next_2d()) * 4, side = sphere(samples.next_2d());
        const float size = 6 / std::sqrt(float(lamps));
        Shape& lamp = add(data, quad(at, side * size, sphere(samples.next_2d()) * size), black);
        if (i != 5) lamp.emission = AreaEmission{Rgb{1, 2, 3} * (0.5f + samples.next()), i % 4 != 1};
    }
    return data;
}

class LampsThatAreMet : public testing::TestWithParam<std::uint32_t> {};

TEST_P(LampsThatAreMet, SendWhatTheyDoOneByOne) {
    const Scene scene(among(GetParam()));
    for (const Heuristic heuristic : {Heuristic::automatic, Heuristic::lamps, Heuristic::directions}) {
        LampsMet met;
        std::vector<Rgb> expected;
        std::size_t light = 0;
        for (std::uint32_t i = 0; i < 2000; ++i) {
            Samples samples(7, i);
            const Vec3 at = sphere(samples.next_2d()) * 2, direction = sphere(samples.next_2d());
            const auto hit = scene.intersect({at, direction});
            ASSERT_TRUE(hit);
            const LitPoint from = i % 3 == 0 ? LitPoint(at) : LitPoint(at, direction);
            const BsdfSample sample{direction, {1, 1, 1}, samples.next(), i % 7 == 0 ? lobe::specular : lobe::diffuse};
            const SurfacePoint end = scene.surface(*hit);
            met.add(scene, i, from, sample, end);
            expected.push_back(light_by_bsdf(scene, from, sample, &end, heuristic));
        }
        std::uint32_t last = 0;
        met.find(scene, heuristic, [&](std::uint32_t i, Rgb found, std::uint32_t) {
            EXPECT_GE(i, last);
            last = i;
            EXPECT_EQ(found, expected[i]) << i;
            expected[i] = {};
            light += !is_black(found);
        });
        for (const Rgb left : expected) EXPECT_EQ(left, Rgb{});
        EXPECT_GT(light, heuristic == Heuristic::lamps ? 10u : 50u);  // by points alone, but for specular ones
        met.find(scene, heuristic, [](std::uint32_t, Rgb, std::uint32_t) { ADD_FAILURE(); });  // they are forgotten
    }
}

INSTANTIATE_TEST_SUITE_P(Of, LampsThatAreMet, testing::Values(1, 7, 40, 400));

}  // namespace
}  // namespace lightnet::lamps_met_test
