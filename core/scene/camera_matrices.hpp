// Where points of the world are in a picture, as matrices: for the headers of pictures.
#pragma once

#include <cstdint>

#include "core/base/math/transform.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Both take points of the world (scene units).
struct CameraMatrices {
    Matrix to_camera;  // x to the right, y up, z ahead
    Matrix to_ndc;     // after division by w: x and y from 0, 0 in the picture's upper left corner to 1, 1 in its lower
                       // right one; z is the depth times w
};

/// For a picture of that size. The same convention as OpenEXR's worldToCamera and worldToNDC, but for columns of
/// coordinates. Of a lens: its middle.
CameraMatrices matrices_of(const CameraData& camera, std::uint32_t width, std::uint32_t height);

}  // namespace lightnet
