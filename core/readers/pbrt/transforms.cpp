#include "core/readers/pbrt/transforms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace lightnet::pbrt {
namespace {

using Triple = std::array<double, 3>;

Triple cross(const Triple& a, const Triple& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

bool normalize(Triple& a) {
    const double length = std::sqrt(dot(a, a));
    if (!(length > 0) || !std::isfinite(length)) return false;
    for (auto& x : a) x /= length;
    return true;
}

}  // namespace

Matrix translation(double x, double y, double z) {
    return {{{{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}, {0, 0, 0, 1}}}};
}
Matrix scaling(double x, double y, double z) { return {{{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}, {0, 0, 0, 1}}}}; }

std::optional<Matrix> rotation(double degrees, double x, double y, double z) {
    Triple a{x, y, z};
    if (!normalize(a)) return std::nullopt;
    const double angle = degrees * std::numbers::pi / 180, s = std::sin(angle), c = std::cos(angle);
    Matrix r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r.m[i][j] = a[i] * a[j] * (1 - c) + (i == j ? c : 0);
    r.m[0][1] -= a[2] * s, r.m[0][2] += a[1] * s;
    r.m[1][0] += a[2] * s, r.m[1][2] -= a[0] * s;
    r.m[2][0] -= a[1] * s, r.m[2][1] += a[0] * s;
    return r;
}

// pbrt's camera space is left-handed: x to the right of the image, y up, z into it. Its numbers are floats: far from
// the origin an eye between two of them would look past what stands there.
std::optional<Matrix> look_at(std::span<const double, 9> given) {
    std::array<double, 9> n{};
    std::ranges::transform(given, n.begin(), [](double number) { return double{static_cast<float>(number)}; });
    const Triple eye{n[0], n[1], n[2]};
    Triple z{n[3] - n[0], n[4] - n[1], n[5] - n[2]}, up{n[6], n[7], n[8]};
    if (!normalize(z) || !normalize(up)) return std::nullopt;
    Triple x = cross(up, z);
    if (!normalize(x)) return std::nullopt;
    const Triple y = cross(z, x);
    Matrix to_camera;
    const std::array<Triple, 3> axes{x, y, z};
    for (int i = 0; i < 3; ++i) to_camera.m[i] = {axes[i][0], axes[i][1], axes[i][2], -dot(axes[i], eye)};
    return to_camera;
}

Matrix by_columns(std::span<const double, 16> numbers) {
    Matrix matrix;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) matrix.m[row][column] = numbers[4 * column + row];
    return matrix;
}

std::optional<double> uniform_scale(const Matrix& matrix) {
    std::array<Triple, 3> columns;
    for (int j = 0; j < 3; ++j) columns[j] = {matrix.m[0][j], matrix.m[1][j], matrix.m[2][j]};
    const double square = dot(columns[0], columns[0]), tolerance = 1e-4 * square;
    for (int j = 0; j < 3; ++j)
        if (std::fabs(dot(columns[j], columns[j]) - square) > tolerance ||
            std::fabs(dot(columns[j], columns[(j + 1) % 3])) > tolerance)
            return std::nullopt;
    return std::sqrt(square);
}

}  // namespace lightnet::pbrt
