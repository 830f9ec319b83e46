// Points of meshes, many at once.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/math/columns.hpp"
#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/shapes/ray.hpp"
#include "core/scene/surfaces/column_shape.hpp"
#include "core/scene/surfaces/surface.hpp"
#include "core/scene/surfaces/triangle.hpp"

namespace lightnet {

/// Shadow rays of many points: what ray_to_lamp() gives for each.
struct RaysToLamp {
    Columns3 origin, direction, light;
    Column far;
    Flags found, group;
    Column lamp_pdf, pdf;       // where the light is whole: of the lamp, and of the surface
    Flags bare, from_infinity;  // the same: as in LightSamples
};

/// Points as a structure of arrays: each coordinate has a column of its own, for vectors of the processor (SIMD). They
/// are put there once and stay: all is worked out in loops without a branch, by the formulas of one point alone, to the
/// bit.
class MeshPoints {
public:
    std::size_t size() const { return count_; }
    bool full() const { return count_ == lanes; }
    void clear() { count_ = shining_count_ = various_count_ = apart_count_ = 0; }

    std::uint32_t who(std::size_t i) const { return who_[i]; }
    /// Those that may be on a lamp.
    std::span<const std::uint32_t> shining() const { return std::span(shining_).first(shining_count_); }
    Vec3 position(std::size_t i) const { return position_[i]; }
    Vec3 normal(std::size_t i) const { return normal_[i]; }
    /// By bumps, too, which those of point() don't follow.
    Vec3 shading(std::size_t i) const { return shading_[i]; }
    Vec3 outgoing(std::size_t i) const { return outgoing_[i]; }
    ShutterTime time(std::size_t i) const { return hits_[i].time; }
    /// As of one alone; but the point knows nothing of textures.
    SurfacePoint point(std::size_t i) const;

    /// The random numbers that are used next.
    void set_numbers(std::size_t i, Vec2 u) { numbers_.set(i, u); }
    Vec2 numbers(std::size_t i) const { return numbers_[i]; }

    [[gnu::always_inline]] Ray ray_from(std::size_t i, Vec3 direction) const {
        return {off_surface(position_[i], normal_[i], offset_[i], direction), direction, Ray().far, hits_[i].time};
    }

protected:
    /// Adds the point of a hit on `shape`, seen from `outgoing`; there is room for it. `who`: the caller's.
    void add_point(std::uint32_t who, const ColumnShape& shape, const Hit& hit, Vec3 outgoing);
    /// Works out where the points are, and how they are turned.
    void find_places();
    /// look(i, place) of each whose shape is not the same everywhere, when what it reads of pictures has been fetched
    /// for all.
    template <class Look>
    void look_up(Look&& look) const;
    /// As ray_to_lamp(): the ray to the lamp of lamps_, and what light it brings where the surface sends on `value` of
    /// it, and this `part` of it is the lamp's to find.
    [[gnu::always_inline]] void set_ray_to_lamp(std::size_t i, Rgb value, float part);

    /// Where the light is whole: what its share follows from. `pdf`: of the surface.
    [[gnu::always_inline]] void set_densities(std::size_t i, float pdf) {
        rays_.lamp_pdf[i] = lamps_.pdf[i];
        rays_.pdf[i] = pdf;
        rays_.bare[i] = lamps_.bare[i];
        rays_.from_infinity[i] = lamps_.from_infinity[i];
    }

    // All in one place, so that the compiler sees that no column is another.

    std::size_t count_ = 0, shining_count_ = 0, various_count_ = 0, apart_count_ = 0;
    std::array<std::uint32_t, lanes> who_, shining_, various_;  // the latter: which, on shapes that have no one model
    std::array<std::uint32_t, lanes> apart_;                    // which are of instances, or have bumps
    std::array<const ColumnShape*, lanes> shapes_;
    std::array<Hit, lanes> hits_;
    Columns3 a_, b_, c_;  // corners
    Column u_, v_, least_offset_, turned_;
    Columns3 interpolated_, towards_;  // shading normals: there, and their sum over the corners; nothing: it has none
    Flags flip_, one_sided_;
    Columns3 outgoing_;

    Columns3 position_, normal_, shading_;
    Columns3 smooth_;  // shading normals without bumps, of those that have any
    Column offset_;
    Columns2 numbers_;
    LightSamples lamps_;  // that are looked at
    RaysToLamp rays_;

private:
    struct Places;
    void find_apart();
};

[[gnu::always_inline]] inline void MeshPoints::set_ray_to_lamp(std::size_t i, Rgb value, float part) {
    const Vec3 direction = lamps_.direction[i], origin = off_surface(position_[i], normal_[i], offset_[i], direction);
    const Rgb radiance{lamps_.radiance.x[i], lamps_.radiance.y[i], lamps_.radiance.z[i]};
    const Rgb arriving = value * radiance * (part / lamps_.pdf[i]);
    const Ray near = ray_between(origin, lamps_.position[i], direction);
    const bool infinite = lamps_.from_infinity[i] != 0;
    rays_.origin.set(i, origin);
    rays_.direction.set(i, {infinite ? direction.x : near.direction.x, infinite ? direction.y : near.direction.y,
                            infinite ? direction.z : near.direction.z});
    rays_.far[i] = infinite ? Ray().far : near.far;
    rays_.light.set(i, {arriving.r, arriving.g, arriving.b});
    rays_.group[i] = lamps_.group[i];
    rays_.found[i] = lamps_.found[i] & ((value.r != 0) | (value.g != 0) | (value.b != 0));
}

[[gnu::always_inline]] inline void MeshPoints::add_point(std::uint32_t who, const ColumnShape& shape, const Hit& hit,
                                                         Vec3 outgoing) {
    const std::size_t to = count_++;
    const Mesh& mesh = *shape.mesh;
    const auto [i, j, k] = mesh.triangles[hit.primitive];
    who_[to] = who;
    shapes_[to] = &shape;
    hits_[to] = hit;
    if (shape.shines) shining_[shining_count_++] = static_cast<std::uint32_t>(to);
    if (shape.bumpy || hit.instance != Query::no_instance) apart_[apart_count_++] = static_cast<std::uint32_t>(to);
    if (!shape.model) various_[various_count_++] = static_cast<std::uint32_t>(to);
    a_.set(to, mesh.positions[i]);
    b_.set(to, mesh.positions[j]);
    c_.set(to, mesh.positions[k]);
    u_[to] = hit.u;
    v_[to] = hit.v;
    least_offset_[to] = shape.least_offset;
    turned_[to] = shape.turned ? shape.turned[hit.primitive] : 0;
    one_sided_[to] = shape.one_sided;
    outgoing_.set(to, outgoing);
    if (mesh.normals.empty()) {
        interpolated_.set(to, {});
        towards_.set(to, {});
        flip_[to] = mesh.flip_normals;
        return;
    }
    const Corners normals{mesh.normals[i], mesh.normals[j], mesh.normals[k]};
    interpolated_.set(to, between_corners(normals, hit.u, hit.v));
    towards_.set(to, normals.a + normals.b + normals.c);
    flip_[to] = 0;
}

}  // namespace lightnet
