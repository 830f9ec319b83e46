// Views: rays of positions in a picture, once a camera stands and its picture has a size.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>

#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet {

struct CameraData;

/// What a camera of any projection can be asked. Positions are in pixels from the upper left corner, rays in world
/// space.
///   ray(x, y): through the middle of the lens
///   ray(x, y, lens): through a point of it, uniform over its disk if `lens` is over [0,1)²
///   project(p): where p (world space) is seen from the middle of the lens, as homogeneous coordinates: pixel
///     (x / z, y / z); z is above 0 for what lies before the eye
template <class V>
concept IsView = requires(const V& view, float x, Vec2 lens, Vec3 position) {
    { view.ray(x, x) } -> std::same_as<Ray>;
    { view.ray(x, x, lens) } -> std::same_as<Ray>;
    { view.project(position) } -> std::same_as<Vec3>;
};

/// Of a picture of that shape whose shorter side spans ±1: x min, x max, y min, y max.
std::array<float, 4> screen_of(float width, float height);

/// A flat screen before the eye, and the lens around the eye, in world space. A value.
struct FlatScreen {
    /// `depth`: how far away the screen is, in its own units. `corner_depth`: the same of its corner.
    FlatScreen(const CameraData& camera, Vec2 size, float depth, float corner_depth);

    Vec3 at(float x, float y) const { return corner + right * x + down * y; }
    Vec3 aside(Vec2 lens) const;
    /// Its ray begins where the camera begins to see, and ends where it no longer does.
    Ray within_sight(const Ray& ray) const;

    Vec3 origin;
    Vec3 corner;                              // from the eye to the picture's upper left corner
    Vec3 right, down;                         // per pixel
    Vec3 axis;                                // one unit long
    Vec3 lens_x, lens_y;                      // from the middle of the lens to its rim
    float nearest = 0, farthest = Ray().far;  // metres along the axis to the planes where rays begin and end
    float focus = 1;                          // distance of the plane in focus over that of the screen
};

}  // namespace lightnet
