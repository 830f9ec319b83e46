// What most surfaces are, many at once: meshes that reflect the same radiance into all directions, without bumps.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/math/columns.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/surfaces/flat_lamp.hpp"
#include "core/scene/surfaces/light_sample.hpp"
#include "core/scene/surfaces/ray.hpp"
#include "core/scene/surfaces/surface.hpp"
#include "core/scene/surfaces/triangle.hpp"

namespace lightnet {

class Shading;

/// A mesh that is an ideal diffuse (Lambertian) reflector, and is filled with nothing.
struct LambertianShape {
    const Mesh* mesh = nullptr;  // null: the shape is another
    Rgb albedo;
    const Shading* textured = nullptr;  // knows the albedo, which is not the same everywhere
    float least_offset = 0;             // by which rays must leave the shape, m
    bool one_sided = false;
    bool shines = false;  // emits light as well
};

/// Points of such shapes as a structure of arrays: each coordinate has a column of its own, for vectors of the
/// processor (SIMD). They are put there once and stay: points, shadow rays to a lamp and the next directions of paths
/// are worked out in loops without a branch, by the formulas of one point alone, to the bit.
class LambertianSurfaces {
public:
    std::size_t size() const { return count_; }
    bool full() const { return count_ == lanes; }
    void clear() { count_ = 0, textured_count_ = 0; }

    /// Adds the point of a hit on `shape`, seen from `outgoing`; there is room for it. `who`: the caller's.
    void add(std::uint32_t who, const LambertianShape& shape, const Hit& hit, Vec3 outgoing);
    /// Works out where the points are, and how they are turned: before anything of the following is asked.
    void find_points();

    std::uint32_t who(std::size_t i) const { return who_[i]; }
    Vec3 position(std::size_t i) const { return position_[i]; }
    Vec3 normal(std::size_t i) const { return normal_[i]; }
    Vec3 shading(std::size_t i) const { return shading_[i]; }
    Vec3 outgoing(std::size_t i) const { return outgoing_[i]; }
    Rgb albedo(std::size_t i) const { return {albedo_.x[i], albedo_.y[i], albedo_.z[i]}; }
    /// As of one alone; but the point knows nothing of textures, nor which shape it is of.
    SurfacePoint point(std::size_t i) const;
    Bsdf bsdf(std::size_t i) const;

    /// The random numbers that sample() or look_at() uses next.
    void set_numbers(std::size_t i, Vec2 u) { numbers_.set(i, u); }
    Vec2 numbers(std::size_t i) const { return numbers_[i]; }

    /// What Bsdf::sample() gives for each.
    struct Steps {
        Columns3 incoming;
        Column pdf;  // 0: none
    };
    const Steps& sample();
    Ray ray_from(std::size_t i, Vec3 direction) const {
        return {off_surface(position_[i], normal_[i], offset_[i], direction), direction};
    }

    /// What ray_to_lamp() gives for each, of the only lamp.
    struct RaysToLamp {
        Columns3 origin, direction, light;
        Column far;
        Flags found, group;
        Column lamp_pdf, pdf;  // where the light is whole: of the lamp, and of the surface
        Flags bare;            // the same: no ray can meet the lamp
    };
    const RaysToLamp& look_at(const FlatLamp& lamp, bool by_power);
    /// How that is weighted against finding the lamp by a direction.
    enum class Sharing { by_power, balanced, whole };
    /// The same without the weight that both techniques share by: the light is whole.
    const RaysToLamp& look_at_whole(const FlatLamp& lamp);
    /// The same of lamps that were sampled for each.
    const RaysToLamp& look_at(const LightSamples& lamps, bool by_power);
    const RaysToLamp& look_at_whole(const LightSamples& lamps);
    /// What was found last.
    const RaysToLamp& rays_to_lamp() const { return rays_; }

private:
    /// A point whose albedo depends on the place.
    struct Textured {
        std::size_t point;
        const Shading* shading;
        Hit hit;
    };
    void look_up_textures();
    struct Points;
    struct Sampling;
    template <Sharing sharing, bool parallelogram>
    struct Looking;
    template <Sharing sharing>
    struct LookingAtMany;
    template <Sharing sharing>
    const RaysToLamp& look(const FlatLamp& lamp);

    // All in one place, so that the compiler sees that no column is another.

    std::size_t count_ = 0;
    std::array<std::uint32_t, lanes> who_;
    Columns3 a_, b_, c_;  // corners
    Column u_, v_, least_offset_;
    Columns3 interpolated_, towards_;  // shading normals: there, and their sum over the corners; nothing: it has none
    Flags flip_, one_sided_;
    Columns3 outgoing_, albedo_;
    std::size_t textured_count_ = 0;
    std::array<Textured, lanes> textured_;

    Columns3 position_, normal_, shading_;
    Column offset_;
    Columns2 numbers_;
    Steps steps_;
    RaysToLamp rays_;
};

inline void LambertianSurfaces::add(std::uint32_t who, const LambertianShape& shape, const Hit& hit, Vec3 outgoing) {
    const std::size_t to = count_++;
    const Mesh& mesh = *shape.mesh;
    const auto [i, j, k] = mesh.triangles[hit.primitive];
    who_[to] = who;
    a_.set(to, mesh.positions[i]);
    b_.set(to, mesh.positions[j]);
    c_.set(to, mesh.positions[k]);
    u_[to] = hit.u;
    v_[to] = hit.v;
    least_offset_[to] = shape.least_offset;
    one_sided_[to] = shape.one_sided;
    outgoing_.set(to, outgoing);
    if (shape.textured)
        textured_[textured_count_++] = {to, shape.textured, hit};
    else
        albedo_.set(to, {shape.albedo.r, shape.albedo.g, shape.albedo.b});
    if (mesh.normals.empty()) {
        interpolated_.set(to, {});
        towards_.set(to, {});
        flip_[to] = mesh.flip_normals;
        return;
    }
    const Corners normals{mesh.normals[i], mesh.normals[j], mesh.normals[k]};
    interpolated_.set(to, on_triangle(normals, hit.u, hit.v));
    towards_.set(to, normals.a + normals.b + normals.c);
    flip_[to] = 0;
}

}  // namespace lightnet
