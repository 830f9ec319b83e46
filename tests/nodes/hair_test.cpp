// Operators of light among hair.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "tests/support/rig.hpp"
#include "tests/support/small_network.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::hair_nodes_test {
namespace {

using namespace test;

/// Straight hairs of random lengths on a ball.
Curves fur(std::uint32_t count) {
    Curves curves;
    for (std::uint32_t strand = 0; strand < count; ++strand) {
        Samples samples(8, strand);
        const Vec3 root = sphere(samples.next_2d()), aside = sphere(samples.next_2d()) * 0.3f;
        curves.strands.push_back(strand);
        curves.segments.push_back(4 * strand);
        for (const float along : {0.0f, 0.33f, 0.66f, 1.0f}) {
            const Vec3 at = root * (0.5f + 0.5f * along) + aside * (along * along);
            curves.points.push_back({at.x, at.y, at.z, 0.03f * (1 - 0.5f * along)});
        }
    }
    return curves;
}

/// Fur of that absorption.
SceneData furball(float absorption) {
    SceneData data;
    const auto number = [&](float value) { return colour(data, {value, value, value}); };
    HairMaterial hair;
    hair.colour = number(absorption);
    hair.along = hair.around = number(0.3f);
    hair.eta = number(1.55f), hair.tilt = number(2);
    add(data, fur(300), material(data, hair));
    data.film.width = data.film.height = 24;
    data.camera = camera({0, 0, 4}, {0, 0, 0}, 25);
    data.camera_given = true;
    return data;
}

SceneData furball_under(float absorption, Rgb sky) {
    SceneData data = furball(absorption);
    data.environments.push_back({sky});
    return data;
}

// What loses no light is as bright as the sky around it. The bound is four standard deviations of the mean.
TEST(WhiteHair, CanNotBeSeenBeforeAWhiteSky) {
    const Scene scene(furball_under(0, {1, 1, 1}));
    Rig rig(scene);
    const Rig::Params deep{{"max_depth", Value{250.0}}};
    const auto [mean, error] = measure(*rig.path_tracer({}, deep), 24, 32);
    EXPECT_NEAR(mean, 1, 4 * error + 1e-3);
    EXPECT_LT(error, 0.01);
    rig.add("PathTracing", "all", {}, {{"paths", Value{std::string("all")}}, {"max_depth", Value{250.0}}});
    const auto whole = measure(*rig.renderer("all"), 24, 32);
    EXPECT_NEAR(whole.mean, 1, 4 * whole.error + 1e-3) << "all paths at once";
}

TEST(DarkHair, IsDarkerTheMoreItAbsorbs) {
    double before = 1;
    for (const float absorption : {0.05f, 0.5f, 5.0f}) {
        const Scene scene(furball_under(absorption, {1, 1, 1}));
        Rig rig(scene);
        const auto [mean, error] = measure(*rig.path_tracer(), 24, 16);
        EXPECT_LT(mean + 4 * error, before);
        before = mean;
    }
}

/// Under a wide lamp, over a floor.
SceneData lit_furball() {
    SceneData data = furball(0.2f);
    add(data, quad({-4, -1.2f, -4}, {0, 0, 8}, {8, 0, 0}), diffuse(data, 0.5f));
    add(data, quad({-3, 2.5f, -2}, {6, 0, 0}, {0, 0, 6}), diffuse(data, 0)).emission = AreaEmission{{1, 1, 1}, true};
    return data;
}

// Sampled lamps, sampled directions, and both together find as much light, pixel by pixel.
TEST(HairUnderALamp, IsAsBrightHoweverTheLampIsFound) {
    constexpr std::uint32_t size = 24, samples = 256;
    const Scene scene(lit_furball());
    std::vector<std::vector<Rgb>> found;
    for (const char* heuristic : {"power", "lamps", "directions"}) {
        Rig rig(scene);
        rig.add("DirectLighting", "direct", {}, {{"heuristic", Value{std::string(heuristic)}}});
        found.push_back(picture(*rig.renderer("direct"), size, size, samples));
    }
    for (const auto& other : {found[1], found[2]}) {
        double all = 0, sum = 0, squares = 0;
        for (std::size_t i = 0; i < other.size(); ++i) {
            const double difference = double{other[i].g} - double{found[0][i].g};
            all += double{found[0][i].g}, sum += difference, squares += difference * difference;
        }
        EXPECT_LT(std::fabs(sum), 4 * std::sqrt(squares));
        EXPECT_LT(4 * std::sqrt(squares), 0.15 * all) << "the bound says too little";
    }
}

// What is reflected, goes through and is reflected inside are all of hair's light, and the others of each all but it.
TEST(WaysThroughHair, AreLayersThatAddUp) {
    constexpr std::uint32_t size = 24, samples = 64;
    const Scene scene(lit_furball());
    for (const char* light : {"DirectLighting", "PathTracing"}) {
        const auto sum_of = [&](const char* way, bool except) {
            Rig rig(scene);
            rig.add(light, "light");
            rig.add("Select", "some", {"light"}, {{"hair", Value{std::string(way)}}, {"except", Value{except}}});
            double sum = 0;
            for (const Rgb& pixel : picture(*rig.renderer("some"), size, size, samples)) sum += double{pixel.g};
            return sum;
        };
        const double r = sum_of("R", false), tt = sum_of("TT", false), trt = sum_of("TRT", false);
        const double all = r + sum_of("R", true);
        for (const double one : {r, tt, trt}) {
            EXPECT_GT(one, 0.01 * all) << light;
            EXPECT_LT(one, 0.9 * all) << light;
        }
        EXPECT_NEAR(tt + sum_of("TT", true), all, 0.03 * all) << light;
        EXPECT_NEAR(trt + sum_of("TRT", true), all, 0.03 * all) << light;
        Rig whole(scene);
        whole.add(light, "light");
        double sum = 0;
        for (const Rgb& pixel : picture(*whole.renderer("light"), size, size, samples)) sum += double{pixel.g};
        EXPECT_NEAR(all, sum, 0.03 * sum) << light;
    }
}

// Nothing divides by what hair has not.
TEST(HairUnderALamp, IsFiniteByEveryOperator) {
    const auto check = [](const char* what, SmallNetwork network) {
        double sum = 0;
        for (const Rgb& pixel : network.picture(8)) {
            ASSERT_TRUE(finite(pixel)) << what;
            ASSERT_GE(pixel.r, 0) << what;
            sum += double{pixel.g};
        }
        EXPECT_GT(sum, 0) << what;
    };
    const auto network = [] { return SmallNetwork(lit_furball(), 24, 24); };
    const Value few{20000.0}, all{std::string("all")};
    check("PhotonMap", network().add("map", "PhotonMap", {}, {{"paths", all}, {"photons", few}}));
    check("IrradianceCache", network()
                                 .add("direct", "DirectLighting")
                                 .add("soft", "IrradianceCache", {"direct"}, {{"rays", Value{32.0}}})
                                 .add("lighting", "Combine", {"direct", "soft"}));
    check("AmbientOcclusion", network().add("ambient", "AmbientOcclusion"));
    check("FinalGather", network()
                             .add("map", "PhotonMap", {}, {{"paths", all}, {"photons", few}})
                             .add("gather", "FinalGather", {"map"}));
    check("PathTracing", network().add("all", "PathTracing", {}, {{"paths", all}}));
}

}  // namespace
}  // namespace lightnet::hair_nodes_test
