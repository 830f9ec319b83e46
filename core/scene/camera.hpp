// Where the picture is seen from.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/math/vec.hpp"
#include "core/scene/data/scene_data.hpp"
#include "core/scene/surfaces/ray.hpp"

namespace lightnet {

/// A camera for a picture of a given size: perspective or orthographic, with a pinhole or a thin lens; or all
/// directions around one point.
class Camera {
public:
    Camera() = default;
    Camera(const CameraData& data, std::uint32_t width, std::uint32_t height);

    /// The ray through picture position (x, y), in pixels from the upper left corner, and the middle of the lens.
    Ray ray(float x, float y) const;

    /// Is anything out of focus? Then pictures need rays through all of the lens.
    bool has_lens() const { return has_lens_; }
    /// The ray through a picture position and a point of the lens, uniform over its disk if `lens` is over [0,1)². All
    /// rays of one position meet on the plane in focus.
    Ray ray(float x, float y, Vec2 lens) const;
    /// The rays through many picture positions and points of the lens; no points of the `lens`: through its middle.
    void rays(std::span<const Vec2> positions, std::span<const Vec2> lens, std::span<Ray> rays) const;

    /// Where in the picture `position` (world space) is seen from the middle of the lens, as homogeneous coordinates:
    /// pixel (x / z, y / z) from the upper left corner. z is above 0 for what lies before the eye.
    Vec3 project(Vec3 position) const;

private:
    Ray around(float x, float y) const;
    Ray from_nearest(const Ray& ray) const;

    bool orthographic_ = false, has_lens_ = false;
    CameraData::Panorama panorama_ = CameraData::Panorama::none;
    Matrix to_world_, from_world_;          // of panoramas
    Vec2 size_{1, 1};                       // the same: pixels
    Vec3 origin_;                           // all in world space
    Vec3 corner_{-1, 1, 1};                 // from the eye to the picture's upper left corner, one unit of screen away;
                                            // orthographic: to that corner itself
    Vec3 right_{2, 0, 0}, down_{0, -2, 0};  // per pixel
    Vec3 axis_{0, 0, 1};                    // orthographic: of all rays, one unit long
    Vec3 lens_x_, lens_y_;                  // from the middle of the lens to its rim
    float nearest_ = 0;                     // metres along the axis to the plane where rays begin
    float focus_ = 1;                       // distance of the plane in focus over that of the screen
};

/// Of a picture of that shape whose shorter side spans ±1: x min, x max, y min, y max.
std::array<float, 4> screen_of(float width, float height);

/// A camera that sees everything in a box: from the front, a little from the right and from above (y is up). For a
/// picture of that size.
CameraData camera_for(Vec3 low, Vec3 high, std::uint32_t width, std::uint32_t height);

}  // namespace lightnet
