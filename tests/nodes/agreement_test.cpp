// Every algorithm that covers the paths of a scene gives the picture that another renderer gives.
//
// Pictures are a half as wide and high as the references, whose pixels are put together; with LIGHTNET_LARGE they are
// as large (ctest -L slow). Methods with bias state it: their mean may be off by 1 %, blocks of 16 × 16 pixels by what
// is written beside them. What noise adds is taken from two runs with different seeds.
#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>

#include "core/film/compare.hpp"
#include "core/film/exr.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/read_scene.hpp"
#include "tests/support/references.hpp"
#include "tests/support/small_network.hpp"

namespace lightnet::agreement_test {
namespace {

using namespace test;

#ifdef LIGHTNET_LARGE
constexpr std::uint32_t reduction = 1;
#else
constexpr std::uint32_t reduction = 2;
#endif

Value number(double value) { return Value{value}; }
Value word(const char* text) { return Value{std::string(text)}; }

/// Adds the operators of a method; the last one is the lighting.
using Method = std::function<void(SmallNetwork&)>;

void path_tracing(SmallNetwork& network) { network.add("lighting", "PathTracing", {}, {{"paths", word("all")}}); }

// Edges of surfaces are too dark in maps: with 200,000 photons the room behind the door lacks 1 % of its light.
void add_maps(SmallNetwork& network) {
    network.add("direct", "DirectLighting")
        .add("caustics", "PhotonMap", {}, {{"gather", number(50)}})
        .add("global", "PhotonMap", {},
             {{"paths", word("diffuse")}, {"gather", number(50)}, {"photons", number(500000)}})
        .add("first", "Combine", {"direct", "caustics", "global"});
}

void map_and_final_gather(SmallNetwork& network) {
    add_maps(network);
    network.add("gathered", "FinalGather", {"first"}).add("lighting", "Combine", {"direct", "caustics", "gathered"});
}

void map_and_cache(SmallNetwork& network) {
    add_maps(network);
    network.add("soft", "IrradianceCache", {"first"}).add("lighting", "Combine", {"direct", "caustics", "soft"});
}

void paths_and_cache(SmallNetwork& network) {
    network.add("direct", "DirectLighting")
        .add("paths", "PathTracing", {}, {{"paths", word("all")}})
        .add("soft", "IrradianceCache", {"paths"})
        .add("lighting", "Combine", {"direct", "soft"});
}

void progressive(SmallNetwork& network) {
    network.add("direct", "DirectLighting")
        .add("photons", "ProgressivePhotonMapping", {}, {{"paths", word("indirect")}})
        .add("lighting", "Combine", {"direct", "photons"});
}

struct Case {
    std::string name, scene, reference;
    Method method;
    std::uint32_t samples;
    double mean, blocks;  // relative: what may be wrong beside noise
};

std::ostream& operator<<(std::ostream& out, const Case& agreement) { return out << agreement.name; }

/// Squares of pixels become one, their mean: what a box filter over it shows.
Picture reduced(const Picture& whole) {
    Picture small;
    small.width = whole.width / reduction, small.height = whole.height / reduction;
    small.beauty.resize(std::size_t{small.width} * small.height);
    for (std::uint32_t y = 0; y < small.height * reduction; ++y)
        for (std::uint32_t x = 0; x < small.width * reduction; ++x)
            small.beauty[y / reduction * small.width + x / reduction] +=
                whole.beauty[y * whole.width + x] * (1.0f / (reduction * reduction));
    return small;
}

class Agreement : public testing::TestWithParam<Case> {};

TEST_P(Agreement, WithTheReference) {
    const Case& expected = GetParam();
    const Picture reference = reduced(read_exr(reference_file(expected.reference).value()));
    const auto render = [&](std::uint64_t seed) {
        DiskFiles disk;
        SceneData data = read_scene(disk, reference_file(expected.scene).value().string());
        const float scale = data.film.scale;
        SmallNetwork network(std::move(data), reference.width, reference.height);
        expected.method(network);
        Picture picture;
        picture.width = reference.width, picture.height = reference.height;
        picture.beauty = network.picture(expected.samples, seed);
        for (Rgb& pixel : picture.beauty) pixel = pixel * scale;
        return picture;
    };
    Picture picture = render(1);
    const Picture other = render(2);
    const double noise = compare(picture, other).block_difference / 2;  // of the mean of both
    for (std::size_t i = 0; i < picture.beauty.size(); ++i)
        picture.beauty[i] = (picture.beauty[i] + other.beauty[i]) * 0.5f;
    const Difference found = compare(reference, picture);
    EXPECT_NEAR(found.mean_ratio.g, 1, expected.mean);
    EXPECT_LT(found.block_difference, expected.blocks + 1.5 * noise) << "noise of the run: " << noise;
    RecordProperty("mean_ratio", std::to_string(found.mean_ratio.g));
    RecordProperty("block_difference", std::to_string(found.block_difference));
    RecordProperty("relative_square", std::to_string(found.relative_square));
}

const std::string grey = "cornell_grey.mits_path_2048.exr", indirect = "indirect.mits_path_2048.exr",
                  caustic = "caustic.mits_bdpt_1280.exr";

INSTANTIATE_TEST_SUITE_P(
    Strict, Agreement,
    testing::Values(Case{"grey_paths", "cornell_grey.pbrt", grey, path_tracing, 64, 0.003, 0.005},
                    Case{"grey_map_gather", "cornell_grey.pbrt", grey, map_and_final_gather, 16, 0.01, 0.015},
                    Case{"grey_map_cache", "cornell_grey.pbrt", grey, map_and_cache, 16, 0.01, 0.03},
                    Case{"grey_path_cache", "cornell_grey.pbrt", grey, paths_and_cache, 16, 0.01, 0.03},
                    Case{"grey_progressive", "cornell_grey.pbrt", grey, progressive, 32, 0.01, 0.03},
                    Case{"indirect_paths", "indirect.pbrt", indirect, path_tracing, 64, 0.005, 0.015},
                    Case{"indirect_map_gather", "indirect.pbrt", indirect, map_and_final_gather, 16, 0.01, 0.03},
                    Case{"indirect_path_cache", "indirect.pbrt", indirect, paths_and_cache, 16, 0.01, 0.03},
                    Case{"caustic_map_gather", "caustic.pbrt", caustic, map_and_final_gather, 16, 0.01, 0.03},
                    Case{"caustic_map_cache", "caustic.pbrt", caustic, map_and_cache, 16, 0.01, 0.03},
                    Case{"caustic_progressive", "caustic.pbrt", caustic, progressive, 32, 0.01, 0.03}),
    [](const auto& agreement) { return agreement.param.name; });

}  // namespace
}  // namespace lightnet::agreement_test
