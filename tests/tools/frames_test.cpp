// Frames as command lines name them.
#include "tools/cli/frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightnet::frames_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<int> numbers(const std::string& text) { return std::get<std::vector<int>>(frames_of(text)); }
std::string mistake(const std::string& text) {
    const auto found = frames_of(text);
    const auto* what = std::get_if<std::string>(&found);
    return what ? *what : "";
}

TEST(Frames, AreNumbersRangesAndSteps) {
    EXPECT_THAT(numbers("17"), ElementsAre(17));
    EXPECT_THAT(numbers("1-4"), ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(numbers("1-8x3"), ElementsAre(1, 4, 7));
    EXPECT_THAT(numbers("9,1,3-5"), ElementsAre(9, 1, 3, 4, 5));
    EXPECT_THAT(numbers("1-3,2-4"), ElementsAre(1, 2, 3, 4)) << "each once";
    EXPECT_THAT(numbers("0"), ElementsAre(0));
}

TEST(Frames, SayWhatIsMeantWhereTheyAreWrittenOtherwise) {
    EXPECT_THAT(mistake("1..240"), HasSubstr("did you mean '1-240'?"));
    EXPECT_THAT(mistake("1:240"), HasSubstr("did you mean '1-240'?"));
    EXPECT_THAT(mistake("1:240:2"), HasSubstr("did you mean '1-240x2'?"));
    EXPECT_THAT(mistake("1, 5"), HasSubstr("did you mean '1,5'?"));
    EXPECT_THAT(mistake("all"), HasSubstr("frames are like 1-240, 1-240x2 or 1,5,9-12, not 'all'"));
    EXPECT_THAT(mistake("9-1"), HasSubstr("frames go upwards: 1-9"));
    EXPECT_THAT(mistake("1-9x0"), HasSubstr("every 0th frame"));
    EXPECT_THAT(mistake("1-99999"), HasSubstr("at most 10000 frames at once"));
    for (const char* text : {"", ",", "1-", "1,", "-5", "1-2-3x", "99999999999", "1x2"})
        EXPECT_NE(mistake(text), "") << text;
}

}  // namespace
}  // namespace lightnet::frames_test
