// The camera from which the picture is seen.
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "core/base/math/vec.hpp"
#include "core/scene/camera/camera_data.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet {

/// A camera for a picture of a given size, by any projection of the list; flat ones may have a thin lens. A value.
class Camera {
public:
    Camera() : Camera(CameraData{}, 1, 1) {}
    Camera(const CameraData& data, std::uint32_t width, std::uint32_t height);

    /// The ray through picture position (x, y), in pixels from the upper left corner, and the middle of the lens.
    Ray ray(float x, float y) const {
        return std::visit([&](const auto& view) { return view.ray(x, y); }, view_);
    }

    /// Is anything out of focus? Then pictures need rays through all of the lens.
    bool has_lens() const { return has_lens_; }
    /// The ray through a picture position and a point of the lens, uniform over its disk if `lens` is over [0,1)². All
    /// rays of one position meet on the plane in focus.
    Ray ray(float x, float y, Vec2 lens) const {
        return std::visit([&](const auto& view) { return view.ray(x, y, lens); }, view_);
    }
    /// The rays through many picture positions and points of the lens; no points of the `lens`: through its middle.
    void rays(std::span<const Vec2> positions, std::span<const Vec2> lens, std::span<Ray> rays) const;
    /// Does it move while the shutter is open? What is asked above and below without a time is as it opens.
    bool moves() const { return !later_.empty(); }
    /// The rays at times of their own; they are told of these.
    void rays(std::span<const Vec2> positions, std::span<const Vec2> lens, std::span<const ShutterTime> times,
              std::span<Ray> rays) const;

    /// Where in the picture `position` (world space) is seen from the middle of the lens, as homogeneous coordinates:
    /// pixel (x / z, y / z) from the upper left corner. z is above 0 for what lies before the eye.
    Vec3 project(Vec3 position) const {
        return std::visit([&](const auto& view) { return view.project(position); }, view_);
    }

private:
    Ray ray(const AnyView& view, Vec2 position, const Vec2* lens) const;

    AnyView view_;
    std::vector<AnyView> later_;  // at later steps
    bool has_lens_ = false;
};

/// A camera that sees everything in a box: from the front, a little from the right and from above (y is up). For a
/// picture of that size.
CameraData camera_for(Vec3 low, Vec3 high, std::uint32_t width, std::uint32_t height);

}  // namespace lightnet
