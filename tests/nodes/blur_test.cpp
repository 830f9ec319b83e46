// Blur against instants: with the shutter open, a scene is the average of stills at times while it is.
//
// Each picture is rendered several times. Both ways are right on average: the moments of the stills are drawn anew each
// time, one in each 64th of the shutter. So all that their means may differ by follows from how far repetitions do.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/base/math/samples.hpp"
#include "tests/support/moving_scenes.hpp"
#include "tests/support/small_network.hpp"

namespace lightnet::blur_test {
namespace {

using namespace test;

constexpr std::uint32_t size = 16, instants = 64, samples_of_instant = 4, repetitions = 6;

using Pixels = std::vector<Rgb>;

Pixels traced(SceneData scene, std::uint32_t samples, std::uint64_t seed) {
    SmallNetwork network(std::move(scene), size, size);
    network.add("direct", "DirectLighting")
        .add("bounce", "PathTracing")
        .add("lighting", "Combine", {"direct", "bounce"});
    return network.picture(samples, seed);
}

Pixels average_of_instants(const MovingScene& scene, std::uint64_t seed, double late) {
    Pixels sum(size * size);
    Samples moments(seed, 0);
    for (std::uint32_t i = 0; i < instants; ++i) {
        const double seconds = (i + double{moments.next()}) / instants;
        const auto still = traced(scene.at(seconds + late), samples_of_instant, seed * 1000 + i);
        for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += still[p] / float(instants);
    }
    return sum;
}

/// Numbers, added up with their squares.
struct Spread {
    double sum = 0, squares = 0;
    void add(double x) { sum += x, squares += x * x; }
    double mean() const { return sum / repetitions; }
    /// Of the mean; without bias.
    double variance() const { return (squares / repetitions - mean() * mean()) / (repetitions - 1); }
};

/// How far two ways are apart, of what their noise is: of pixels the mean square, and of the picture's mean.
struct Apart {
    double pixels = 0, pixels_allowed = 0, mean = 0;
};

std::vector<Pixels> repeated(const std::function<Pixels(std::uint64_t)>& render) {
    std::vector<Pixels> pictures;
    for (std::uint64_t seed = 1; seed <= repetitions; ++seed) pictures.push_back(render(seed));
    return pictures;
}

Spread spread_of(const std::vector<Pixels>& pictures, const std::function<double(const Pixels&)>& number) {
    Spread spread;
    for (const Pixels& picture : pictures) spread.add(number(picture));
    return spread;
}

double whole(const Pixels& picture) {
    double sum = 0;
    for (const Rgb& pixel : picture) sum += double{luminance(pixel)} / double(picture.size());
    return sum;
}

Apart apart_of(const std::vector<Pixels>& one, const std::vector<Pixels>& other) {
    double squares = 0, variance = 0, of_variance = 0;
    for (std::size_t p = 0; p < one[0].size(); ++p) {
        const auto pixel = [p](const Pixels& picture) { return double{luminance(picture[p])}; };
        const Spread a = spread_of(one, pixel), b = spread_of(other, pixel);
        const double off = a.mean() - b.mean(), expected = a.variance() + b.variance();
        squares += off * off, variance += expected, of_variance += expected * expected;
    }
    // a square of normal numbers has twice its squared variance; that of what is expected comes on top
    const double deviation = std::sqrt(of_variance * (2 + 2.0 / (repetitions - 1))) / variance;
    const Spread a = spread_of(one, whole), b = spread_of(other, whole);
    return {squares / variance, 1 + 5 * deviation,
            std::fabs(a.mean() - b.mean()) / std::sqrt(a.variance() + b.variance())};
}

class Blur : public testing::TestWithParam<MovingScene> {};

TEST_P(Blur, IsTheAverageOfSixtyFourInstants) {
    const MovingScene& scene = GetParam();
    const SceneData blurred = scene.blurred();
    EXPECT_TRUE(!blurred.motion.empty() || !blurred.camera.later.empty()) << "it moves";
    const auto in_shutter =
        repeated([&](std::uint64_t seed) { return traced(blurred, instants * samples_of_instant, seed); });
    const auto apart_when = [&](double late) {
        return apart_of(in_shutter,
                        repeated([&](std::uint64_t seed) { return average_of_instants(scene, seed, late); }));
    };
    const Apart apart = apart_when(0), apart_when_late = apart_when(0.1);
    EXPECT_LT(apart.pixels, apart.pixels_allowed);
    EXPECT_LT(apart.mean, 8) << "deviations; of so few repetitions, one in 100,000 is as far off";
    EXPECT_GT(apart_when_late.pixels, 2 * apart_when_late.pixels_allowed) << "a tenth of the shutter would show";
}

INSTANTIATE_TEST_SUITE_P(Of, Blur, testing::ValuesIn(moving_scenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace lightnet::blur_test
