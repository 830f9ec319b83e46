// Cameras that see all directions around them.
#pragma once

#include "core/scene/camera/view.hpp"

namespace lightnet {

/// What panoramas have in common: the eye, its axes, and the picture's size. There is no lens. A value.
struct Surroundings {
    Surroundings(const CameraData& camera, Vec2 size);

    /// The ray into a direction of the camera's own space, and back.
    Ray ray(Vec3 direction) const;
    Vec3 direction_to(Vec3 position) const;
    Vec3 pixel(Vec2 at) const { return {at.x * size.x, at.y * size.y, 1}; }

    Matrix to_world, from_world;
    Vec3 origin;
    Vec2 size;  // pixels
};

/// All directions by longitude and latitude: the picture's upper row is +y, its middle looks along -x (as in pbrt).
struct LatitudeLongitude {
    static constexpr const char* name = "all directions";
    static constexpr bool has_lens = false;

    class View {
    public:
        View(const CameraData& camera, Vec2 size) : around_(camera, size) {}
        Ray ray(float x, float y) const;
        Ray ray(float x, float y, Vec2) const { return ray(x, y); }
        Vec3 project(Vec3 position) const;

    private:
        Surroundings around_;
    };
};

/// All directions on a square whose equal areas are equal solid angles (Clarberg 2008); its middle looks along +y (as
/// in pbrt).
struct EqualArea {
    static constexpr const char* name = "all directions";
    static constexpr bool has_lens = false;

    class View {
    public:
        View(const CameraData& camera, Vec2 size) : around_(camera, size) {}
        Ray ray(float x, float y) const;
        Ray ray(float x, float y, Vec2) const { return ray(x, y); }
        Vec3 project(Vec3 position) const;

    private:
        Surroundings around_;
    };
};

}  // namespace lightnet
