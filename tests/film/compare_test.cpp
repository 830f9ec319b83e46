// The numbers that compare() gives, against ones worked out by hand.
#include "core/film/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.hpp"
#include "tests/film/pictures.hpp"

namespace lightnet::compare_test {
namespace {

Picture flat(float value, std::uint32_t size = 32) {
    return {size, size, std::vector<Rgb>(std::size_t{size} * size, Rgb{value, value, value}), {}};
}

TEST(Compare, FindsNoDifferenceInTheSamePicture) {
    const Picture picture = noisy_picture(32, 32);
    const Difference same = compare(picture, picture);
    EXPECT_TRUE(same.identical);
    EXPECT_EQ(same.mean_ratio, (Rgb{1, 1, 1}));
    EXPECT_EQ(same.relative_square, 0);
    EXPECT_EQ(same.block_difference, 0);
}

TEST(Compare, SeesOneBit) {
    Picture picture = noisy_picture(32, 32);
    const Picture before = picture;
    picture.beauty[77].g = std::nextafter(picture.beauty[77].g, 0.0f);
    EXPECT_FALSE(compare(before, picture).identical);
}

TEST(Compare, MeasuresAUniformDifference) {
    const Difference found = compare(flat(2), flat(3));
    EXPECT_FLOAT_EQ(found.mean_ratio.r, 1.5f);
    EXPECT_NEAR(found.mean_square, 1, 1e-12);
    EXPECT_NEAR(found.relative_square, 1 / 4.01, 1e-12);
    EXPECT_NEAR(found.relative_square_trimmed, 1 / 4.01, 1e-12);
    EXPECT_NEAR(found.block_difference, 1 / 2.001, 1e-6);
}

TEST(Compare, TrimsTheWorstPixelOfAThousand) {
    Picture picture = flat(2);
    picture.beauty[5] = {100, 100, 100};
    const Difference found = compare(flat(2), picture);
    EXPECT_GT(found.relative_square, 1);
    EXPECT_EQ(found.relative_square_trimmed, 0);
}

TEST(Compare, RefusesPicturesOfDifferentSizes) { EXPECT_THROW(compare(flat(1, 32), flat(1, 16)), Error); }

}  // namespace
}  // namespace lightnet::compare_test
