// Tests of tiles that are rendered in pieces.
#include "core/run/master/cut_tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace lightnet::cut_tiles_test {

// Two colours a pixel, which tell where it lies.
std::vector<Rgb> pixels_of(const Tile& tile) {
    std::vector<Rgb> pixels;
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; y += tile.step())
        for (std::uint32_t x = tile.x; x < tile.x + tile.width; x += tile.step())
            for (const float colour : {0.0f, 1.0f}) pixels.push_back({float(x), float(y), colour});
    return pixels;
}

TEST(CutTiles, PutPixelsWhereTheyBelongInWhateverOrderPiecesCome) {
    for (const Tile tile : {Tile{32, 64, 32, 32, 16, 16}, Tile{5, 7, 37, 19, 0, 16}, Tile{0, 0, 64, 8, 0, 3},
                            Tile{3, 5, 54, 51, 0, 1, 2, 1}}) {
        CutTiles cut;
        auto pieces = cut.cut(tile, 64);
        ASSERT_GT(pieces.size(), 1u);
        std::ranges::reverse(pieces);
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            EXPECT_TRUE(cut.is_piece(pieces[i]));
            EXPECT_EQ(pieces[i].first_sample, tile.first_sample);
            EXPECT_EQ(pieces[i].samples, tile.samples);
            const auto whole = cut.put(pieces[i], pixels_of(pieces[i]));
            ASSERT_EQ(whole.has_value(), i + 1 == pieces.size());
            if (!whole) continue;
            EXPECT_EQ(whole->tile, tile);
            EXPECT_EQ(whole->pixels, pixels_of(tile));
        }
        EXPECT_FALSE(cut.is_piece(tile)) << "all is forgotten";
    }
}

TEST(CutTiles, CutNothingThatIsSmallEnough) {
    CutTiles cut;
    const Tile tile{0, 0, 32, 32, 0, 16};
    EXPECT_EQ(cut.cut(tile, 1024), std::vector{tile});
    EXPECT_FALSE(cut.is_piece(tile));
    const Tile narrow{0, 0, 15, 15, 0, 16};
    EXPECT_EQ(cut.cut(narrow, 1), std::vector{narrow}) << "no side is below 8 pixels";
}

TEST(CutTiles, KnowPiecesOfSeveralTilesAndPassesApart) {
    CutTiles cut;
    const Tile first{0, 0, 16, 16, 0, 16}, later{0, 0, 16, 16, 16, 16};
    const auto some = cut.cut(first, 128), others = cut.cut(later, 128);
    ASSERT_EQ(some.size(), 2u);
    EXPECT_FALSE(cut.put(some[0], pixels_of(some[0])));
    EXPECT_FALSE(cut.put(others[1], pixels_of(others[1])));
    EXPECT_EQ(cut.put(others[0], pixels_of(others[0]))->tile, later);
    EXPECT_EQ(cut.put(some[1], pixels_of(some[1]))->tile, first);
}

}  // namespace lightnet::cut_tiles_test
