#include "core/scene/bsdf/beckmann.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightnet::beckmann_test {
namespace {

// Facets that a direction sees have slopes along it up to x with a chance of F(x)/F(cot): Heitz and d'Eon 2014.
TEST(BeckmannLaw, FindsTheVisibleSlopeWithThatChance) {
    double most = 0;
    for (int i = 0; i < 1000; ++i)
        for (int j = 0; j < 200; ++j) {
            const double angle = (i + 0.5) / 1000 * 1.5706, tangent = std::tan(angle);
            const float chance = (float(j) + 0.5f) / 200;
            const Vec3 seen{float(std::sin(angle)), 0, float(std::cos(angle))};
            const double slope = -BeckmannLaw::sample_visible(seen, {chance, 0.5f}).x;
            const auto up_to = [&](double x) {
                return 1 + std::erf(x) + tangent / std::sqrt(std::numbers::pi) * std::exp(-x * x);
            };
            most = std::max(most, std::fabs(up_to(slope) / up_to(1 / tangent) - chance));
        }
    EXPECT_LT(most, 3e-6);
}

}  // namespace
}  // namespace lightnet::beckmann_test
