// A viewpoint: how a graph says from where a picture is seen.
#pragma once

#include "core/base/math/box.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/camera/camera_data.hpp"

namespace lightnet {

/// World space.
struct Viewpoint {
    Vec3 from, to, up;
    double fov = 0;  // degrees, across the shorter side of the picture; 0: it has none
};

/// Of a camera: it looks at what lies as far ahead as the middle of `around`, or where that is not ahead, as far as
/// all of it is wide.
Viewpoint viewpoint_of(const CameraData& camera, const Box& around);

}  // namespace lightnet
