// Where the picture is seen from.
#pragma once

#include <cstdint>

#include "core/scene/ray.hpp"
#include "core/scene/scene_data.hpp"

namespace lightnet {

/// A perspective camera for a picture of a given size.
class Camera {
public:
    Camera() = default;
    Camera(const CameraData& data, std::uint32_t width, std::uint32_t height);

    /// The ray through picture position (x, y), in pixels from the upper left corner.
    Ray ray(float x, float y) const;

private:
    Vec3 origin_;                           // all in world space
    Vec3 corner_{-1, 1, 1};                 // from the eye to the picture's upper left corner, one unit of screen away
    Vec3 right_{2, 0, 0}, down_{0, -2, 0};  // per pixel
};

}  // namespace lightnet
