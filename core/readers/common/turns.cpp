#include "core/readers/common/turns.hpp"

#include <cmath>
#include <cstddef>

#include "core/base/math/frame.hpp"

namespace lightnet {

Matrix turn_of(const Matrix& transform) {
    Matrix turn;
    for (std::size_t j = 0; j < 3; ++j) {
        const double size = std::hypot(transform.m[0][j], transform.m[1][j], transform.m[2][j]);
        for (std::size_t i = 0; i < 3; ++i)
            turn.m[i][j] = size > 0 && std::isfinite(size) ? transform.m[i][j] / size : (i == j ? 1 : 0);
    }
    return turn;
}

Matrix hung(Vec3 down) {
    const Frame frame = Frame::around(-down);
    Matrix turn;
    const Vec3 axes[] = {frame.x, frame.y, frame.z};
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) turn.m[i][j] = double{axes[j][i]};
    return turn;
}

}  // namespace lightnet
