// Pictures of what operators give each other, beside the picture that they make.
#include <gmock/gmock.h>

#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::show_test {
namespace {

using namespace test;

Value number(double value) { return Value{value}; }
Value word(const char* text) { return Value{std::string(text)}; }
Value node(const char* name) { return Value{NodeRef{name}}; }

double mean(const std::vector<Rgb>& pixels) { return mean_of(pixels); }

// A room whose walls shine and reflect half.
SmallNetwork cached_furnace() {
    SmallNetwork network(furnace(0.5f, 1), 24, 24);
    network.add("direct", "DirectLighting")
        .add("map", "PhotonMap", {}, {{"paths", word("diffuse")}, {"photons", number(20000)}})
        .add("first", "Combine", {"direct", "map"})
        .add("soft", "IrradianceCache", {"first"}, {{"rays", number(64)}, {"stride", number(8)}})
        .add("lighting", "Combine", {"direct", "soft"})
        .lit_by("lighting");
    return network;
}

TEST(Show, KeepsPicturesOfOperatorsBesideTheSumAndLeavesItAsItIs) {
    auto plain = cached_furnace(), shown = cached_furnace();
    shown.show({"first", "map", "direct"});
    const auto without = plain.pictures(2);
    auto with = shown.pictures(2);
    EXPECT_THAT(without, testing::SizeIs(3));
    ASSERT_THAT(with, testing::SizeIs(5)) << "direct is a layer already";
    EXPECT_NEAR(mean(with.at("first")), mean(with.at("direct")) + mean(with.at("map")), 1e-5);
    with.erase("first");
    with.erase("map");
    EXPECT_TRUE(with == without) << "to the bit";
}

// Every way leaves one photon on the black walls of a room, which shine alike everywhere.
TEST(PhotonDensity, CountsPhotonsPerArea) {
    SmallNetwork network(furnace(0, 1), 24, 24);
    network.add("map", "PhotonMap", {}, {{"paths", word("all")}, {"photons", number(30000)}, {"aim", Value{false}}})
        .add("density", "PhotonDensity", {}, {{"of", node("map")}, {"gather", number(100)}})
        .lit_by("map")
        .show({"density"});
    const double exact = 30000.0 / 6;
    EXPECT_NEAR(mean(network.pictures(4).at("density")), exact, 0.03 * exact);
}

// Dots of area a around points of density n leave exp(-n a) of an area without one.
TEST(PhotonPositions, DrawsADotAroundEachPhoton) {
    SmallNetwork network(furnace(0, 1), 64, 64);
    network.add("map", "PhotonMap", {}, {{"paths", word("all")}, {"photons", number(30000)}, {"aim", Value{false}}})
        .add("dots", "PhotonPositions", {}, {{"of", node("map")}, {"size", number(0.006)}})
        .lit_by("map")
        .show({"dots"});
    const double covered = 1 - std::exp(-30000.0 / 6 * 3.14159265 * 0.006 * 0.006);
    EXPECT_NEAR(mean(network.pictures(4).at("dots")), covered, 0.03 * covered) << "white where it is covered";
}

TEST(RecordPositions, DrawsDotsWhereACacheHasItsRecords) {
    auto few = cached_furnace(), tiny = cached_furnace();
    few.add("records", "RecordPositions", {}, {{"of", node("soft")}, {"size", number(0.05)}}).show({"records"});
    tiny.add("records", "RecordPositions", {}, {{"of", node("soft")}, {"size", number(1e-9)}}).show({"records"});
    const double covered = mean(few.pictures(4).at("records"));
    EXPECT_GT(covered, 0.01);
    EXPECT_LT(covered, 0.5);
    EXPECT_LT(mean(tiny.pictures(4).at("records")), 0.5 * covered) << "only where it was asked about the record itself";
}

// A conversion gives the light of the map that it takes, so both together count it twice.
TEST(PhotonIrradiance, CountsThePathsOfItsMap) {
    const auto warnings = [](const char* also) {
        const Registry registry(standard_nodes());
        std::vector<Node> nodes{{"scene", "Scene", {word("none.pbrt")}, {}, {}},
                                {"map", "PhotonMap", {}, {{"paths", word("indirect")}}, {}},
                                {"quick", "PhotonIrradiance", {}, {{"of", node("map")}}, {}},
                                {"direct", "DirectLighting", {}, {}, {}},
                                {"lighting", "Combine", {node("quick"), node(also)}, {}, {}},
                                {"image",
                                 "RayTracer",
                                 {node("lighting")},
                                 {{"scene", node("scene")}, {"film", Value{Table{{number(8), number(8)}, {}}}}},
                                 {}}};
        const auto found = examine({"test.lua", nodes}, registry);
        EXPECT_TRUE(found.problems.empty());
        std::string said;
        for (const auto& problem : found.warnings) said += to_string(problem) + "\n";
        for (const auto& note : found.notes) said += to_string(note) + "\n";
        return said;
    };
    EXPECT_EQ(warnings("direct"), "");
    EXPECT_THAT(warnings("map"), testing::HasSubstr("is counted by"));
}

std::string mistakes(SmallNetwork& network) {
    try {
        network.picture(1);
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

TEST(Show, SaysWhatIsWrongWithTheNodesThatItIsGiven) {
    SmallNetwork unknown(furnace(0, 1), 4, 4);
    EXPECT_THAT(mistakes(unknown.add("direct", "DirectLighting").show({"dirct"})),
                testing::HasSubstr("RayTracer 'image': 'show': no node called 'dirct' (did you mean 'direct'?)"));
    SmallNetwork scene(furnace(0, 1), 4, 4);
    EXPECT_THAT(mistakes(scene.add("direct", "DirectLighting").show({"scene"})),
                testing::HasSubstr("'show' has 'scene', which gives no light"));
    SmallNetwork other(furnace(0, 1), 4, 4);
    EXPECT_THAT(
        mistakes(other.add("direct", "DirectLighting").add("dots", "PhotonPositions", {}, {{"of", node("direct")}})),
        testing::HasSubstr("PhotonPositions 'dots': 'of' must be a node that keeps photons (PhotonMap), but "
                           "'direct' is of kind DirectLighting"));
}

}  // namespace
}  // namespace lightnet::show_test
