#include "core/film/perceived_colour.hpp"

#include <cmath>

namespace lightnet {
namespace {

using Matrix = std::array<Triple, 3>;

// Linear sRGB to CIE XYZ, as exact fractions (Lindbloom's method with the chromaticities of BT.709 and D65).
constexpr Matrix to_xyz{{{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                         {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                         {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};

constexpr Triple times(const Matrix& m, const Triple& v) {
    Triple product{};
    for (std::size_t i = 0; i < 3; ++i) product[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return product;
}

constexpr Matrix inverse(const Matrix& m) {
    const auto minor_of = [&](std::size_t i, std::size_t j) {  // with its sign, as indices go round
        const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        return m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
    };
    const double determinant = m[0][0] * minor_of(0, 0) + m[0][1] * minor_of(0, 1) + m[0][2] * minor_of(0, 2);
    Matrix result{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) result[i][j] = minor_of(j, i) / determinant;
    return result;
}

constexpr Matrix from_xyz = inverse(to_xyz);
constexpr Triple white = times(to_xyz, {1, 1, 1});

/// XYZ in parts of white.
Triple relative_xyz(Rgb linear) {
    Triple xyz = times(to_xyz, {linear.r, linear.g, linear.b});
    for (std::size_t i = 0; i < 3; ++i) xyz[i] /= white[i];
    return xyz;
}

double lab_curve(double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

}  // namespace

Triple ycxcz_of(Rgb linear) {
    const auto [x, y, z] = relative_xyz(linear);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Rgb rgb_of_ycxcz(const Triple& colour) {
    const double y = (colour[0] + 16) / 116, x = y + colour[1] / 500, z = y - colour[2] / 200;
    const Triple rgb = times(from_xyz, {x * white[0], y * white[1], z * white[2]});
    return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}

Triple hunt_lab_of(Rgb linear) {
    const auto xyz = relative_xyz(linear);
    const double x = lab_curve(xyz[0]), y = lab_curve(xyz[1]), z = lab_curve(xyz[2]);
    const double lightness = 116 * y - 16;
    return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

double hyab(const Triple& a, const Triple& b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

}  // namespace lightnet
