// Errors of trials: of pictures whose noise and bias are known.
#include "tools/trials/trial_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

namespace lightnet::trial_errors_test {
namespace {

constexpr std::uint32_t side = 96;
constexpr float light = 0.5f;
constexpr double weight = 1 / (double{light} * light + 0.01);  // of squared differences

/// How pictures of an even grey are off: deviations, and what is added.
struct Off {
    double own = 0, shared = 0, bias = 0;
};

// Noise of pixels, and of squares of 8 pixels that have all the same.
PicturePair pair_of(const Off& off, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    PicturePair pair;
    for (Picture& picture : pair) {
        picture.width = picture.height = side;
        std::vector<double> squares(side * side / 64);
        for (double& one : squares) one = off.shared * normal(random);
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const double noise = off.own * normal(random) + squares[i / side / 8 * (side / 8) + i % side / 8];
            const auto value = static_cast<float>(light + off.bias + noise);
            picture.beauty.push_back({value, value, value});
        }
    }
    return pair;
}

Picture one_of(const Off& off, unsigned seed) { return pair_of(off, seed)[0]; }

TEST(TrialErrors, FindNoiseOfPixels) {
    const auto found = errors_of(pair_of({.own = 0.1}, 1), {one_of({.own = 0.05}, 2)});
    EXPECT_NEAR(found.at(0).own, 0.01 * weight, 0.05 * 0.01 * weight);
    EXPECT_NEAR(found.at(1).own, 0.0025 * weight, 0.15 * 0.0025 * weight);
    EXPECT_LT(found[1].shared, 0.05 * found[1].own) << "there is none";
}

TEST(TrialErrors, TellWhatNeighboursShareFromWhatTheyDoNot) {
    const auto found = errors_of(pair_of({.own = 0.02}, 3), {one_of({.own = 0.02, .shared = 0.03}, 4)});
    EXPECT_NEAR(found.at(1).shared, 0.0009 * weight, 0.3 * 0.0009 * weight) << "of 144 squares";
    EXPECT_NEAR(found[1].own, 0.0004 * weight, 0.2 * 0.0004 * weight);
}

TEST(TrialErrors, FindBiasThatNoiseDoesNotShow) {
    const auto found = errors_of(pair_of({.own = 0.1}, 5), {one_of({.own = 0.02, .bias = 0.05}, 6)});
    EXPECT_NEAR(found.at(1).shared, 0.0025 * weight, 0.15 * 0.0025 * weight);
    EXPECT_LT(found[1].own, 0.1 * found[0].own);
}

// What is known of the truth has noise of its own: nobody is said to have none.
TEST(TrialErrors, TellOfNoneThatItIsPerfect) {
    const auto found = errors_of(pair_of({.own = 0.1}, 10), {one_of({}, 11)});
    EXPECT_GE(found.at(1).own, 0.019 * found[0].own);
    EXPECT_LT(found[1].own + found[1].shared, 0.06 * found[0].own);
}

TEST(TrialErrors, CountFirefliesAgainstWhoHasThem) {
    const auto with_firefly = [](Picture picture) {
        picture.beauty[side * 40 + 30] = {100, 100, 100};
        return picture;
    };
    const auto quiet = pair_of({.own = 0.1}, 7);
    auto loud = quiet;
    loud[0] = with_firefly(loud[0]);
    const auto single = one_of({.own = 0.1}, 8);
    const auto found = errors_of(loud, {single});
    EXPECT_GT(found.at(0).own, 2 * 0.01 * weight);
    EXPECT_NEAR(found.at(1).own, 0.01 * weight, 0.1 * 0.01 * weight) << "it has none";
    EXPECT_LT(found[1].shared, 0.001) << "one pixel of one picture is no bias of another";
    EXPECT_GT(errors_of(quiet, {with_firefly(single)}).at(1).own, 2 * 0.01 * weight);
}

// Noise of light that is four times as bright counts a sixteenth.
TEST(TrialErrors, AreRelativeToTheLight) {
    auto bright = pair_of({.own = 0.1}, 9);
    for (auto& picture : bright)
        for (Rgb& pixel : picture.beauty) pixel += Rgb{1.5f, 1.5f, 1.5f};
    EXPECT_NEAR(errors_of(bright, {}).at(0).own, 0.01 / 4.01, 0.05 * 0.01 / 4.01);
}

}  // namespace
}  // namespace lightnet::trial_errors_test
