// Groups of lamps: each has its own light and no other's, and together they have all of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "core/scene/data/lamp_names.hpp"
#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::lamp_groups_test {
namespace {

using namespace test;
using Params = SmallNetwork::Params;

constexpr std::uint32_t width = 16, height = 12;
const Value yes{true};

// A floor, a wall and a mirror under a red ball, a green square and a blue spot.
SceneData three_lamps(bool red = true, bool green = true, bool blue = true) {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0.6f));
    add(data, quad({-5, 0, -3}, {10, 0, 0}, {0, 6, 0}), diffuse(data, 0.5f));
    add(data, ball({1.5f, 0.7f, 0}, 0.7f), mirror(data, 0.9f));
    const auto lamp = [&](ShapeGeometry geometry, Rgb light, const char* name) {
        add(data, std::move(geometry), diffuse(data, 0)).emission = AreaEmission{light};
        data.shapes.back().name = name;
    };
    lamp(ball({-1, 2.5f, 0}, 0.4f), red ? Rgb{6, 0, 0} : Rgb{}, "bulb");
    lamp(quad({0, 3.5f, -1}, {1, 0, 0}, {0, 0, 1}), green ? Rgb{0, 8, 0} : Rgb{}, "panel");
    data.lights.push_back(SpotLight{{2, 4, -2}, normalize({-1, -2, 1}), {0, 0, blue ? 60.f : 0.f}, 0.2f, 0.5f});
    return data;
}

const std::vector<LampGroup> by_colour{{"blue", {"spot"}}, {"green", {"panel"}}, {"red", {"bulb"}}};

SceneData sorted(SceneData data, const std::vector<LampGroup>& groups = by_colour) {
    EXPECT_THAT(sort_lamps(data, groups), testing::IsEmpty());
    return data;
}

std::vector<std::string> names_of(const std::vector<LampGroup>& groups) {
    std::vector<std::string> names;
    for (const auto& group : groups) names.push_back(group.name);
    return names;
}

// Adds the nodes of a method; the last one is called "light".
using Method = void (*)(SmallNetwork&, const Params&);

Params with(Params params, const Params& more) {
    params.insert(more.begin(), more.end());
    return params;
}

void direct(SmallNetwork& network, const Params& groups) { network.add("light", "DirectLighting", {}, groups); }
void adaptive(SmallNetwork& network, const Params& groups) {
    network.add("light", "DirectLighting", {}, with(groups, {{"error", Value{0.2}}}));
}
void paths(SmallNetwork& network, const Params& groups) {
    network.add("light", "PathTracing", {}, with(groups, {{"paths", Value{std::string("all")}}}));
}
const Params all_photons{{"paths", Value{std::string("all")}}, {"photons", Value{3000.0}}};
void photons(SmallNetwork& network, const Params& groups) {
    network.add("light", "PhotonMap", {}, with(groups, all_photons));
}
void progressive(SmallNetwork& network, const Params& groups) {
    network.add("light", "ProgressivePhotonMapping", {}, with(groups, all_photons));
}
void gathered(SmallNetwork& network, const Params& groups) {
    network.add("below", "DirectLighting", {}, groups)
        .add("map", "PhotonMap", {}, with(groups, {{"photons", Value{3000.0}}}))
        .add("first", "Combine", {"below", "map"})
        .add("light", "FinalGather", {"first"}, groups);
}
void cached(SmallNetwork& network, const Params& groups) {
    network.add("below", "DirectLighting", {}, groups)
        .add("map", "PhotonMap", {}, with(groups, {{"photons", Value{3000.0}}}))
        .add("first", "Combine", {"below", "map"})
        .add("light", "IrradianceCache", {"first"}, with(groups, {{"rays", Value{64.0}}}));
}

SmallNetwork network_of(Method method, const std::vector<LampGroup>& groups, const Params& params) {
    SmallNetwork network(sorted(three_lamps(), groups), width, height);
    method(network, params);
    network.groups(names_of(groups));
    return network;
}

struct NamedMethod {
    const char* name;
    Method add;
    friend std::ostream& operator<<(std::ostream& out, const NamedMethod& method) { return out << method.name; }
};

class LampGroups : public testing::TestWithParam<NamedMethod> {
protected:
    Method method() const { return GetParam().add; }
};
class LampGroupsToTheBit : public LampGroups {};
class LampGroupsThatAreLookedFor : public LampGroups {};

const std::vector<NamedMethod> looking_for_lamps{
    {"direct", direct}, {"adaptive", adaptive}, {"paths", paths}, {"photons", photons}, {"progressive", progressive}};
std::vector<NamedMethod> joined(std::vector<NamedMethod> methods, std::vector<NamedMethod> more) {
    methods.insert(methods.end(), more.begin(), more.end());
    return methods;
}
INSTANTIATE_TEST_SUITE_P(EveryMethod, LampGroups,
                         testing::ValuesIn(joined(looking_for_lamps, {{"gathered", gathered}, {"cached", cached}})));
// The cache limits the gradient of each group by itself.
INSTANTIATE_TEST_SUITE_P(EveryMethodButTheCache, LampGroupsToTheBit,
                         testing::ValuesIn(joined(looking_for_lamps, {{"gathered", gathered}})));
INSTANTIATE_TEST_SUITE_P(EveryMethodThatLooksForLamps, LampGroupsThatAreLookedFor,
                         testing::ValuesIn(looking_for_lamps));

TEST_P(LampGroups, HaveNothingOfTheLightOfOthers) {
    const auto layers = network_of(method(), by_colour, {{"groups", yes}}).pictures(16);
    for (const std::string node : {"light", "emission"}) {
        Rgb own, others;
        for (std::size_t i = 0; i < width * height; ++i) {
            const Rgb red = layers.at(node + ".red")[i], green = layers.at(node + ".green")[i],
                      blue = layers.at(node + ".blue")[i];
            own += {red.r, green.g, blue.b};
            others += {green.r + blue.r, red.g + blue.g, red.b + green.b};
        }
        EXPECT_EQ(others, Rgb{}) << node;
        for (const Rgb& pixel : layers.at(node + ".rest")) EXPECT_TRUE(is_black(pixel)) << node;
        if (node == "light") {
            EXPECT_GT(std::min({own.r, own.g, own.b}), 0.1f) << "each is somewhere";
        }
    }
}

// Lamps of one colour each: a channel's sum has one part that isn't nought, so nothing is rounded otherwise.
TEST_P(LampGroupsToTheBit, HaveTogetherWhatIsThereWithoutThem) {
    const auto apart = network_of(method(), by_colour, {{"groups", yes}}).pictures(16);
    const auto plain = network_of(method(), by_colour, {}).pictures(16).at("light");
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const Rgb sum{apart.at("light.red")[i].r, apart.at("light.green")[i].g, apart.at("light.blue")[i].b};
        EXPECT_EQ(sum, plain[i]) << "pixel " << i;
    }
}

TEST_P(LampGroups, OfWhichOneHasAllLampsAreWhatIsThereWithoutThem) {
    const std::vector<LampGroup> whole{{"everything", {"*"}}};
    const auto apart = network_of(method(), whole, {{"groups", yes}}).pictures(16);
    const auto plain = network_of(method(), whole, {}).pictures(16);
    EXPECT_EQ(apart.at("light.everything"), plain.at("light"));
}

TEST_P(LampGroupsThatAreLookedFor, AloneAreASceneWithoutTheOthers) {
    const Params red{{"lamps", Value{std::string("red")}}};
    const auto restricted = network_of(method(), by_colour, red).pictures(16).at("light");
    SmallNetwork alone(three_lamps(true, false, false), width, height);
    method()(alone, {});
    EXPECT_EQ(restricted, alone.pictures(16).at("light"));
}

TEST(GroupsOfLamps, OfTheCacheAddUpToItsLight) {
    const auto apart = network_of(cached, by_colour, {{"groups", yes}}).pictures(16);
    const auto plain = network_of(cached, by_colour, {}).pictures(16).at("light");
    double off = 0, all = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const Rgb sum = apart.at("light.red")[i] + apart.at("light.green")[i] + apart.at("light.blue")[i];
        off += std::fabs(double{luminance(sum)} - luminance(plain[i])), all += luminance(plain[i]);
    }
    EXPECT_LT(off, 1e-3 * all);
}

TEST(GroupsOfLamps, AreShownAsOneWhereAnOperatorIsShown) {
    auto network = network_of(paths, by_colour, {{"groups", yes}});
    const auto layers = network.show({"light"}).pictures(16);
    for (std::size_t i = 0; i < width * height; ++i) {
        const Rgb sum{layers.at("light.red")[i].r, layers.at("light.green")[i].g, layers.at("light.blue")[i].b};
        EXPECT_EQ(sum, layers.at("light")[i]);
    }
}

}  // namespace
}  // namespace lightnet::lamp_groups_test
