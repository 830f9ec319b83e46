// The members of all that light can meet, listed once: for what has to look at each of them.
//
// Each list takes its type apart completely, so that a new member which nobody thought of here doesn't compile. Names,
// and where in its file something stands, are no concern of light's.
#pragma once

#include <concepts>
#include <type_traits>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// T, const or not.
template <class Any, class T>
concept Is = std::same_as<std::remove_const_t<Any>, T>;

void visit_members(Is<UvTransform> auto& uv, const auto& visit) {
    auto& [scale, offset, turn] = uv;
    visit(scale, offset, turn);
}
void visit_members(Is<ImageTexture> auto& texture, const auto& visit) {
    auto& [image, wrap_u, wrap_v, uv, channel, nearest] = texture;
    visit(image, wrap_u, wrap_v, uv, channel, nearest);
}
void visit_members(Is<CheckerTexture> auto& texture, const auto& visit) {
    auto& [even, odd, uv] = texture;
    visit(even, odd, uv);
}
void visit_members(Is<ProductTexture> auto& texture, const auto& visit) {
    auto& [first, second] = texture;
    visit(first, second);
}
void visit_members(Is<MixTexture> auto& texture, const auto& visit) {
    auto& [first, second, amount] = texture;
    visit(first, second, amount);
}
void visit_members(Is<VertexColour> auto&, const auto&) { static_assert(std::is_empty_v<VertexColour>); }
void visit_members(Is<Texture> auto& texture, const auto& visit) {
    auto& [scale, pattern, invert] = texture;
    visit(scale, pattern, invert);
}

void visit_members(Is<Roughness> auto& roughness, const auto& visit) {
    auto& [u, v, texture, means] = roughness;
    visit(u, v, texture, means);
}
void visit_members(Is<Metal> auto& metal, const auto& visit) {
    auto& [eta, k, reflectance] = metal;
    visit(eta, k, reflectance);
}
void visit_members(Is<DiffuseMaterial> auto& material, const auto& visit) {
    auto& [reflectance, sigma, transmittance] = material;
    visit(reflectance, sigma, transmittance);
}
void visit_members(Is<ConductorMaterial> auto& material, const auto& visit) {
    auto& [metal, roughness, tint] = material;
    visit(metal, roughness, tint);
}
void visit_members(Is<DielectricMaterial> auto& material, const auto& visit) {
    auto& [eta, roughness, reflected, transmitted, thin] = material;
    visit(eta, roughness, reflected, transmitted, thin);
}
void visit_members(Is<CoatLayer> auto& layer, const auto& visit) {
    auto& [thickness, bounces] = layer;
    visit(thickness, bounces);
}
void visit_members(Is<CoatedDiffuseMaterial> auto& material, const auto& visit) {
    auto& [reflectance, eta, roughness, tint, base_colours_repeat, layer] = material;
    visit(reflectance, eta, roughness, tint, base_colours_repeat, layer);
}
void visit_members(Is<CoatedConductorMaterial> auto& material, const auto& visit) {
    auto& [metal, roughness, coat_eta, coat, layer] = material;
    visit(metal, roughness, coat_eta, coat, layer);
}
void visit_members(Is<PrincipledMaterial> auto& material, const auto& visit) {
    auto& [base_colour, metallic, transmission, metallic_texture, transmission_texture, roughness, eta, specular,
           specular_colour, specular_texture, specular_colour_texture, sheen, sheen_roughness, sheen_colour,
           sheen_texture, sheen_roughness_texture, clearcoat, clearcoat_texture, clearcoat_roughness, thin] = material;
    visit(base_colour, metallic, transmission, metallic_texture, transmission_texture, roughness, eta, specular,
          specular_colour, specular_texture, specular_colour_texture, sheen, sheen_roughness, sheen_colour,
          sheen_texture, sheen_roughness_texture, clearcoat, clearcoat_texture, clearcoat_roughness, thin);
}
void visit_members(Is<MixtureMaterial> auto& material, const auto& visit) {
    auto& [first, second, amount] = material;
    visit(first, second, amount);
}
void visit_members(Is<TwoFacedMaterial> auto& material, const auto& visit) {
    auto& [front, back] = material;
    visit(front, back);
}
void visit_members(Is<NoMaterial> auto&, const auto&) { static_assert(std::is_empty_v<NoMaterial>); }
void visit_members(Is<Material> auto& material, const auto& visit) {
    auto& [name, model, one_sided, opacity, opacity_cutoff, normal_map, normal_scale, bump_map, absorption] = material;
    visit(model, one_sided, opacity, opacity_cutoff, normal_map, normal_scale, bump_map, absorption);
}

void visit_members(Is<AreaEmission> auto& emission, const auto& visit) {
    auto& [radiance, two_sided, texture] = emission;
    visit(radiance, two_sided, texture);
}
void visit_members(Is<Mesh> auto& mesh, const auto& visit) {
    auto& [positions, normals, uvs, colours, triangles, flip_normals] = mesh;
    visit(positions, normals, uvs, colours, triangles, flip_normals);
}
void visit_members(Is<Sphere> auto& sphere, const auto& visit) {
    auto& [center, radius, flip_normals, to_world] = sphere;
    visit(center, radius, flip_normals, to_world);
}
void visit_members(Is<Shape> auto& shape, const auto& visit) {
    auto& [geometry, material, emission, where, name] = shape;
    visit(geometry, material, emission);
}
void visit_members(Is<Object> auto& object, const auto& visit) {
    auto& [name, shapes] = object;
    visit(shapes);
}
void visit_members(Is<Instance> auto& instance, const auto& visit) {
    auto& [object, to_world] = instance;
    visit(object, to_world);
}

void visit_members(Is<EnvironmentData> auto& environment, const auto& visit) {
    auto& [radiance, image, layout, to_world] = environment;
    visit(radiance, image, layout, to_world);
}
void visit_members(Is<PointLight> auto& light, const auto& visit) {
    auto& [position, intensity] = light;
    visit(position, intensity);
}
void visit_members(Is<SpotLight> auto& light, const auto& visit) {
    auto& [position, axis, intensity, inner, outer, falloff] = light;
    visit(position, axis, intensity, inner, outer, falloff);
}
void visit_members(Is<DirectionalLight> auto& light, const auto& visit) {
    auto& [direction, irradiance] = light;
    visit(direction, irradiance);
}

/// Without those who look (camera, film), and without what was said or learnt of it.
void visit_members(Is<SceneData> auto& scene, const auto& visit) {
    auto& [shapes, objects, instances, materials, textures, environments, lights, camera, camera_given, film,
           warnings] = scene;
    visit(shapes, objects, instances, materials, textures, environments, lights);
}

}  // namespace lightnet
