#include "core/scene/camera/camera_matrices.hpp"

#include <cstddef>
#include <variant>

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

/// Sides of the screen.
struct Sides {
    double left, right, bottom, top;
    double across() const { return right - left; }
    double down() const { return top - bottom; }
};

std::optional<Matrix> camera_to_ndc(const Perspective&, const CameraData& camera, const Sides& screen) {
    const double away = screen_distance(camera), across = screen.across(), down = screen.down();
    Matrix project;
    project.m = {{{away / across, 0, -screen.left / across, 0},
                  {0, -away / down, screen.top / down, 0},
                  {0, 0, 1, 0},
                  {0, 0, 1, 0}}};
    return project;
}
std::optional<Matrix> camera_to_ndc(const Orthographic&, const CameraData&, const Sides& screen) {
    const double across = screen.across(), down = screen.down();
    Matrix project;
    project.m = {
        {{1 / across, 0, 0, -screen.left / across}, {0, -1 / down, 0, screen.top / down}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    return project;
}
std::optional<Matrix> camera_to_ndc(const LatitudeLongitude&, const CameraData&, const Sides&) { return {}; }
std::optional<Matrix> camera_to_ndc(const EqualArea&, const CameraData&, const Sides&) { return {}; }

}  // namespace

CameraMatrices matrices_of(const CameraData& camera, std::uint32_t width, std::uint32_t height) {
    const auto [left, right, bottom, top] =
        camera.screen_given ? camera.screen : screen_of(float(width), float(height));
    const Sides screen{left, right, bottom, top};
    CameraMatrices made{affine_inverse(camera.to_world), {}};
    const auto project = std::visit([&](const auto& projection) { return camera_to_ndc(projection, camera, screen); },
                                    camera.projection);
    if (project) made.to_ndc = *project * made.to_camera;
    return made;
}

}  // namespace lightnet
