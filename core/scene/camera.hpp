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
    Matrix to_world_;
    Vec3 origin_;
    float left_ = -1, top_ = 1, pixel_x_ = 0, pixel_y_ = 0, depth_ = 1;
};

}  // namespace lightnet
