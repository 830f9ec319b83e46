// What those who watch get of a picture.
#include "tools/preview/watch_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace lightnet::watch_board_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t colours = 2;
constexpr std::size_t all = 1 << 20;

std::vector<Rgb> grey(const Tile& tile, float value) { return {tile.pixels() * colours, Rgb{value, value, value}}; }

// A page's copy of the picture.
struct Copy {
    std::vector<Rgb> pixels = std::vector<Rgb>(100 * 70 * colours);
    std::size_t rectangles = 0;

    void take(const std::string& frame) {
        if (frame.empty()) return;
        std::uint32_t count = 0;
        std::memcpy(&count, frame.data(), 4);
        std::size_t at = 4;
        for (; count > 0; --count, ++rectangles) {
            std::uint16_t area[4];
            std::memcpy(area, frame.data() + at, sizeof area);
            at += sizeof area;
            for (std::size_t y = area[1]; y < std::size_t{area[1]} + area[3]; ++y) {
                const std::size_t row = area[2] * colours * sizeof(Rgb);
                std::memcpy(static_cast<void*>(&pixels.at((y * 100 + area[0]) * colours)), frame.data() + at, row);
                at += row;
            }
        }
        EXPECT_EQ(at, frame.size());
    }
};

TEST(WatchBoard, GivesWhoComesLateAllThatIsThere) {
    WatchBoard board({0, 0, 100, 70}, colours);
    const Tile left{0, 0, 50, 70}, right{50, 0, 50, 70};
    EXPECT_TRUE(board.show(left, grey(left, 1)));
    EXPECT_TRUE(board.show(right, grey(right, 2)));
    WatchBoard::Seen seen;
    Copy copy;
    copy.take(board.pixels_since(seen, all));
    EXPECT_EQ(copy.pixels[49 * colours].r, 1);
    EXPECT_EQ(copy.pixels[50 * colours].r, 2);
    EXPECT_EQ(copy.pixels.back().b, 2);
    EXPECT_THAT(board.pixels_since(seen, all), IsEmpty());
}

TEST(WatchBoard, GivesOnlyWhatHasChanged) {
    WatchBoard board({0, 0, 100, 70}, colours);
    const Tile whole{0, 0, 100, 70}, corner{96, 64, 4, 6};
    board.show(whole, grey(whole, 1));
    WatchBoard::Seen seen;
    board.pixels_since(seen, all);
    board.show(corner, grey(corner, 3));
    Copy copy;
    copy.take(board.pixels_since(seen, all));
    EXPECT_EQ(copy.rectangles, 1u);
    EXPECT_EQ(copy.pixels.back().r, 3);
}

TEST(WatchBoard, GivesALittleAtATimeAndAllInTheEndHoweverMuchChanges) {
    WatchBoard board({0, 0, 100, 70}, colours);
    const Tile whole{0, 0, 100, 70}, first{0, 0, 32, 32};
    board.show(whole, grey(whole, 1));
    WatchBoard::Seen seen;
    Copy copy;
    for (int i = 0; i < 40; ++i) {
        copy.take(board.pixels_since(seen, 1));
        if (i < 20) board.show(first, grey(first, static_cast<float>(i)));
    }
    EXPECT_EQ(copy.pixels.front().r, 19);
    EXPECT_EQ(copy.pixels.back().r, 1);
    EXPECT_THAT(board.pixels_since(seen, all), IsEmpty());
}

TEST(WatchBoard, LeavesOutWhatLiesOutsideItsWindow) {
    WatchBoard board({40, 30, 100, 70}, colours);
    const Tile tile{0, 0, 41, 31};
    EXPECT_TRUE(board.show(tile, grey(tile, 5)));
    WatchBoard::Seen seen;
    Copy copy;
    copy.take(board.pixels_since(seen, all));
    EXPECT_EQ(copy.pixels[0].r, 5);
    EXPECT_EQ(copy.pixels[colours].r, 0);
    EXPECT_EQ(copy.pixels[100 * colours].r, 0);
}

TEST(WatchBoard, KeepsTheLastLinesAndTheNewestState) {
    WatchBoard board({0, 0, 8, 8}, 1);
    board.say("one");
    WatchBoard::Seen seen;
    EXPECT_THAT(board.lines_since(seen), ElementsAre("one"));
    board.say("two");
    board.tell("a");
    board.tell("b");
    EXPECT_THAT(board.lines_since(seen), ElementsAre("two"));
    EXPECT_EQ(board.state_since(seen), "b");
    EXPECT_EQ(board.state_since(seen), "");
    for (std::size_t i = 0; i < 2 * WatchBoard::most_lines; ++i) board.say(std::to_string(i));
    const auto lines = board.lines_since(seen);
    EXPECT_LE(lines.size(), WatchBoard::most_lines);
    EXPECT_EQ(lines.back(), std::to_string(2 * WatchBoard::most_lines - 1));
}

}  // namespace
}  // namespace lightnet::watch_board_test
