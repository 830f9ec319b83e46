// Motion in the picture, from frame to frame.
#pragma once

#include "core/base/math/vec.hpp"
#include "core/base/query.hpp"
#include "core/scene/camera/camera.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Of a scene whose data says what it is like one frame later (SceneData::next, CameraData::next); else nothing moves.
/// Keeps looking at the scene. Any thread may ask.
class ScreenMotion {
public:
    explicit ScreenMotion(const Scene& scene);

    /// Pixels to the right and upwards, from where the point of a question is seen as the shutter opens to where it is
    /// one frame later. 0 where it lies behind the eye at one of these times.
    Vec2 of(const Query& question) const;

private:
    /// In world space, or in that of its object.
    Vec3 later_on_shape(const SurfacePoint& point) const;

    const Scene& scene_;
    Camera now_, later_;
};

}  // namespace lightnet
