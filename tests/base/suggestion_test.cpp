#include "core/base/suggestion.hpp"

#include <gtest/gtest.h>

namespace lightnet::suggestion_test {
namespace {

const std::vector<std::string> names{"photons", "gather", "paths", "rays"};

TEST(DidYouMean, FindsAForgottenLetter) { EXPECT_EQ(did_you_mean("photns", names), " (did you mean 'photons'?)"); }
TEST(DidYouMean, FindsSwappedLetters) { EXPECT_EQ(did_you_mean("gahter", names), " (did you mean 'gather'?)"); }
TEST(DidYouMean, DoesNotMindCapitals) { EXPECT_EQ(did_you_mean("Rays", names), " (did you mean 'rays'?)"); }
TEST(DidYouMean, KeepsSilentAboutStrangers) { EXPECT_EQ(did_you_mean("irradiance", names), ""); }
TEST(DidYouMean, KeepsSilentWithoutAnyWord) { EXPECT_EQ(did_you_mean("", names), ""); }
TEST(DidYouMean, KeepsSilentWithoutAnyNames) { EXPECT_EQ(did_you_mean("rays", {}), ""); }
TEST(DidYouMean, DoesNotTradeAllOfAShortName) { EXPECT_EQ(did_you_mean("x", {"y"}), ""); }
TEST(DidYouMean, TakesTheEarlierOfTwoAsClose) {
    EXPECT_EQ(did_you_mean("bat", {"cat", "hat"}), " (did you mean 'cat'?)");
}
TEST(DidYouMean, TakesTheCloserOne) { EXPECT_EQ(did_you_mean("path", {"bathe", "paths"}), " (did you mean 'paths'?)"); }

TEST(DidYouMean, SpendsNoTimeOnHugeWords) {
    const std::string huge(10'000'000, 'a');
    EXPECT_EQ(did_you_mean(huge, names), "");
    EXPECT_EQ(did_you_mean("rays", {huge}), "");
}

}  // namespace
}  // namespace lightnet::suggestion_test
