// Bytes that come in pieces, in whatever order and however often.
#include "transport/store/arriving_bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace lightnet::arriving_bytes_test {
namespace {

class ArrivingBytesTest : public ::testing::Test {
protected:
    Arrival take(std::uint64_t offset, std::uint64_t size) {
        return result.take(offset, std::span(sent).subspan(offset, size));
    }
    void expect_whole() { EXPECT_EQ(*result.bytes(), whole); }

    std::vector<std::byte> whole = [] {
        std::vector<std::byte> bytes(1000);
        for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 2654435761u >> 13);
        return bytes;
    }();
    std::vector<std::byte> sent = whole;
    ArrivingResult result{content_hash(whole), whole.size()};
};

TEST_F(ArrivingBytesTest, AreWholeWithTheLastPiece) {
    EXPECT_EQ(take(0, 400), Arrival::under_way);
    EXPECT_EQ(take(400, 599), Arrival::under_way);
    EXPECT_EQ(result.here(), 999u);
    EXPECT_EQ(take(999, 1), Arrival::whole);
    expect_whole();
}

TEST_F(ArrivingBytesTest, WaitForAPieceThatIsLost) {
    take(0, 100);
    EXPECT_EQ(take(200, 800), Arrival::under_way);
    EXPECT_EQ(result.here(), 100u);
    take(100, 100);
    EXPECT_EQ(take(200, 800), Arrival::whole);
    expect_whole();
}

TEST_F(ArrivingBytesTest, TakeNothingOfWhatIsThere) {
    take(0, 100), take(100, 100);
    for (const std::uint64_t offset : {0, 100, 50}) EXPECT_EQ(take(offset, 100), Arrival::under_way);
    EXPECT_EQ(result.here(), 200u);
    EXPECT_EQ(take(200, 800), Arrival::whole);
    expect_whole();
}

// As when a line was cut, and pieces are of another size now.
TEST_F(ArrivingBytesTest, GoOnWhenTheyBeginAnewCutInOtherPlaces) {
    take(0, 300), take(300, 300);
    for (std::uint64_t at = 0; at < 1000; at += 250)
        EXPECT_EQ(take(at, 250), at < 750 ? Arrival::under_way : Arrival::whole);
    expect_whole();
}

TEST_F(ArrivingBytesTest, AreDamagedWhenOneBitIsAnother) {
    sent[500] ^= std::byte{4};
    EXPECT_EQ(take(0, 600), Arrival::under_way);
    EXPECT_EQ(take(600, 400), Arrival::damaged);
    sent = whole;
    EXPECT_EQ(take(0, 1000), Arrival::damaged) << "for good";
}

TEST_F(ArrivingBytesTest, AreTooLongWhenAPieceEndsBehindTheirEnd) {
    sent.push_back(std::byte{1});
    take(0, 500);
    EXPECT_EQ(take(500, 501), Arrival::too_long);
    EXPECT_EQ(result.here(), 500u);
    ArrivingResult other{content_hash(whole), 10};
    EXPECT_EQ(other.take(std::uint64_t(-1), whole), Arrival::under_way) << "far ahead of what is awaited";
    EXPECT_EQ(other.take(0, whole), Arrival::too_long);
    EXPECT_EQ(other.take(0, {}), Arrival::too_long) << "for good";
}

TEST_F(ArrivingBytesTest, AreWholeAtOnceWhenThereAreNone) {
    ArrivingResult nothing{content_hash(std::string_view()), 0};
    EXPECT_EQ(nothing.take(0, {}), Arrival::whole);
    EXPECT_TRUE(nothing.bytes()->empty());
}

TEST_F(ArrivingBytesTest, TakeNoMoreRoomThanTheyAreWorth) {
    ArrivingResult claimed{content_hash(whole), std::uint64_t{1} << 60};
    EXPECT_EQ(claimed.take(0, whole), Arrival::under_way) << "a size that nobody has room for is only said";
}

// Pieces that are cut, lost, doubled and out of order as it happens, sent again until all is there.
TEST_F(ArrivingBytesTest, AreWholeWhateverHappensOnTheWay) {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        ArrivingResult arriving(content_hash(whole), whole.size());
        auto arrival = Arrival::under_way;
        for (int pieces = 0; arrival == Arrival::under_way && pieces < 100000; ++pieces) {
            const auto at = random() % 1000, size = 1 + random() % std::min<std::uint64_t>(200, 1000 - at);
            const auto before = arriving.here();
            arrival = arriving.take(at, std::span(whole).subspan(at, size));
            ASSERT_GE(arriving.here(), before);
        }
        ASSERT_EQ(arrival, Arrival::whole);
        ASSERT_EQ(*arriving.bytes(), whole);
    }
}

}  // namespace
}  // namespace lightnet::arriving_bytes_test
