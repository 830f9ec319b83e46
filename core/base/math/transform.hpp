// Affine and projective transforms of points, directions and normals.
#pragma once

#include <array>

#include "core/base/math/vec.hpp"

namespace lightnet {

/// A 4×4 matrix, row-major, applied to column vectors. Kept in double: scene files chain many of them.
struct Matrix {
    std::array<std::array<double, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    friend bool operator==(const Matrix&, const Matrix&) = default;
};

inline Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix c;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            double sum = 0;
            for (int k = 0; k < 4; ++k) sum += a.m[i][k] * b.m[k][j];
            c.m[i][j] = sum;
        }
    return c;
}

inline Vec3 transform_direction(const Matrix& t, Vec3 v) {
    const auto row = [&](int i) { return float(t.m[i][0] * v.x + t.m[i][1] * v.y + t.m[i][2] * v.z); };
    return {row(0), row(1), row(2)};
}

/// Divides by w, so that projections may be used as well.
inline Vec3 transform_point(const Matrix& t, Vec3 p) {
    const auto row = [&](int i) { return t.m[i][0] * p.x + t.m[i][1] * p.y + t.m[i][2] * p.z + t.m[i][3]; };
    const double w = row(3);
    return {float(row(0) / w), float(row(1) / w), float(row(2) / w)};
}

/// Normals go by the inverse transpose; `inverse` is the inverse of the points' transform. Not normalised.
inline Vec3 transform_normal(const Matrix& inverse, Vec3 n) {
    const auto column = [&](int j) {
        return float(inverse.m[0][j] * n.x + inverse.m[1][j] * n.y + inverse.m[2][j] * n.z);
    };
    return {column(0), column(1), column(2)};
}

/// True when the transform turns left-handed coordinates into right-handed ones.
inline bool swaps_handedness(const Matrix& t) {
    const auto& m = t.m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
           0;
}

}  // namespace lightnet
