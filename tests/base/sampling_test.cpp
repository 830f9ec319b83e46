#include "core/base/math/sampling.hpp"

#include <gtest/gtest.h>

#include "core/base/math/frame.hpp"
#include "core/base/math/octahedral.hpp"
#include "core/base/math/samples.hpp"
#include "core/base/math/turns.hpp"

namespace lightnet::sampling_test {
namespace {

constexpr std::uint32_t many = 1 << 14;

template <class Function>
double mean(Function value) {
    double sum = 0;
    for (std::uint32_t i = 0; i < many; ++i) sum += value(Samples(7, i).next_2d());
    return sum / many;
}

TEST(Sampling, SineAndCosineMatchTheLibrary) {
    for (float x = -pi / 4; x <= pi / 4; x += 1e-3f) {
        const auto [sine, cosine] = sine_cosine_near_zero(x);
        EXPECT_NEAR(sine, std::sin(x), 2e-7f);
        EXPECT_NEAR(cosine, std::cos(x), 2e-7f);
    }
}

TEST(Turns, AreThoseOfTheLibraryInEveryQuarter) {
    for (int i = -40000; i <= 40000; ++i) {
        const double angle = i * (std::numbers::pi / 40000);
        const auto x = float(3 * std::cos(angle)), y = float(3 * std::sin(angle));
        ASSERT_NEAR(turns(y, x), std::atan2(double{y}, double{x}) / (2 * std::numbers::pi), 1e-7) << i;
        const auto part = float(i) / 80000;
        const auto [sine, cosine] = sine_cosine_of_turns(part);
        ASSERT_NEAR(sine, std::sin(2 * std::numbers::pi * part), 2e-7) << i;
        ASSERT_NEAR(cosine, std::cos(2 * std::numbers::pi * part), 2e-7) << i;
    }
    EXPECT_EQ(turns(0, 0), 0);
    EXPECT_EQ(turns(0, -2), 0.5f);
    EXPECT_EQ(turns(-3, 0), -0.25f);
    EXPECT_EQ(turns(1e-30f, 1), 1e-30f * (0.5f * inverse_pi));  // small angles keep their digits
    EXPECT_EQ(sine_cosine_of_turns(-0.25f).sine, -1);
}

TEST(Sampling, FillsTheDiskEvenly) {
    EXPECT_NEAR(mean([](Vec2 u) { return disk(u).x; }), 0, 1e-3);
    EXPECT_NEAR(mean([](Vec2 u) { return disk(u).x * disk(u).x; }), 0.25, 1e-3);
    EXPECT_NEAR(mean([](Vec2 u) { return disk(u).x * disk(u).y; }), 0, 1e-3);
    EXPECT_NEAR(mean([](Vec2 u) { return std::hypot(disk(u).x, disk(u).y) < 0.5f; }), 0.25, 1e-3);
}

TEST(Sampling, WeighsTheHemisphereByTheCosine) {
    EXPECT_NEAR(mean([](Vec2 u) { return cosine_hemisphere(u).z; }), 2.0 / 3, 1e-3);
    EXPECT_NEAR(mean([](Vec2 u) { return length(cosine_hemisphere(u)); }), 1, 1e-6);
}

TEST(Sampling, FillsConesEvenly) {
    for (const float opening : {1e-7f, 1e-3f, 0.5f, 1.0f, 2.0f}) {
        EXPECT_NEAR(mean([&](Vec2 u) { return (1 - cone(u, opening).z) / opening; }), 0.5,
                    opening < 1e-6f ? 0.3 : 1e-3);
        EXPECT_NEAR(mean([&](Vec2 u) { return length(cone(u, opening)); }), 1, 1e-6);
        // x² has mean sin²/2 over the cone: (opening - opening²/3)/... by integration
        const double x2 = opening / 2.0 - double{opening} * opening / 6;
        EXPECT_NEAR(mean([&](Vec2 u) { return cone(u, opening).x * cone(u, opening).x; }) / x2, 1, 1e-2);
    }
}

TEST(Sampling, FillsTrianglesEvenly) {
    EXPECT_NEAR(mean([](Vec2 u) { return triangle(u).x; }), 1.0 / 3, 1e-3);
    EXPECT_NEAR(mean([](Vec2 u) { return triangle(u).y; }), 1.0 / 3, 1e-3);
    EXPECT_NEAR(mean([](Vec2 u) { return triangle(u).x * triangle(u).y; }), 1.0 / 12, 1e-3);
    EXPECT_NEAR(mean([](Vec2 u) { return triangle(u).x * triangle(u).x; }), 1.0 / 6, 1e-3);
}

TEST(Octahedral, ComesBackToTheSameDirection) {
    for (std::uint32_t i = 0; i < many; ++i) {
        const Vec3 n = sphere(Samples(3, i).next_2d());
        EXPECT_NEAR(length(from_octahedral(to_octahedral(n)) - n), 0, 4e-7f);
    }
    for (const Vec3 n : {Vec3{0, 0, -1}, Vec3{0, 0, 1}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}})
        EXPECT_EQ(from_octahedral(to_octahedral(n)), n);
}

TEST(Frame, IsOrthonormalAroundAnyNormal) {
    for (std::uint32_t i = 0; i < many; ++i) {
        const Frame frame = Frame::around(sphere(Samples(3, i).next_2d()));
        EXPECT_NEAR(dot(frame.x, frame.y), 0, 1e-6f);
        EXPECT_NEAR(dot(frame.x, frame.z), 0, 1e-6f);
        EXPECT_NEAR(length(cross(frame.x, frame.y) - frame.z), 0, 1e-6f);
    }
}

}  // namespace
}  // namespace lightnet::sampling_test
