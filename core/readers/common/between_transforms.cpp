#include "core/readers/common/between_transforms.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace lightnet {
namespace {

using Square = std::array<std::array<double, 3>, 3>;

Square linear_part(const Matrix& t) {
    Square a{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) a[i][j] = t.m[i][j];
    return a;
}

Square product(const Square& a, const Square& b) {
    Square c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
    return c;
}

Square transposed(const Square& a) {
    Square b{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) b[i][j] = a[j][i];
    return b;
}

/// Of each entry: what its row and column leave, with its sign. Over the determinant: the inverse, transposed.
Square cofactors(const Square& a) {
    Square c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            c[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
        }
    return c;
}

double determinant(const Square& a) {
    const Square c = cofactors(a);
    return a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2];
}

/// The turn that is nearest to it, by Higham's iteration, made to keep handedness. None: it has no inverse.
std::optional<Square> turn_in(const Square& a) {
    Square q = a;
    for (int round = 0; round < 64; ++round) {
        const double size = determinant(q);
        if (!(std::fabs(size) > 1e-300) || !std::isfinite(size)) return std::nullopt;
        const Square c = cofactors(q);
        double change = 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                const double next = (q[i][j] + c[i][j] / size) / 2;
                change = std::max(change, std::fabs(next - q[i][j]));
                q[i][j] = next;
            }
        if (change < 1e-15) break;
    }
    if (determinant(q) < 0)
        for (auto& row : q)
            for (double& entry : row) entry = -entry;
    return q;
}

/// Shepperd 1978.
Quaternion quaternion_of(const Square& r) {
    const double trace = r[0][0] + r[1][1] + r[2][2];
    Quaternion q{};
    if (trace > 0) {
        const double s = 2 * std::sqrt(1 + trace);
        q = {(r[2][1] - r[1][2]) / s, (r[0][2] - r[2][0]) / s, (r[1][0] - r[0][1]) / s, s / 4};
    } else {
        const std::size_t i = r[0][0] > r[1][1] ? (r[0][0] > r[2][2] ? 0 : 2) : (r[1][1] > r[2][2] ? 1 : 2);
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const double s = 2 * std::sqrt(std::max(1e-30, 1 + r[i][i] - r[j][j] - r[k][k]));
        q[i] = s / 4;
        q[j] = (r[j][i] + r[i][j]) / s;
        q[k] = (r[k][i] + r[i][k]) / s;
        q[3] = (r[k][j] - r[j][k]) / s;
    }
    return q;
}

Square square_of(const Quaternion& q) {
    const auto [x, y, z, w] = q;
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

Matrix evenly(const Matrix& a, const Matrix& b, double t) {
    Matrix mean;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) mean.m[i][j] = a.m[i][j] * (1 - t) + b.m[i][j] * t;
    return mean;
}

}  // namespace

Quaternion slerp(const Quaternion& a, const Quaternion& b, double t) {
    double cosine = 0;
    for (std::size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
    const double sign = cosine < 0 ? -1 : 1, angle = std::acos(std::min(1.0, std::fabs(cosine)));
    const double sine = std::sin(angle);
    const bool near = sine < 1e-6;  // a line is as good then
    const double of_a = near ? 1 - t : std::sin(angle * (1 - t)) / sine;
    const double of_b = sign * (near ? t : std::sin(angle * t) / sine);
    Quaternion q{};
    for (std::size_t i = 0; i < 4; ++i) q[i] = of_a * a[i] + of_b * b[i];
    return q;
}

Matrix between(const Matrix& a, const Matrix& b, double t) {
    if (a == b) return a;
    Matrix mean = evenly(a, b, t);
    const Square of_a = linear_part(a), of_b = linear_part(b);
    const auto turn_a = turn_in(of_a), turn_b = turn_in(of_b);
    if (!turn_a || !turn_b) return mean;
    const Square stretch_a = product(transposed(*turn_a), of_a), stretch_b = product(transposed(*turn_b), of_b);
    Square stretch{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) stretch[i][j] = stretch_a[i][j] * (1 - t) + stretch_b[i][j] * t;
    const Square whole = product(square_of(slerp(quaternion_of(*turn_a), quaternion_of(*turn_b), t)), stretch);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) mean.m[i][j] = whole[i][j];
    return mean;
}

Matrix transform_at(std::span<const TransformKey> keys, double seconds) {
    const auto behind = std::ranges::upper_bound(keys, seconds, {}, &TransformKey::seconds);
    if (behind == keys.begin()) return keys.front().transform;
    if (behind == keys.end()) return keys.back().transform;
    const auto& last = *(behind - 1);
    return between(last.transform, behind->transform, (seconds - last.seconds) / (behind->seconds - last.seconds));
}

}  // namespace lightnet
