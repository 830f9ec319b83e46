// A round surface where it stands.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "core/base/math/box.hpp"
#include "core/base/math/octahedral.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/shapes/quadric.hpp"

namespace lightnet {

/// A quadric with what its transform needs: rays meet it, points are named and found again. Its own space is that of
/// Quadric. A point's name is, on a disk, its own x and y; on a cylinder its direction from the axis by the quarters of
/// a square (0 … 4, less 2) and its own z; on a sphere its octahedral normal.
class PlacedQuadric {
public:
    /// Keeps looking at it.
    explicit PlacedQuadric(const Quadric& quadric);

    /// Can it be met at all? Else its transform is singular, or not finite.
    bool usable() const { return usable_; }
    const Quadric& quadric() const { return quadric_; }

    /// Calls `accept(distance, name)` with each point in (near, far) at which a ray meets it, in order, until it
    /// returns true. In double: single precision loses too much near the surface that a ray leaves.
    template <class Accept>
    void meet(Vec3 origin, Vec3 direction, float near, float far, Accept accept) const;

    /// The point of that name in its own space, and back.
    Vec3 own_point(Vec2 name) const;
    Vec2 name_of(Vec3 own) const;
    /// A point of the world that is nowhere near it has a name, too: of what is near in its own space.
    Vec2 name_near(Vec3 position) const;
    Vec3 position(Vec3 own) const;
    /// Unit, in the world, on the side where a lamp shines.
    Vec3 normal(Vec3 own) const;
    /// What its own space rounds along that normal, wherever it stands: own part of an offset, m.
    float own_offset(Vec3 own, Vec3 normal) const;
    Vec2 uv(Vec3 own) const;
    /// ∂position/∂u and ∂position/∂v.
    struct Along {
        Vec3 u, v;
    };
    Along along(Vec3 own) const;

    Vec3 point_to_own(Vec3 position) const;
    Vec3 direction_to_own(Vec3 direction) const;
    /// Of the transform, its absolute value.
    double volume() const { return volume_; }
    /// Area of the world per area of its own space.
    float stretch(Vec3 own) const;
    float own_area() const;
    /// m²
    float area() const;
    /// Is it all that its kind has?
    bool whole() const;
    /// A point that is uniform by area in its own space.
    Vec3 own_uniform(Vec2 u) const;

    Box bounds() const;

private:
    using Wide = std::array<double, 3>;
    Wide wide_to_own(Vec3 v, bool point) const;
    bool is_part(const Wide& own) const;
    Vec2 name_of(const Wide& own) const;
    Vec3 own_normal(Vec3 own) const;
    Vec3 out_of_own(Vec3 direction) const;

    const Quadric& quadric_;
    std::array<std::array<double, 3>, 3> inverse_{}, cofactors_{};
    double volume_ = 0;
    float size_ = 0;  // m
    double end_ = 4;  // of the turn, in quarters of a square
    bool usable_ = false;
};

/// Which quarter of a square around the origin, and how far along it: 0 … 4 from +x towards +y.
inline double square_angle(double x, double y) {
    const double size = std::fabs(x) + std::fabs(y);
    if (!(size > 0)) return 0;
    return y >= 0 ? 1 - x / size : 3 + x / size;
}

template <class Accept>
void PlacedQuadric::meet(Vec3 origin, Vec3 direction, float near, float far, Accept accept) const {
    const Wide o = wide_to_own(origin, true), d = wide_to_own(direction, false);
    const auto offer = [&](double t) {
        if (!(t > near && t < far)) return false;
        const Wide own{o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
        return is_part(own) && accept(float(t), name_of(own));
    };
    if (quadric_.round == Quadric::Round::disk) {
        if (d[2] != 0) offer(-o[2] / d[2]);
        return;
    }
    const double round = quadric_.round == Quadric::Round::sphere ? 1 : 0;
    const double a = d[0] * d[0] + d[1] * d[1] + round * d[2] * d[2];
    if (!(a > 0)) return;
    const double s = (o[0] * d[0] + o[1] * d[1] + round * o[2] * d[2]) / a;
    const double lx = o[0] - s * d[0], ly = o[1] - s * d[1], lz = round * (o[2] - s * d[2]);  // the line's middle
    const double rest = 1 - (lx * lx + ly * ly + lz * lz);
    if (!(rest >= 0)) return;
    const double half_chord = std::sqrt(rest / a);
    if (!offer(-s - half_chord)) offer(-s + half_chord);
}

}  // namespace lightnet
