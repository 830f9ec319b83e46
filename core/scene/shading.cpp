#include "core/scene/shading.hpp"

#include "core/error.hpp"
#include "core/math/octahedral.hpp"
#include "core/math/random.hpp"
#include "core/math/sampling.hpp"
#include "core/scene/textures.hpp"
#include "core/scene/triangle.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lightnet {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // clang 14 can't find it out by itself

std::vector<TextureId> textures_of(const Metal& metal) {
    return metal.reflectance ? std::vector{*metal.reflectance} : std::vector{metal.eta, metal.k};
}

std::vector<TextureId> textures_of(const Material& material) {
    return std::visit(Overloaded{[](const DiffuseMaterial& m) { return std::vector{m.reflectance}; },
                                 [](const ConductorMaterial& m) { return textures_of(m.metal); },
                                 [](const DielectricMaterial&) { return std::vector<TextureId>{}; },
                                 [](const CoatedDiffuseMaterial& m) { return std::vector{m.reflectance}; },
                                 [](const CoatedConductorMaterial& m) { return textures_of(m.metal); },
                                 [](const PrincipledMaterial& m) { return std::vector{m.base_colour}; },
                                 [](const MixtureMaterial& m) { return std::vector{m.amount}; },
                                 [](const TwoFacedMaterial&) { return std::vector<TextureId>{}; },
                                 [](const NoMaterial&) { return std::vector<TextureId>{}; }},
                      material.model);
}

bool anisotropic(const Material& material) {
    return std::visit(
        [](const auto& m) {
            if constexpr (requires { m.roughness; }) return m.roughness.u != m.roughness.v;
            return false;
        },
        material.model);
}

float alpha_of(float value, Roughness::Means means) {
    switch (means) {
        case Roughness::Means::root:
            return std::sqrt(std::max(0.0f, value));
        case Roughness::Means::square:
            return value * value;
        default:
            return value;
    }
}

// Roughness of a surface that isn't a perfect mirror in both directions must not be one in either.
Ggx facets_of(const Roughness& roughness) {
    const float alpha_u = alpha_of(roughness.u, roughness.means), alpha_v = alpha_of(roughness.v, roughness.means);
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
    check_textures(data.textures);
    std::vector<Needs> of_material;
    for (const auto& material : data.materials) {
        Needs needs;
        needs.tangent = anisotropic(material);
        needs.holes = material.opacity || std::holds_alternative<NoMaterial>(material.model);
        auto used = textures_of(material);
        if (material.opacity) used.push_back(*material.opacity);
        for (const auto texture : used) {
            if (texture >= data.textures.size())
                throw Error("scene", "material '" + material.name + "' names a texture that isn't there");
            needs.uv |= !is_constant(data.textures[texture]);
        }
        of_material.push_back(needs);
        const auto* coated = std::get_if<CoatedDiffuseMaterial>(&material.model);
        const Ggx facets = coated ? facets_of(coated->roughness) : Ggx{};
        coats_.push_back(coated ? std::make_unique<Coat>(coated->eta, facets.alpha_u, facets.alpha_v) : nullptr);
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

TexturePlace Shading::place(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const {
    const auto* mesh = std::get_if<Mesh>(&data_.shapes[geometry].geometry);
    if (!mesh) return {on_sphere(std::get<Sphere>(data_.shapes[geometry].geometry), {true}, u, v).uv, {1, 1, 1}};
    const auto [i, j, k] = mesh->triangles[primitive];
    const float w = 1 - u - v;
    TexturePlace place;
    place.uv = mesh->uvs.empty() ? Vec2{u + v, v} : mesh->uvs[i] * w + mesh->uvs[j] * u + mesh->uvs[k] * v;
    if (!mesh->colours.empty())
        place.vertex_colour = mesh->colours[i] * w + mesh->colours[j] * u + mesh->colours[k] * v;
    return place;
}

float Shading::opacity_at(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const {
    const Material& material = data_.materials[data_.shapes[geometry].material];
    if (std::holds_alternative<NoMaterial>(material.model)) return 0;
    if (!material.opacity) return 1;
    const float opacity = look_up(data_.textures, *material.opacity, place(geometry, primitive, u, v)).r;
    if (material.opacity_cutoff > 0) return opacity >= material.opacity_cutoff ? 1 : 0;
    return std::min(opacity, 1.0f);
}

bool Shading::is_there(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const {
    const float opacity = opacity_at(geometry, primitive, u, v);
    if (opacity >= 1) return true;
    if (opacity <= 0) return false;
    const Key surface = child(child(0, geometry), primitive);
    const Key here =
        child(surface, std::uint64_t{std::bit_cast<std::uint32_t>(u)} << 32 | std::bit_cast<std::uint32_t>(v));
    return float(here >> 40) * 0x1p-24f < opacity;
}

Bsdf Shading::bsdf(const SurfacePoint& point) const {
    const std::uint32_t material = data_.shapes[point.geometry].material;
    if (const auto& plain = plain_[material]) return {point.shading, point.normal, *plain};
    return {point.shading, point.normal, model_at(material, point.uv)};
}

Bsdf::Model Shading::model_at(std::uint32_t material, Vec2 uv) const {
    const auto colour = [&](TextureId texture) { return look_up(data_.textures, texture, {uv, {1, 1, 1}}); };
    const auto albedo = [&](TextureId texture) {
        const Rgb c = colour(texture);
        return Rgb{std::min(1.0f, c.r), std::min(1.0f, c.g), std::min(1.0f, c.b)};
    };
    const auto metal = [&](const Metal& m, const Roughness& roughness) {
        const Ggx facets = facets_of(roughness);
        if (m.reflectance) return ConductorBsdf{{1, 1, 1}, absorption_for(colour(*m.reflectance)), facets};
        return ConductorBsdf{colour(m.eta), colour(m.k), facets};
    };
    return std::visit(
        Overloaded{[&](const DiffuseMaterial& m) -> Bsdf::Model { return DiffuseBsdf{albedo(m.reflectance)}; },
                   [&](const ConductorMaterial& m) -> Bsdf::Model { return metal(m.metal, m.roughness); },
                   [&](const DielectricMaterial& m) -> Bsdf::Model {
                       if (m.thin) return ThinDielectricBsdf{m.eta};
                       return DielectricBsdf{m.eta, facets_of(m.roughness)};
                   },
                   [&](const CoatedDiffuseMaterial& m) -> Bsdf::Model {
                       return CoatedDiffuseBsdf{albedo(m.reflectance), coats_[material].get()};
                   },
                   [&](const CoatedConductorMaterial& m) -> Bsdf::Model { return metal(m.metal, m.roughness); },
                   [&](const PrincipledMaterial& m) -> Bsdf::Model { return DiffuseBsdf{albedo(m.base_colour)}; },
                   [&](const MixtureMaterial& m) -> Bsdf::Model { return model_at(m.first, uv); },
                   [&](const TwoFacedMaterial& m) -> Bsdf::Model { return model_at(m.front, uv); },
                   [&](const NoMaterial&) -> Bsdf::Model { return ThinDielectricBsdf{1}; }},
        data_.materials[material].model);
}

}  // namespace lightnet
