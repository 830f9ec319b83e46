// The transforms that pbrt's statements name.
#pragma once

#include <optional>
#include <span>

#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/readers/common/inverse.hpp"

namespace lightnet::pbrt {

Matrix translation(double x, double y, double z);
Matrix scaling(double x, double y, double z);
/// Around an axis of any length but 0, angle in degrees. None: no axis.
std::optional<Matrix> rotation(double degrees, double x, double y, double z);
/// World to camera, from eye, target and up in this order. None: they don't span a view.
std::optional<Matrix> look_at(std::span<const double, 9> numbers);
/// From 16 numbers, column after column, as pbrt writes them.
Matrix by_columns(std::span<const double, 16> numbers);
/// The factor by which it scales lengths, if that is the same in all directions (within rounding of the file).
std::optional<double> uniform_scale(const Matrix& matrix);

}  // namespace lightnet::pbrt
