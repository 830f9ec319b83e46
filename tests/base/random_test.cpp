#include "core/base/math/random.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sobol.hpp"

namespace lightnet::random_test {
namespace {

TEST(Random, DerivesDifferentStreamsForDifferentReasons) {
    std::set<Key> keys;
    for (std::uint32_t x = 0; x < 50; ++x)
        for (std::uint32_t y = 0; y < 50; ++y) {
            keys.insert(pixel_key(1, x, y));
            keys.insert(pixel_key(2, x, y));
            keys.insert(child(pixel_key(1, x, y), key_of("direct")));
            keys.insert(child(pixel_key(1, x, y), key_of("bounce")));
            keys.insert(child(pixel_key(1, x, y), key_of("bounce"), 1));
        }
    EXPECT_EQ(keys.size(), 5u * 2500);
}

// Each aligned block of 2ⁿ points has one in each of the 2ⁿ cells of every shape 2ᵃ × 2ᵇ with a + b = n.
TEST(Sobol, StratifiesEveryAlignedPowerOfTwo) {
    for (const Key key : {1ull, 99ull, 0xfeedull})
        for (const std::uint32_t bits : {2u, 4u, 6u, 8u})
            for (std::uint32_t first = 0; first < 4u << bits; first += 1u << bits)
                for (std::uint32_t a = 0; a <= bits; ++a) {
                    std::set<std::pair<int, int>> cells;
                    for (std::uint32_t i = 0; i < 1u << bits; ++i) {
                        const Vec2 p = sobol_point(key, first + i);
                        cells.insert({int(p.x * float(1u << a)), int(p.y * float(1u << (bits - a)))});
                    }
                    ASSERT_EQ(cells.size(), 1u << bits) << "key " << key << ", " << a << " of " << bits << " bits";
                }
}

TEST(Sobol, StaysBelowOne) {
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const Vec2 p = sobol_point(5, i);
        ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
    }
}

TEST(Sobol, KeysAreIndependent) {
    double product = 0;
    constexpr int keys = 20000;
    for (int k = 0; k < keys; ++k)
        product += double(sobol_point(Key(k), 0).x - 0.5f) * (sobol_point(Key(k + 1), 0).x - 0.5f);
    EXPECT_NEAR(product / keys * 12, 0, 4 / std::sqrt(double(keys)));  // four standard deviations
}

TEST(Samples, GivesManyAtOnceWhatItGivesOneByOne) {
    for (const std::size_t count : {0u, 1u, 7u, 64u, 65u, 300u}) {
        std::vector<Key> keys(count);
        std::vector<std::uint32_t> indices(count);
        for (std::size_t i = 0; i < count; ++i) {
            keys[i] = mix(i / 3);
            indices[i] = static_cast<std::uint32_t>(i % 3 ? i : ~i);
        }
        std::vector<Vec2> points(count);
        std::vector<float> values(count);
        Samples::many_2d(keys, indices, 9, points);
        Samples::many(keys, indices, 10, values);
        for (std::size_t i = 0; i < count; ++i) {
            Samples one(keys[i], indices[i], 9);
            ASSERT_EQ(one.next_2d(), points[i]) << i << " of " << count;
            ASSERT_EQ(one.next(), values[i]) << i << " of " << count;
        }
    }
}

TEST(Samples, UsesANewDimensionForEachCall) {
    Samples samples(1, 0);
    const Vec2 first = samples.next_2d(), second = samples.next_2d();
    EXPECT_NE(first, second);
    Samples again(1, 0);
    EXPECT_EQ(again.next_2d(), first);
    EXPECT_EQ(again.next(), second.x);
}

}  // namespace
}  // namespace lightnet::random_test
