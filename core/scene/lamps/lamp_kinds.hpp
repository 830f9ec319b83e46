// Lamps by the kinds of shapes that shine: points on them, bounds and densities.
#pragma once

#include <optional>
#include <variant>

#include "core/base/math/vec.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/lamps/ball_lamp.hpp"
#include "core/scene/lamps/lamp_radiance.hpp"
#include "core/scene/lamps/lamp_sources.hpp"
#include "core/scene/lamps/light_tree.hpp"
#include "core/scene/surfaces/flat_lamp.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

// A kind of shape that shines has each of these functions: what lacks one does not compile. A mesh has its triangles in
// LampSources.

/// A ball around all of it.
struct LampBall {
    Vec3 center;
    float radius;
};
LampBall ball_around(const Sphere* ball);
LampBall ball_around(const PlacedQuadric& quadric);
LampBall ball_around(const Curves* curves);

/// m².
float area_of(const Sphere* ball);
float area_of(const PlacedQuadric& quadric);
float area_of(const Curves* curves);

/// The place where a light path begins: `area` is that of the lamp as if all of it were as stretched as there, m².
struct LampStart {
    PointOnLamp point;
    float area;
};
LampStart start_on(const AreaLamp& lamp, const Mesh* mesh, Vec2 u);
LampStart start_on(const AreaLamp& lamp, const Sphere* ball, Vec2 u);
LampStart start_on(const AreaLamp& lamp, const PlacedQuadric& quadric, Vec2 u);
LampStart start_on(const AreaLamp& lamp, const Curves* curves, Vec2 u);

/// A point that is looked at from elsewhere. None: it sends no light there.
struct LampLook {
    const LampRadiance& radiance;
    Vec3 from;
    Vec2 u;
};
std::optional<LightSample> sample_on(const LampLook& look, const AreaLamp& lamp, const Mesh* mesh);
std::optional<LightSample> sample_on(const LampLook& look, const AreaLamp& lamp, const Sphere* ball);
std::optional<LightSample> sample_on(const LampLook& look, const AreaLamp& lamp, const PlacedQuadric& quadric);
std::optional<LightSample> sample_on(const LampLook& look, const AreaLamp& lamp, const Curves* curves);

/// A uniform triangle or parallelogram, or a uniform ball, which many points can look at at once; or nothing of the
/// kind.
using EvenLamp = std::variant<std::monostate, FlatLamp, BallLamp>;
EvenLamp even_on(const AreaLamp& lamp, const Mesh* mesh);
EvenLamp even_on(const AreaLamp& lamp, const Sphere* ball);
EvenLamp even_on(const AreaLamp& lamp, const PlacedQuadric& quadric);
EvenLamp even_on(const AreaLamp& lamp, const Curves* curves);

/// `radiance`: its mean over the lamp.
LightBounds bounds_of(const AreaLamp& lamp, const Mesh* mesh, float radiance);
LightBounds bounds_of(const AreaLamp& lamp, const Sphere* ball, float radiance);
LightBounds bounds_of(const AreaLamp& lamp, const PlacedQuadric& quadric, float radiance);
LightBounds bounds_of(const AreaLamp& lamp, const Curves* curves, float radiance);

/// A point of a lamp that a ray has found, and the density with which sample_on() finds it, per steradian.
struct LampFound {
    Vec3 from, direction;
    const SurfacePoint& on;
    float area;  // m², of the lamp
    bool two_sided;

    float way2() const { return length_squared(on.position - from); }
};
float density(const Mesh* mesh, const LampFound& found);
float density(const Sphere* ball, const LampFound& found);
float density(const PlacedQuadric& quadric, const LampFound& found);
float density(const Curves* curves, const LampFound& found);

}  // namespace lightnet
