// The choice among lightings follows from figures alone.
#include "tools/trials/lighting_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightnet::lighting_choice_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr AskedPicture asked{65536, 64};

// A sixty-fourth of the picture, with 8 samples: 512 times as much work is asked for.
LightingTrial path_trial() {
    return {.name = "path", .pixels = 1024, .samples = 8, .rendering = 0.02, .own_error = 0.08};
}

TEST(LightingChoice, TakesNoiseAndWorkToThePictureThatIsAskedFor) {
    const auto expected = forecast_of(path_trial(), asked);
    EXPECT_DOUBLE_EQ(expected.seconds, 0.02 * 512);
    EXPECT_DOUBLE_EQ(expected.error, 0.08 / 8);
}

TEST(LightingChoice, CountsPreparingOnceAndWhatNeighboursShareInFull) {
    LightingTrial cache = path_trial();
    cache.preparing = 3, cache.shared_error = 0.003;
    const auto expected = forecast_of(cache, asked);
    EXPECT_DOUBLE_EQ(expected.seconds, 3 + 0.02 * 512);
    EXPECT_DOUBLE_EQ(expected.error, 0.01 + 0.003);
    EXPECT_DOUBLE_EQ(forecast_of(cache, {65536, 6400}).error, 0.0001 + 0.003) << "no number of samples takes it away";
}

TEST(LightingChoice, LetsPhotonsOfEachSampleGetSharpSlowly) {
    LightingTrial photons = path_trial();
    photons.preparing = 0.1, photons.preparing_grows = 64, photons.falls = 1.0 / 16, photons.shared_error = 0.04;
    photons.progressive = true;
    const auto expected = forecast_of(photons, asked);
    EXPECT_DOUBLE_EQ(expected.seconds, 6.4 + 0.02 * 512);
    EXPECT_NEAR(expected.error, (0.08 + 0.04) / 16 / 4, 1e-12) << "8 times the samples, a quarter of the error";
}

TEST(LightingChoice, TakesTheLeastErrorTimesTime) {
    LightingTrial quick = path_trial(), exact = path_trial();
    quick.name = "quick", quick.rendering = 0.01;
    exact.name = "exact", exact.rendering = 0.04, exact.own_error = 0.01;
    EXPECT_EQ(best_lighting({path_trial(), quick, exact}, asked), 2u);
    EXPECT_EQ(best_lighting({path_trial(), quick}, asked), 1u);
}

TEST(LightingChoice, StaysWithTheFirstWhereNobodyIsClearlyBetter) {
    LightingTrial other = path_trial();
    other.rendering *= 0.95;
    EXPECT_EQ(best_lighting({path_trial(), other}, asked), 0u);
    other.rendering *= 0.9;
    EXPECT_EQ(best_lighting({path_trial(), other}, asked), 1u);
}

TEST(LightingChoice, HangsOnWhatIsAskedFor) {
    LightingTrial cache = path_trial();
    cache.name = "cache", cache.preparing = 5, cache.own_error = 0.02, cache.shared_error = 0.002;
    EXPECT_EQ(best_lighting({path_trial(), cache}, {65536, 64}), 1u);
    EXPECT_EQ(best_lighting({path_trial(), cache}, {65536, 4}), 0u) << "too little for so long a preparing";
    EXPECT_EQ(best_lighting({path_trial(), cache}, {65536, 4096}), 0u) << "its records stay as they are";
}

TEST(LightingChoice, NeverTakesWhatFailed) {
    LightingTrial failed{.name = "guided", .failed = "more than 0.2 s for a trial"};
    const std::vector trials{path_trial(), failed};
    EXPECT_EQ(best_lighting(trials, asked), 0u);
    EXPECT_THAT(words_of_choice(trials, asked, 0), HasSubstr("guided (more than 0.2 s for a trial)"));
}

// One that the hosts exclude judges the others all the same.
TEST(LightingChoice, DoesWithoutTheFirst) {
    LightingTrial first = path_trial(), worse = path_trial();
    first.failed = "no node called 'caustics'";
    worse.own_error *= 4;
    EXPECT_EQ(best_lighting({first, worse}, asked), 1u);
    worse.failed = first.failed;
    EXPECT_EQ(best_lighting({first, worse}, asked), 0u);
}

TEST(LightingChoice, HasTheSameWordsForTheSameFigures) {
    LightingTrial better = path_trial();
    better.name = "progressive", better.own_error = 0.004;
    const std::vector trials{path_trial(), better};
    const auto words = words_of_choice(trials, asked, best_lighting(trials, asked));
    EXPECT_EQ(words, "progressive (10.2 s x 0.0005 = 0.00512), path (10.2 s x 0.01 = 0.102)");
}

}  // namespace
}  // namespace lightnet::lighting_choice_test
