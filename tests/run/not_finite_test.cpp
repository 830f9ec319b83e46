// What is infinite, or no number, is counted where it was made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "core/run/assembly/direct_port.hpp"
#include "core/run/message/counters.hpp"

namespace lightnet::not_finite_test {
namespace {

// Answers the first of the questions of a call badly.
class Broken final : public LightOp {
public:
    void light(std::span<const Query>, std::span<Rgb> answers) const override {
        std::fill(answers.begin(), answers.end(), Rgb{1, 1, 1});
        answers.front().g = std::numeric_limits<float>::quiet_NaN();
    }
};

TEST(NotFinite, IsCountedPerAnswer) {
    const Broken broken;
    const std::string name = "broken";
    std::uint64_t count = 0;
    std::vector<Rgb> answers(5);
    answer(Callee{broken, name, 1, false, &count}, 1, std::vector<Query>(5), answers);
    EXPECT_EQ(count, 1u);
}

TEST(NotFinite, IsAddedUpOverPlacesByNode) {
    Counters one, other;
    one.rays = 3;
    one.not_finite = {{"bounce", 2}, {"direct", 1}};
    other.not_finite = {{"bounce", 5}};
    one += other;
    EXPECT_THAT(one.not_finite, testing::ElementsAre(testing::Pair("bounce", 7), testing::Pair("direct", 1)));
    EXPECT_EQ(Counters::from(one.named()), one) << "as it travels";
}

}  // namespace
}  // namespace lightnet::not_finite_test
