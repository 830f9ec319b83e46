// Tests of the search for numbers that are none.
#include "core/base/odd_numbers.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace lightnet::odd_numbers_test {
namespace {

using Limits = std::numeric_limits<float>;

TEST(OddNumbers, AreCountedAmongAnswers) {
    std::vector<Rgb> answers(40, Rgb{1, -2, Limits::denorm_min()});
    answers.push_back({Limits::max(), Limits::lowest(), -0.0f});
    EXPECT_EQ(not_finite_among(answers), 0u);
    answers[3].r = Limits::infinity(), answers[5].g = -Limits::infinity();
    answers[17] = {Limits::quiet_NaN(), Limits::infinity(), -Limits::quiet_NaN()};
    answers.back().b = -Limits::quiet_NaN();
    EXPECT_EQ(not_finite_among(answers), 4u);
    EXPECT_EQ(not_finite_among({}), 0u);
}

TEST(OddNumbers, AreSeenInEachPlaceOfAQuestion) {
    std::vector<Query> questions(9);
    EXPECT_TRUE(are_plain(questions));
    EXPECT_TRUE(are_plain({}));
    for (float* number : {&questions[8].outgoing.x, &questions[4].outgoing.y, &questions[0].outgoing.z, &questions[7].u,
                          &questions[1].v})
        for (const float odd : {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), -Limits::quiet_NaN()}) {
            const float before = *number;
            *number = odd;
            EXPECT_FALSE(are_plain(questions));
            *number = before;
        }
    EXPECT_TRUE(are_plain(questions));
}

}  // namespace
}  // namespace lightnet::odd_numbers_test
