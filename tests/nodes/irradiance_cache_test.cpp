// Irradiance that is interpolated, beside light that is known.
#include <gtest/gtest.h>

#include <utility>

#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::irradiance_cache_test {
namespace {

using namespace test;

Value number(double value) { return Value{value}; }
Value word(const char* text) { return Value{std::string(text)}; }

// A room of albedo 0.6, open in front, with a lamp below the ceiling and a ball on the floor.
SceneData room_with_ball(MaterialId (*material_of_ball)(SceneData&)) {
    SceneData data;
    add(data, room(), diffuse(data, 0.6f));
    add(data, ball({0.6f, 0.25f, 0.6f}, 0.25f), material_of_ball(data));
    add(data, quad({0.35f, 0.99f, 0.35f}, {0.3f, 0, 0}, {0, 0, 0.3f}), diffuse(data, 0)).emission =
        AreaEmission{{10, 10, 10}, false};
    data.camera = camera({0.1f, 0.6f, 0.1f}, {0.6f, 0.3f, 0.6f}, 80);
    data.camera_given = true;
    return data;
}

MaterialId matte(SceneData& data) { return diffuse(data, 0.6f); }
MaterialId paper(SceneData& data) {
    DiffuseMaterial sheet;
    sheet.reflectance = colour(data, {0.3f, 0.3f, 0.3f});
    sheet.transmittance = colour(data, {0.5f, 0.5f, 0.5f});
    return material(data, sheet);
}
MaterialId lacquer(SceneData& data) {
    CoatedDiffuseMaterial coated{colour(data, {0.6f, 0.6f, 0.6f})};
    coated.roughness = {0.3f, 0.3f};
    return material(data, coated);
}

double indirect(const SceneData& data, const char* kind, SmallNetwork::Params params, std::uint32_t samples) {
    SmallNetwork network(data, 24, 24);
    network.add("all", "PathTracing", {}, {{"paths", word("all")}}).add("soft", kind, {"all"}, std::move(params));
    return mean_of(network.picture(samples));
}

/// A ball's material, and how much of the light the cache may find too much or too little: a lacquer does not scatter
/// evenly, which the cache takes it to do.
using Ball = std::pair<MaterialId (*)(SceneData&), double>;
class Cache : public testing::TestWithParam<Ball> {};

// Both look at the same paths one surface further on; the cache may be wrong by what it interpolates.
TEST_P(Cache, FindsAsMuchLightAsLookingAroundEachTime) {
    const auto [material, bias] = GetParam();
    const auto data = room_with_ball(material);
    // Enough of both that noise does not hide the bias.
    const double exact = indirect(data, "FinalGather", {}, 800);
    EXPECT_NEAR(indirect(data, "IrradianceCache", {{"rays", number(1024)}}, 16), exact, bias * exact);
}

INSTANTIATE_TEST_SUITE_P(Balls, Cache, testing::Values(Ball{matte, 0.01}, Ball{paper, 0.01}, Ball{lacquer, 0.015}));

// Of albedo ρ and emission 1: by way of two walls or more ρ² / (1 - ρ), everywhere, so that interpolation adds no
// error.
TEST(IrradianceCache, SeesTheFurnaceAsBrightAsItIs) {
    for (const float albedo : {0.5f, 0.8f}) {
        const double exact = double{albedo} * albedo / (1 - albedo);
        EXPECT_NEAR(indirect(furnace(albedo, 1), "IrradianceCache", {}, 1) - 1, exact, 0.01 * exact);
    }
}

// All light is that of a small bright patch of the ceiling, which most rays of a record miss.
TEST(IrradianceCache, TakesSoManyRaysThatItsLightIsHardlyNoisy) {
    SceneData data;
    add(data, room(), diffuse(data, 0.02f));
    add(data, quad({0.45f, 0.98f, 0.45f}, {0.1f, 0, 0}, {0, 0, 0.1f}), diffuse(data, 0.9f));
    add(data, quad({0.45f, 0.9f, 0.45f}, {0, 0, 0.1f}, {0.1f, 0, 0}), diffuse(data, 0)).emission =
        AreaEmission{{100, 100, 100}, false};
    data.camera = camera({0.1f, 0.6f, 0.1f}, {0.6f, 0.3f, 0.6f}, 80);
    data.camera_given = true;
    const auto apart = [&](SmallNetwork::Params params) {
        SmallNetwork network(data, 24, 24);
        network.add("all", "PathTracing", {}, {{"paths", word("all")}}).add("soft", "IrradianceCache", {"all"}, params);
        const auto one = network.picture(1, 1), other = network.picture(1, 2);
        double difference = 0, sum = 0;
        for (std::size_t i = 0; i < one.size(); ++i) {
            difference += std::fabs(double{one[i].g} - double{other[i].g});
            sum += double{one[i].g};
        }
        return difference / sum;
    };
    EXPECT_LT(apart({}), 0.85 * apart({{"rays", number(384)}}));
}

TEST(IrradianceCache, RefusesFewerRaysThanMakeARecord) {
    const Registry registry(standard_nodes());
    const Kind& kind = *registry.find("IrradianceCache");
    Node node{"soft", kind.name, {}, {}, {}};
    for (const auto& param : kind.params)
        if (param.initial) node.params.emplace(param.name, *param.initial);
    for (const double rays : {0.0, 8.0}) {
        node.params.insert_or_assign("rays", number(rays));
        EXPECT_TRUE(kind.mistakes(node, nullptr).empty()) << rays;
    }
    node.params.insert_or_assign("rays", number(7));
    EXPECT_EQ(kind.mistakes(node, nullptr).size(), 1u);
}

TEST(IrradianceCache, ComesNearerTheMoreAccurateItIs) {
    const auto picture = [&](const char* kind, SmallNetwork::Params params, std::uint32_t samples) {
        SmallNetwork network(room_with_ball(matte), 16, 16);
        network.add("all", "PathTracing", {}, {{"paths", word("all")}}).add("soft", kind, {"all"}, std::move(params));
        return network.picture(samples);
    };
    const auto exact = picture("FinalGather", {{"rays", number(4)}}, 64);
    const auto error = [&](double accuracy) {
        const auto soft = picture("IrradianceCache",
                                  {{"accuracy", number(accuracy)},
                                   {"rays", number(512)},
                                   {"min_spacing", number(0.001)},
                                   {"max_spacing", number(10)}},
                                  4);
        double sum = 0;
        for (std::size_t i = 0; i < soft.size(); ++i) sum += std::fabs(soft[i].g - exact[i].g);
        return sum;
    };
    EXPECT_LT(error(0.1), 0.8 * error(1));
}

}  // namespace
}  // namespace lightnet::irradiance_cache_test
