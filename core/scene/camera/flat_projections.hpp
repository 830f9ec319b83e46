// Cameras whose pictures are flat.
#pragma once

#include "core/scene/camera/view.hpp"

namespace lightnet {

/// All rays meet in the eye.
struct Perspective {
    static constexpr const char* name = "perspective";
    static constexpr bool has_lens = true;

    class View {
    public:
        View(const CameraData& camera, Vec2 size);
        Ray ray(float x, float y) const;
        Ray ray(float x, float y, Vec2 lens) const;
        Vec3 project(Vec3 position) const;

    private:
        FlatScreen screen_;
    };
};

/// All rays are parallel.
struct Orthographic {
    static constexpr const char* name = "orthographic";
    static constexpr bool has_lens = true;

    class View {
    public:
        View(const CameraData& camera, Vec2 size);
        Ray ray(float x, float y) const;
        Ray ray(float x, float y, Vec2 lens) const;
        Vec3 project(Vec3 position) const;

    private:
        FlatScreen screen_;
    };
};

/// Distance of a perspective camera's screen, whose shorter side is 2 units long.
double screen_distance(const CameraData& camera);

}  // namespace lightnet
