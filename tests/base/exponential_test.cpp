#include "core/base/math/exponential.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/math/columns.hpp"

namespace lightnet::exponential_test {
namespace {

TEST(Exponential, IsThatOfTheLibrary) {
    for (int i = -870000; i <= 880000; i += 7) {
        const float x = float(i) * 1e-4f;
        const double expected = std::exp(double(x));
        ASSERT_NEAR(exponential(x) / expected, 1, 2e-7) << x;
    }
    EXPECT_EQ(exponential(-200), exponential(-87));
    EXPECT_EQ(exponential(200), exponential(88));
    EXPECT_EQ(exponential(0), 1);
}

TEST(Exponential, HasALogarithm) {
    for (float x = 1e-30f; x < 1e30f; x *= 1.0007f)
        ASSERT_NEAR(logarithm(x), std::log(double(x)), 1e-7 * std::max(1.0, std::fabs(std::log(double(x))))) << x;
}

TEST(Exponential, HasAnErrorFunctionAndItsInverse) {
    for (float x = 0; x < 3.4f; x += 1e-4f) {
        const double expected = std::erfc(double(x));
        ASSERT_NEAR(complementary_error(x) / expected, 1, 2e-6) << x;
    }
    for (int i = -99999; i < 100000; ++i) {
        const float y = float(i) * 1e-5f;
        ASSERT_NEAR(std::erf(double(inverse_error(y))), y, 2e-7) << y;
    }
}

struct Many {
    Column x, exponentials, logarithms, errors, inverses;
    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < lanes; ++i) {
            exponentials[i] = exponential(x[i]);
            logarithms[i] = logarithm(x[i]);
            errors[i] = complementary_error(x[i]);
            inverses[i] = inverse_error(x[i]);
        }
    }
};

TEST(Exponential, OfManyIsThatOfOneToTheBit) {
    Many many;
    for (std::size_t i = 0; i < lanes; ++i) many.x[i] = (float(i) + 0.37f) / lanes;
    work_in_lanes(many);
    for (std::size_t i = 0; i < lanes; ++i) {
        volatile float alone = many.x[i];  // or the compiler works it out
        EXPECT_EQ(many.exponentials[i], exponential(alone));
        EXPECT_EQ(many.logarithms[i], logarithm(alone));
        EXPECT_EQ(many.errors[i], complementary_error(alone));
        EXPECT_EQ(many.inverses[i], inverse_error(alone));
    }
}

}  // namespace
}  // namespace lightnet::exponential_test
