// The inverse of a transform.
#pragma once

#include <optional>

#include "core/base/math/transform.hpp"

namespace lightnet {

/// None: singular.
std::optional<Matrix> inverse(const Matrix& matrix);

}  // namespace lightnet
