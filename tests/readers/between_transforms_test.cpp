// Transforms between transforms.
#include "core/readers/common/between_transforms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lightnet::between_transforms_test {
namespace {

Matrix turn_about_z(double angle) {
    Matrix t;
    t.m[0][0] = t.m[1][1] = std::cos(angle);
    t.m[1][0] = std::sin(angle);
    t.m[0][1] = -t.m[1][0];
    return t;
}
Matrix scale(double x, double y, double z) {
    Matrix t;
    t.m[0][0] = x, t.m[1][1] = y, t.m[2][2] = z;
    return t;
}
Matrix move(double x, double y, double z) {
    Matrix t;
    t.m[0][3] = x, t.m[1][3] = y, t.m[2][3] = z;
    return t;
}
void expect_near(const Matrix& a, const Matrix& b) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(a.m[i][j], b.m[i][j], 1e-12) << i << j;
}

TEST(BetweenTransforms, MovesTurnsAndStretchesEvenly) {
    const Matrix a = move(1, 2, 3) * turn_about_z(0.2) * scale(1, 2, 3);
    const Matrix b = move(3, 2, -1) * turn_about_z(1.8) * scale(2, 2, 1);
    expect_near(between(a, b, 0.25), move(1.5, 2, 2) * turn_about_z(0.6) * scale(1.25, 2, 2.5));
    expect_near(between(a, b, 0), a);
    expect_near(between(a, b, 1), b);
    EXPECT_EQ(between(a, a, 0.3), a) << "to the bit";
}

TEST(BetweenTransforms, TakesTheShorterWayAndLargeTurns) {
    constexpr double pi = std::numbers::pi;
    expect_near(between(turn_about_z(-3), turn_about_z(3), 0.5), turn_about_z(pi));
    expect_near(between(turn_about_z(0), turn_about_z(0.75 * pi), 2.0 / 3), turn_about_z(pi / 2));
}

TEST(BetweenTransforms, KeepsMirrorsAndGoesEvenlyThroughWhatHasNoInverse) {
    expect_near(between(scale(-1, 1, 1), turn_about_z(1) * scale(-3, 1, 1), 0.5), turn_about_z(0.5) * scale(-2, 1, 1));
    expect_near(between(scale(0, 1, 1), scale(2, 1, 3), 0.5), scale(1, 1, 2));
}

TEST(BetweenTransforms, StandStillBeyondTheirKeys) {
    const TransformKey keys[] = {{1, move(1, 0, 0)}, {2, move(3, 0, 0)}, {4, move(3, 4, 0)}};
    EXPECT_EQ(transform_at(keys, 0), keys[0].transform);
    EXPECT_EQ(transform_at(keys, 2), keys[1].transform);
    EXPECT_EQ(transform_at(keys, 9), keys[2].transform);
    expect_near(transform_at(keys, 1.5), move(2, 0, 0));
    expect_near(transform_at(keys, 3), move(3, 2, 0));
}

}  // namespace
}  // namespace lightnet::between_transforms_test
