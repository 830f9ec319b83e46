// Bias of blur: how far networks that remember are from the average of 64 instants, while the shutter is open.
//
// docs/bias.md states the figures that are asserted here. With LIGHTNET_LARGE (ctest -L slow, or the program itself)
// all networks are measured, more closely, and a table like the one there is printed: guided path tracing, a cache over
// path tracing, figure 5's network, progressive photons, and maps that are looked at directly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/base/math/samples.hpp"
#include "tests/support/moving_scenes.hpp"
#include "tests/support/small_network.hpp"

namespace lightnet::blur_bias_test {
namespace {

using namespace test;

#ifdef LIGHTNET_LARGE
constexpr std::uint32_t size = 32, samples = 64, seeds = 6, samples_of_instant = 16, photons = 0;
#else
constexpr std::uint32_t size = 16, samples = 32, seeds = 4, samples_of_instant = 8, photons = 20000;
#endif
constexpr std::uint32_t instants = 64, block = size / 4, blocks = 16;

Value number(double value) { return Value{value}; }
Value word(const char* text) { return Value{std::string(text)}; }

void path_tracing(SmallNetwork& network) {
    network.add("direct", "DirectLighting")
        .add("bounce", "PathTracing")
        .add("lighting", "Combine", {"direct", "bounce"});
}
[[maybe_unused]] void guided(SmallNetwork& network) {
    network.add("guide", "Guide", {}, {{"paths", number(20000)}, {"when", word("always")}})
        .add("lighting", "PathTracing", {}, {{"paths", word("all")}, {"guide", Value{NodeRef{"guide"}}}});
}
// As graphs/irradiance_cache.lua.
void cache(SmallNetwork& network) {
    network.add("direct", "DirectLighting")
        .add("paths", "PathTracing", {}, {{"paths", word("all")}})
        .add("soft", "IrradianceCache", {"paths"}, {{"error", number(0.04)}})
        .add("lighting", "Combine", {"direct", "soft"});
}
void add_maps(SmallNetwork& network) {
    network.add("direct", "DirectLighting")
        .add(
            "caustics", "PhotonMap", {},
            {{"paths", word("caustic")}, {"photons", number(photons)}, {"error", number(0.04)}, {"gather", number(50)}})
        .add("global", "PhotonMap", {},
             {{"paths", word("diffuse")},
              {"photons", number(photons)},
              {"error", number(0.04)},
              {"gather", number(50)}});
}
void maps(SmallNetwork& network) {
    add_maps(network);
    network.add("lighting", "Combine", {"direct", "caustics", "global"});
}
// As graphs/paper/figure5.lua.
void figure5(SmallNetwork& network) {
    add_maps(network);
    network.add("first", "Combine", {"direct", "caustics", "global"})
        .add("soft", "IrradianceCache", {"first"}, {{"glossy_rays", number(4)}, {"error", number(0.04)}})
        .add("lighting", "Combine", {"direct", "caustics", "soft"});
}
void progressive(SmallNetwork& network) {
    network.add("direct", "DirectLighting")
        .add("photons", "ProgressivePhotonMapping", {}, {{"paths", word("indirect")}, {"photons", number(10000)}})
        .add("lighting", "Combine", {"direct", "photons"});
}

struct Method {
    std::string name;
    std::function<void(SmallNetwork&)> network;
};

/// Of each block the luminance, and that of the whole behind them.
std::vector<double> in_blocks(const std::vector<Rgb>& pixels) {
    std::vector<double> means(blocks + 1);
    for (std::uint32_t p = 0; p < size * size; ++p) {
        const double light = double{luminance(pixels[p])};
        means[p / size / block * 4 + p % size / block] += light / (block * block);
        means[blocks] += light / (size * size);
    }
    return means;
}

/// Means of several seeds, and the variance of these means.
struct Measured {
    std::vector<double> means = std::vector<double>(blocks + 1), variances = std::vector<double>(blocks + 1);
};
Measured measured(const std::function<std::vector<Rgb>(std::uint64_t)>& render) {
    Measured all;
    std::vector<double> squares(blocks + 1);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const auto found = in_blocks(render(seed));
        for (std::size_t i = 0; i < found.size(); ++i)
            all.means[i] += found[i] / seeds, squares[i] += found[i] * found[i] / seeds;
    }
    for (std::size_t i = 0; i < squares.size(); ++i)
        all.variances[i] = std::max(0.0, squares[i] - all.means[i] * all.means[i]) / (seeds - 1);
    return all;
}

std::vector<Rgb> picture_of(const SceneData& scene, const Method& method, std::uint32_t count, std::uint64_t seed) {
    SmallNetwork network(scene, size, size);
    method.network(network);
    return network.picture(count, seed);
}

const Method by_paths{"path tracing", path_tracing};

Measured average_of_instants(const MovingScene& scene) {
    return measured([&](std::uint64_t seed) {
        std::vector<Rgb> sum(size * size);
        Samples moments(seed, 0);
        for (std::uint32_t i = 0; i < instants; ++i) {
            const auto still = picture_of(scene.at((i + double{moments.next()}) / instants), by_paths,
                                          samples_of_instant, seed * 1000 + i);
            for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += still[p] / float(instants);
        }
        return sum;
    });
}

/// What two are apart beside their noise, of the mean; and how sure that is: a standard deviation.
struct Bias {
    double mean = 0, mean_deviation = 0, blocks_squared = 0, blocks_deviation = 0;
    double blocks() const { return std::sqrt(std::max(0.0, blocks_squared)); }
};
Bias bias_of(const Measured& found, const Measured& expected) {
    const double whole = expected.means[blocks];
    double squares = 0, variance = 0, of_squares = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
        const double off = found.means[i] - expected.means[i], noise = found.variances[i] + expected.variances[i];
        squares += off * off / blocks, variance += noise / blocks;
        of_squares += (2 * noise * noise * (1 + 1.0 / (seeds - 1)) + 4 * off * off * noise) / (blocks * blocks);
    }
    return {found.means[blocks] / whole - 1, std::sqrt(found.variances[blocks] + expected.variances[blocks]) / whole,
            (squares - variance) / (whole * whole), std::sqrt(of_squares) / (whole * whole)};
}

/// What docs/bias.md states of each method: by how much of the mean pictures and their blocks are off, at most,
/// percent.
struct Stated {
    double mean = 0, blocks = 0;
};
std::map<std::string, Stated> stated_of(const std::string& scene) {
    static const std::map<std::string, std::map<std::string, Stated>> all{
        {"CameraPan",
         {{"cache", {0.1, 0.2}}, {"figure5", {0.1, 0.2}}, {"maps", {0.5, 0.7}}, {"progressive", {0.6, 0.7}}}},
        {"SpinningWheel",
         {{"cache", {0.6, 1.1}}, {"figure5", {0.3, 0.5}}, {"maps", {0.7, 1.2}}, {"progressive", {1.0, 1.2}}}},
        {"SkinnedFigure",
         {{"cache", {0.9, 1.8}}, {"figure5", {0.6, 1.2}}, {"maps", {0.5, 0.6}}, {"progressive", {0.6, 0.6}}}},
        {"DeformingCloth",
         {{"cache", {0.2, 0.4}}, {"figure5", {0.4, 0.6}}, {"maps", {1.7, 2.5}}, {"progressive", {2.3, 3.4}}}},
        {"MovingLamp",
         {{"cache", {0.2, 0.5}}, {"figure5", {0.3, 0.5}}, {"maps", {1.0, 0.6}}, {"progressive", {1.1, 0.6}}}},
        {"InstanceSwarm",
         {{"cache", {0.1, 0.2}}, {"figure5", {0.1, 0.2}}, {"maps", {0.8, 0.8}}, {"progressive", {1.1, 1.0}}}}};
    return all.at(scene);
}

std::vector<Method> methods() {
#ifdef LIGHTNET_LARGE
    return {{"guided", guided}, {"cache", cache}, {"figure5", figure5}, {"progressive", progressive}, {"maps", maps}};
#else
    return {{"cache", cache}, {"figure5", figure5}, {"progressive", progressive}, {"maps", maps}};
#endif
}

class BlurBias : public testing::TestWithParam<MovingScene> {};

TEST_P(BlurBias, IsWhatIsStated) {
    const MovingScene& scene = GetParam();
    const SceneData blurred = scene.blurred();
    const Measured expected = average_of_instants(scene);
    auto stated = stated_of(scene.name);
    std::string row = "| " + scene.name;
    for (const Method& method : methods()) {
        const Bias bias =
            bias_of(measured([&](std::uint64_t seed) { return picture_of(blurred, method, samples, seed); }), expected);
        row += fmt::format(" | {:+.2f} ± {:.2f} %, {:.2f} %", 100 * bias.mean, 100 * bias.mean_deviation,
                           100 * bias.blocks());
        const auto [mean, apart] = stated[method.name];  // none of a method that is right on average
        EXPECT_LT(std::fabs(bias.mean), mean / 100 + 5 * bias.mean_deviation) << method.name;
        EXPECT_LT(bias.blocks_squared, apart * apart / 1e4 + 5 * bias.blocks_deviation) << method.name;
    }
#ifdef LIGHTNET_LARGE
    fmt::print("{} |\n", row);
#endif
    RecordProperty("row", row);
}

INSTANTIATE_TEST_SUITE_P(Of, BlurBias, testing::ValuesIn(moving_scenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace lightnet::blur_bias_test
