#include "core/scene/shading.hpp"

#include "core/error.hpp"
#include "core/math/octahedral.hpp"
#include "core/math/sampling.hpp"
#include "core/scene/textures.hpp"
#include "core/scene/triangle.hpp"

#include <algorithm>
#include <cmath>

namespace lightnet {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // clang 14 can't find it out by itself

std::vector<TextureId> textures_of(const Material& material) {
    return std::visit(Overloaded{[](const DiffuseMaterial& m) { return std::vector{m.reflectance}; },
                                 [](const ConductorMaterial& m) {
                                     return m.reflectance ? std::vector{*m.reflectance} : std::vector{m.eta, m.k};
                                 },
                                 [](const DielectricMaterial&) { return std::vector<TextureId>{}; },
                                 [](const ThinDielectricMaterial&) { return std::vector<TextureId>{}; },
                                 [](const CoatedDiffuseMaterial& m) { return std::vector{m.reflectance}; }},
                      material.model);
}

bool anisotropic(const Material& material) {
    return std::visit(
        [](const auto& m) {
            if constexpr (requires { m.alpha_u; }) return m.alpha_u != m.alpha_v;
            return false;
        },
        material.model);
}

// Roughness of a surface that isn't a perfect mirror in both directions must not be one in either.
Ggx facets_of(float alpha_u, float alpha_v) {
    if (is_specular(alpha_u, alpha_v)) return {};
    return {std::max(alpha_u, specular_alpha), std::max(alpha_v, specular_alpha)};
}

float largest(Vec3 v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

// Rounding of a point grows with the coordinates of the shape: fully for spheres, far less for triangles.
float least_offset(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
        return 0x1p-20f * (largest(sphere->center) + sphere->radius);
    float reach = 0;
    for (const Vec3 p : std::get<Mesh>(shape.geometry).positions) reach = std::max(reach, largest(p));
    return 0x1p-21f * reach;
}

// The frame around `z` whose x axis lies along `tangent`.
Frame frame_along(Vec3 z, Vec3 tangent) {
    const Vec3 x = tangent - z * dot(z, tangent);
    const float size = length(x);
    if (!(size > 1e-12f)) return Frame::around(z);
    return {x / size, cross(z, x / size), z};
}

// ∂p/∂u of a triangle. Without texture coordinates it is the one that pbrt assumes.
Vec3 tangent_of(const Corners& t, Vec2 a, Vec2 b, Vec2 c) {
    const float du1 = a.x - c.x, du2 = b.x - c.x, dv1 = a.y - c.y, dv2 = b.y - c.y;
    const float determinant = du1 * dv2 - dv1 * du2;
    if (std::fabs(determinant) < 1e-12f) return {};
    return ((t.a - t.c) * dv2 - (t.b - t.c) * dv1) / determinant;
}

}  // namespace

Shading::Shading(const SceneData& data) : data_(data) {
    std::vector<Needs> of_material;
    for (const auto& material : data.materials) {
        Needs needs{false, anisotropic(material)};
        for (const auto texture : textures_of(material)) {
            if (texture >= data.textures.size())
                throw Error("scene", "material '" + material.name + "' names a texture that isn't there");
            needs.uv |= data.textures[texture].image != nullptr;
        }
        of_material.push_back(needs);
        const auto* coated = std::get_if<CoatedDiffuseMaterial>(&material.model);
        coats_.push_back(coated ? std::make_unique<Coat>(coated->eta, coated->alpha_u, coated->alpha_v) : nullptr);
    }
    for (std::uint32_t i = 0; i < data.materials.size(); ++i)
        plain_.push_back(of_material[i].uv ? std::nullopt : std::optional(model_at(i, {})));
    for (const auto& shape : data.shapes) {
        needs_.push_back(of_material[shape.material]);
        needs_.back().offset = least_offset(shape);
    }
}

SurfacePoint Shading::point(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const {
    const Shape& shape = data_.shapes[geometry];
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    SurfacePoint point = mesh ? on_mesh(*mesh, needs_[geometry], primitive, u, v)
                              : on_sphere(std::get<Sphere>(shape.geometry), needs_[geometry], u, v);
    point.geometry = geometry;
    point.primitive = primitive;
    return point;
}

SurfacePoint Shading::on_mesh(const Mesh& mesh, Needs needs, std::uint32_t primitive, float u, float v) const {
    const auto [i, j, k] = mesh.triangles[primitive];
    const Corners at = corners(mesh, primitive);
    const float w = 1 - u - v;
    SurfacePoint point;
    point.position = at.a * w + at.b * u + at.c * v;
    point.normal = geometric_normal(mesh, primitive, at);
    point.offset = std::max(0x1p-16f * largest(point.position), needs.offset);

    Vec3 shading = point.normal;
    if (!mesh.normals.empty()) {
        const Vec3 n = mesh.normals[i] * w + mesh.normals[j] * u + mesh.normals[k] * v;
        const float size = length(n);
        if (size > 0) shading = dot(n, point.normal) < 0 ? -n / size : n / size;
    }
    const bool mapped = !mesh.uvs.empty();
    const Vec2 a = mapped ? mesh.uvs[i] : Vec2{0, 0}, b = mapped ? mesh.uvs[j] : Vec2{1, 0},
               c = mapped ? mesh.uvs[k] : Vec2{1, 1};
    if (needs.uv) point.uv = a * w + b * u + c * v;
    point.shading = needs.tangent ? frame_along(shading, tangent_of(at, a, b, c)) : Frame::around(shading);
    return point;
}

SurfacePoint Shading::on_sphere(const Sphere& sphere, Needs needs, float u, float v) const {
    const Vec3 outwards = from_octahedral({u, v});
    SurfacePoint point;
    point.position = sphere.center + outwards * sphere.radius;
    point.normal = sphere.flip_normals ? -outwards : outwards;
    point.offset = needs.offset;
    point.shading = Frame::around(point.normal);
    if (!needs.uv && !needs.tangent) return point;

    // The columns of the rotation are the sphere's own axes.
    const auto axis = [&](std::size_t i) {
        const auto& m = sphere.to_world.m;
        return normalize({float(m[0][i]), float(m[1][i]), float(m[2][i])});
    };
    const Vec3 own{dot(axis(0), outwards), dot(axis(1), outwards), dot(axis(2), outwards)};
    float turn = std::atan2(own.y, own.x);
    if (turn < 0) turn += 2 * pi;
    point.uv = {turn / (2 * pi), 1 - std::acos(std::clamp(own.z, -1.0f, 1.0f)) / pi};
    if (needs.tangent) point.shading = frame_along(point.normal, axis(1) * own.x - axis(0) * own.y);
    return point;
}

Bsdf Shading::bsdf(const SurfacePoint& point) const {
    const std::uint32_t material = data_.shapes[point.geometry].material;
    if (const auto& plain = plain_[material]) return {point.shading, point.normal, *plain};
    return {point.shading, point.normal, model_at(material, point.uv)};
}

Bsdf::Model Shading::model_at(std::uint32_t material, Vec2 uv) const {
    const auto colour = [&](TextureId texture) { return look_up(data_.textures[texture], uv); };
    const auto albedo = [&](TextureId texture) {
        const Rgb c = colour(texture);
        return Rgb{std::min(1.0f, c.r), std::min(1.0f, c.g), std::min(1.0f, c.b)};
    };
    return std::visit(
        Overloaded{[&](const DiffuseMaterial& m) -> Bsdf::Model { return DiffuseBsdf{albedo(m.reflectance)}; },
                   [&](const ConductorMaterial& m) -> Bsdf::Model {
                       const Ggx facets = facets_of(m.alpha_u, m.alpha_v);
                       if (m.reflectance)
                           return ConductorBsdf{{1, 1, 1}, absorption_for(colour(*m.reflectance)), facets};
                       return ConductorBsdf{colour(m.eta), colour(m.k), facets};
                   },
                   [&](const DielectricMaterial& m) -> Bsdf::Model {
                       return DielectricBsdf{m.eta, facets_of(m.alpha_u, m.alpha_v)};
                   },
                   [&](const ThinDielectricMaterial& m) -> Bsdf::Model { return ThinDielectricBsdf{m.eta}; },
                   [&](const CoatedDiffuseMaterial& m) -> Bsdf::Model {
                       return CoatedDiffuseBsdf{albedo(m.reflectance), coats_[material].get()};
                   }},
        data_.materials[material].model);
}

}  // namespace lightnet
