// The choice among lightings follows from figures alone.
#include "tools/trials/lighting_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightnet::lighting_choice_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr AskedPicture asked{65536, 64};
constexpr double few = 100;  // triangles

// A sixty-fourth of the picture, with 8 samples: 512 times as much work is asked for.
LightingTrial path_trial() {
    return {.name = "path", .pixels = 1024, .samples = 8, .rendering = 0.02, .own_error = 0.08};
}

LightByKind parts(PathKind most, double part) {
    LightByKind all{};
    all[static_cast<std::size_t>(most)] = part;
    return all;
}
LightingTrial path_trial_of(PathKind most, double part = 1) {
    LightingTrial trial = path_trial();
    trial.parts = parts(most, part);
    return trial;
}

// Records leave 2e-4 where paths leave 1e-2.
TEST(LightingPromise, IsThatCachesCoverSoftLight) {
    const auto promise = promise_of(path_trial_of(PathKind::soft), asked, few);
    EXPECT_EQ(promise.covers, Covers::soft);
    EXPECT_NEAR(promise.times, 0.01 / 2e-4 / 0.35, 1e-9);
    EXPECT_EQ(promise.why, "paths LD+D make 100 % of the error");
}

TEST(LightingPromise, IsThatPhotonsCoverCausticsAndWhatRecordsOfPathsWouldBeNoisyBy) {
    EXPECT_EQ(promise_of(path_trial_of(PathKind::caustic), asked, few).covers, Covers::all);
    EXPECT_EQ(promise_of(path_trial_of(PathKind::mirrored), asked, few).covers, Covers::all);
    LightingTrial noisy = path_trial_of(PathKind::soft);
    noisy.own_error = 1;
    EXPECT_EQ(promise_of(noisy, asked, few).covers, Covers::all);
}

TEST(LightingPromise, IsLessClearInSmallPicturesOfDetailedScenes) {
    LightingTrial trial = path_trial_of(PathKind::caustic);
    trial.own_error = 0.008;
    EXPECT_TRUE(promise_of(trial, asked, few).is_clear);
    EXPECT_TRUE(promise_of(trial, asked, 1e6).is_clear);
    const AskedPicture small{4096, 64};
    EXPECT_TRUE(promise_of(trial, small, few).is_clear);
    EXPECT_FALSE(promise_of(trial, small, 1e6).is_clear);
    EXPECT_EQ(promise_of(trial, small, 1e6).covers, Covers::soft) << "maps take long, to be tried";
}

TEST(LightingPromise, IsNoneWhereDirectLightMakesTheNoise) {
    const auto promise = promise_of(path_trial_of(PathKind::direct), asked, few);
    EXPECT_EQ(promise.covers, Covers::nothing);
    EXPECT_LT(promise.times, least_promise);
}

TEST(LightingPromise, IsAGuideWhereSoftLightMakesSomeOfIt) {
    LightingTrial trial = path_trial_of(PathKind::direct, 0.75);
    trial.parts[static_cast<std::size_t>(PathKind::soft)] = 0.25;
    EXPECT_EQ(promise_of(trial, asked, few).covers, Covers::narrow);
    trial.own_error = 0.003;
    EXPECT_EQ(promise_of(trial, asked, few).covers, Covers::nothing) << "there is little to take away";
    trial.own_error = 0.6, trial.parts[static_cast<std::size_t>(PathKind::soft)] = 0.05;
    EXPECT_EQ(promise_of(trial, asked, few).covers, Covers::narrow) << "there is much";
}

TEST(LightingPromise, EndsWithManySamples) {
    const auto promise = promise_of(path_trial_of(PathKind::soft), {65536, 16384}, few);
    EXPECT_LT(promise.times, least_promise) << "records stay as they are";
    EXPECT_FALSE(promise.is_clear);
    EXPECT_TRUE(promise.else_learns) << "if they are not better than they are taken to be";
    EXPECT_EQ(promise_of(path_trial_of(PathKind::soft), {65536, 16384}, 1e6).covers, Covers::narrow)
        << "records of detailed scenes take long, to be tried";
    EXPECT_EQ(promise_of(path_trial(), asked, few).covers, Covers::nothing) << "nobody knows what makes the error";
}

// They take longer to prepare than records of paths, and leave less.
TEST(LightingPromise, IsThatMapsCoverSoftLightOfLongRuns) {
    LightingTrial noisy = path_trial_of(PathKind::soft);
    noisy.own_error = 0.4;
    EXPECT_EQ(promise_of(noisy, {65536, 64}, few).covers, Covers::soft);
    EXPECT_EQ(promise_of(noisy, {65536, 128}, few).covers, Covers::all);
}

// Records and maps are off by more than paths are then; progressive ones are not.
TEST(LightingPromise, IsThatPhotonsWithoutEndCoverCausticsOfManySamples) {
    const AskedPicture many{65536, 16384};
    EXPECT_EQ(promise_of(path_trial_of(PathKind::caustic), many, few).covers, Covers::caustics);
    EXPECT_EQ(promise_of(path_trial_of(PathKind::mirrored, 0.85), many, few).covers, Covers::caustics);
    EXPECT_NE(promise_of(path_trial_of(PathKind::caustic, 0.6), many, few).covers, Covers::caustics)
        << "the rest of the error gets worse";
    EXPECT_NE(promise_of(path_trial_of(PathKind::caustic), many, 1e6).covers, Covers::caustics);
    EXPECT_FALSE(promise_of(path_trial_of(PathKind::caustic), many, few).is_clear) << "it is tried";
}

TEST(LightingChoice, KnowsWhatFallsMoreSlowlyThanNoise) {
    LightingTrial photons = path_trial();
    photons.own_error = 0, photons.shared_error = 0.001, photons.shared_falls = 2.0 / 3;
    EXPECT_NEAR(forecast_of(photons, {65536, 64}).error, 0.001 / 4, 1e-12);
}

TEST(LightingChoice, TakesWhatWasForetold) {
    LightingTrial foretold{.name = "irradiance_cache", .foretold = "paths LD+D make 99 % of the error"};
    const std::vector trials{path_trial(), foretold};
    EXPECT_EQ(best_lighting(trials, asked), 1u);
    EXPECT_THAT(words_of_choice(trials, asked, 1),
                StartsWith("irradiance_cache (paths LD+D make 99 % of the error), "));
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
