#include "core/readers/common/inverse.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace lightnet {

std::optional<Matrix> inverse(const Matrix& matrix) {
    auto a = matrix.m;
    Matrix result;
    auto& b = result.m;
    for (std::size_t column = 0; column < 4; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column + 1; row < 4; ++row)
            if (std::fabs(a[row][column]) > std::fabs(a[pivot][column])) pivot = row;
        if (!(std::fabs(a[pivot][column]) > 0)) return std::nullopt;
        std::swap(a[pivot], a[column]);
        std::swap(b[pivot], b[column]);
        const double d = 1 / a[column][column];
        for (std::size_t k = 0; k < 4; ++k) a[column][k] *= d, b[column][k] *= d;
        for (std::size_t row = 0; row < 4; ++row) {
            const double f = row == column ? 0 : a[row][column];
            for (std::size_t k = 0; k < 4; ++k) a[row][k] -= f * a[column][k], b[row][k] -= f * b[column][k];
        }
    }
    for (const auto& row : b)
        for (const double value : row)
            if (!std::isfinite(value)) return std::nullopt;
    return result;
}

}  // namespace lightnet
