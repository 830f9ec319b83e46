// Matrices from the world to the picture, for the headers of pictures.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/math/transform.hpp"
#include "core/scene/camera/camera_data.hpp"

namespace lightnet {

/// Both take points of the world (scene units).
struct CameraMatrices {
    Matrix to_camera;              // x to the right, y up, z ahead
    std::optional<Matrix> to_ndc;  // after division by w: x and y from 0, 0 in the picture's upper left corner to 1, 1
                                   // in its lower right one; z is the depth times w. None: the picture is not flat
};

/// For a picture of that size. The same convention as OpenEXR's worldToCamera and worldToNDC, but for columns of
/// coordinates. Of a lens: its middle.
CameraMatrices matrices_of(const CameraData& camera, std::uint32_t width, std::uint32_t height);

}  // namespace lightnet
