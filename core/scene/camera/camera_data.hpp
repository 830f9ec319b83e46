// A camera as files say it.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/math/transform.hpp"
#include "core/scene/camera/projection.hpp"

namespace lightnet {

/// Right-handed picture: x to the right, y down in the picture.
struct CameraData {
    Matrix to_world{};  // camera space: looks along +z, y up, x to the right of the picture
    AnyProjection projection{};
    float fov = 90;  // degrees, across the shorter side of the picture; of use for a perspective camera only
    std::array<float, 4> screen{-1, 1, -1, 1};  // x min, x max, y min, y max at distance 1/tan(fov/2), shorter side =
                                                // ±1; orthographic: in metres
    bool screen_given = false;                  // else derived from the picture's shape
    float lens_radius = 0;                      // metres; 0: a pinhole
    float focus_distance = 1e6f;                // metres along the axis to the plane in which everything is sharp
    SourceLine where{};                         // it stands in the files, if anywhere
    float nearest = 0;                          // metres along the axis: what lies before that is not seen
    float farthest = std::numeric_limits<float>::infinity();  // the same: what lies beyond it
    std::vector<CameraData> later{};  // at evenly spaced steps, the last when the shutter closes; none: it
                                      // stands still
    std::vector<CameraData> next{};   // one frame later, where somebody asks how far things move; none: it stands still

    bool is_orthographic() const { return std::holds_alternative<Orthographic>(projection); }
};

}  // namespace lightnet
