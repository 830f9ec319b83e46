#include "core/scene/camera_matrices.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "core/scene/camera.hpp"

namespace lightnet {
namespace {

// Of a matrix whose last row is 0 0 0 1, by Cramer's rule.
Matrix affine_inverse(const Matrix& matrix) {
    const auto& m = matrix.m;
    const auto minor = [&](std::size_t i, std::size_t j) {
        const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        return m[a][c] * m[b][d] - m[a][d] * m[b][c];
    };
    const double all = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    Matrix inverse;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) inverse.m[i][j] = minor(j, i) / all;
        inverse.m[i][3] = -(inverse.m[i][0] * m[0][3] + inverse.m[i][1] * m[1][3] + inverse.m[i][2] * m[2][3]);
    }
    return inverse;
}

}  // namespace

CameraMatrices matrices_of(const CameraData& camera, std::uint32_t width, std::uint32_t height) {
    const auto screen = camera.screen_given ? camera.screen : screen_of(float(width), float(height));
    const double left = screen[0], right = screen[1], bottom = screen[2], top = screen[3];
    const double away =
        camera.orthographic ? 1 : 1 / std::tan(double{camera.fov} * std::numbers::pi / 360);  // of the screen
    CameraMatrices made;
    made.to_camera = affine_inverse(camera.to_world);
    const double across = right - left, down = top - bottom;
    Matrix project;
    if (camera.orthographic)
        project.m = {{{1 / across, 0, 0, -left / across}, {0, -1 / down, 0, top / down}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    else
        project.m = {
            {{away / across, 0, -left / across, 0}, {0, -away / down, top / down, 0}, {0, 0, 1, 0}, {0, 0, 1, 0}}};
    made.to_ndc = project * made.to_camera;
    return made;
}

}  // namespace lightnet
