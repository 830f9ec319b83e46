// A scene with surfaces of all kinds, for tests of what is worked out for many points at once.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::test {

inline constexpr std::uint32_t flake = 10;  // which shape of everything() has no area
// A wavy sheet: its shading normals are far from its geometric ones, and turn away from some who see it.
inline Mesh waves() {
    Mesh mesh;
    constexpr std::uint32_t side = 6;
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x) {
            const float a = float(x) - 3, b = float(y) - 3;
            mesh.positions.push_back({a, b, 0.8f * std::sin(2 * a) * std::cos(b)});
            mesh.normals.push_back(normalize({-std::sin(a), std::cos(3 * b), 0.4f}));
        }
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t at = y * (side + 1) + x;
            mesh.triangles.push_back({at, at + 1, at + side + 1});
            mesh.triangles.push_back({at + 1, at + side + 2, at + side + 1});
        }
    return mesh;
}

// Smooth and rough ones, of all shares of metal, with a coat and without.
inline void add_principled(SceneData& data, TextureId paint) {
    const auto add_one = [&](float x, auto&& change) {
        PrincipledMaterial model;
        change(model);
        Mesh mesh = waves();
        for (Vec3& p : mesh.positions) {
            p.x += x;
            mesh.colours.push_back({std::fabs(p.z), 0.5f, std::fabs(p.y) / 3});
        }
        add(data, mesh, material(data, model));
    };
    const auto pink = colour(data, {0.9f, 0.5f, 0.6f});
    add_one(0.5f, [&](PrincipledMaterial& m) { m.base_colour = pink; });
    add_one(1, [&](PrincipledMaterial& m) { m.base_colour = paint, m.metallic = 0.6f, m.clearcoat = 0.5f; });
    add_one(1.5f, [&](PrincipledMaterial& m) {
        m.base_colour = pink, m.metallic = 1, m.metallic_texture = paint, m.roughness.texture = paint;
    });
    add_one(2, [&](PrincipledMaterial& m) {
        m.base_colour = paint, m.clearcoat = 1, m.clearcoat_roughness = {0.4f, 0.4f}, m.specular = 0.4f;
    });
    add_one(2.5f, [&](PrincipledMaterial& m) {
        m.base_colour = pink, m.roughness = {0, 0}, m.clearcoat = 0.3f, m.clearcoat_roughness = {0.2f, 0.2f};
    });
    add_one(-0.5f, [&](PrincipledMaterial& m) { m.base_colour = paint, m.roughness = {0, 0}; });
    add_one(-1, [&](PrincipledMaterial& m) { m.base_colour = pink, m.sheen = 1; });
    add_one(-1.5f, [&](PrincipledMaterial& m) { m.base_colour = pink, m.transmission = 1; });
    add_one(-2, [&](PrincipledMaterial& m) { m.base_colour = pink, m.metallic = 1, m.roughness = {0, 0}; });
    add_one(-2.5f, [&](PrincipledMaterial& m) { m.base_colour = pink, m.film.share = 1; });
    add_one(-3, [&](PrincipledMaterial& m) { m.base_colour = paint, m.translucence.share = 0.5f; });
    add_one(3, [&](PrincipledMaterial& m) { m.base_colour = pink, m.metallic = 1, m.grooves.strength = 0.8f; });
}

inline TextureId squares(SceneData& data, Rgb one, Rgb other) {
    const auto first = colour(data, one), second = colour(data, other);
    data.textures.emplace_back().pattern = CheckerTexture{first, second, {{7, 5}}};
    return TextureId(data.textures.size() - 1);
}

// Laid on second texture coordinates.
inline void add_second(SceneData& data, TextureId pattern) {
    data.textures.emplace_back().pattern = OtherUvTexture{pattern};
    Mesh mesh = waves();
    mesh.values.uvs.resize(1);
    for (Vec3& p : mesh.positions) {
        mesh.uvs.push_back({0.5f, 0.5f});
        mesh.values.uvs[0].push_back({p.x / 4, p.y / 3});
        p.x -= 3.5f;
    }
    add(data, mesh, material(data, DiffuseMaterial{TextureId(data.textures.size() - 1)}));
}

// With normal and bump maps, some of which would turn normals away from their surfaces.
inline void add_bumpy(SceneData& data, std::uint32_t plain, std::uint32_t gloss, std::uint32_t still_a_mirror) {
    const auto normals = squares(data, {0.6f, 0.3f, 0.9f}, {0.1f, 0.9f, 0.5f});
    const auto heights = squares(data, {0, 0, 0}, {1, 1, 1});
    for (const std::uint32_t smooth : {plain, gloss, still_a_mirror})
        for (const bool by_height : {false, true}) {
            Material bumpy = data.materials[smooth];
            if (by_height)
                bumpy.bump_map = heights;
            else
                bumpy.normal_map = NormalMap{normals};
            data.materials.push_back(bumpy);
            Mesh mesh = waves();
            for (Vec3& p : mesh.positions) {
                mesh.uvs.push_back({p.y / 3, p.x / 4});
                p.y += 0.3f * float(data.materials.size() % 5);
            }
            add(data, mesh, std::uint32_t(data.materials.size() - 1));
        }
}

// Patterns that follow from where points lie, and how they are turned.
inline TextureId solid(SceneData& data) {
    const auto red = colour(data, {0.8f, 0.2f, 0.1f});
    Matrix twice;
    for (std::size_t i = 0; i < 3; ++i) twice.m[i][i] = 2;
    const auto pattern = [&](const auto& made) {
        data.textures.emplace_back().pattern = made;
        return TextureId(data.textures.size() - 1);
    };
    const auto creases = pattern(NoiseTexture{NoiseTexture::Kind::turbulence, 4, 0.5f, twice});
    const auto cubes = pattern(CubesTexture{red, creases, twice});
    const auto around =
        pattern(ProjectedTexture{squares(data, {0, 0, 1}, {0, 1, 0}), ProjectedTexture::By::sphere, {}});
    return pattern(DirectionTexture{cubes, around, {0.6f, 0, 0.8f}});
}

// Meshes with and without normals, flipped ones, ones with textures and vertex colours, triangles without area, balls
// and instances; surfaces that are diffuse, coated, black from behind,
// metals, mirrors, glass, principled and blends; some with bumps.
inline SceneData everything() {
    SceneData data;
    const auto grey = diffuse(data, 0.5f), steel = mirror(data, 0.8f);
    const auto brown = material(data, DiffuseMaterial{colour(data, {0.6f, 0.4f, 0.2f})});
    const auto dark_behind = diffuse(data, 0.7f);
    data.materials[dark_behind].one_sided = true;
    const auto blend = material(data, MixtureMaterial{brown, steel, colour(data, {0.3f, 0.3f, 0.3f})});
    const auto glass = material(data, DielectricMaterial{});
    data.materials[glass].absorption = {1, 2, 3};
    data.textures.emplace_back().pattern = VertexColour{};
    const auto painted = material(data, DiffuseMaterial{TextureId(data.textures.size() - 1)});

    const TextureId paint(data.textures.size() - 1);
    const auto raised = [](float by) {
        Mesh mesh = waves();
        for (Vec3& p : mesh.positions) {
            p.z += by;
            mesh.colours.push_back({std::fabs(p.x) / 3, 0.5f, std::fabs(p.y) / 3});
        }
        return mesh;
    };
    const Roughness satin{0.3f, 0.3f}, grooved{0.3f, 0.1f};
    Roughness by_beckmann = satin, apart = satin;
    by_beckmann.law.normals = FacetLaw::Normals::beckmann;
    apart.law.masking = FacetLaw::Masking::independent;
    const auto eta = colour(data, {0.2f, 0.9f, 1.5f}), k = colour(data, {3.9f, 2.4f, 1.9f});
    add(data, raised(-2), material(data, CoatedDiffuseMaterial{colour(data, {0.7f, 0.5f, 0.1f}), 1.5f, satin}));
    add(data, raised(1.5f), material(data, CoatedDiffuseMaterial{paint, 1.7f, apart, paint, false, {0.1f, 5}}));
    add(data, raised(-1.5f), material(data, CoatedDiffuseMaterial{paint, 1.4f, {}}));
    add(data, raised(2), material(data, CoatedDiffuseMaterial{paint, 1.4f, by_beckmann}));
    const auto copper = material(data, ConductorMaterial{{eta, k}, satin});
    data.materials[copper].one_sided = true;
    add(data, raised(0.5f), copper);
    add(data, raised(-0.5f), material(data, ConductorMaterial{{eta, k}, apart, paint}));
    add(data, raised(2.5f), material(data, ConductorMaterial{{eta, k}, grooved}));
    add(data, waves(), brown);
    Mesh flat = waves();
    flat.normals.clear();
    flat.flip_normals = true;
    for (Vec3& p : flat.positions) p.z -= 1;
    add(data, flat, dark_behind);
    Mesh bright = waves();
    for (Vec3& p : bright.positions) {
        p.z += 1;
        bright.colours.push_back({std::fabs(p.x) / 3, std::fabs(p.y) / 3, 0.5f});
        bright.uvs.push_back({p.x, p.y});
    }
    add(data, bright, painted);
    Mesh nothing = quad({0, 0, -3}, {0, 0, 0}, {2, 0, 0});  // no area
    add(data, nothing, grey);
    add(data, ball({1, 2, 0}, 0.7f), brown);
    add(data, ball({-1, 1, 0}, 0.5f), glass);
    add(data, quad({-3, -3, 2}, {6, 0, 0}, {0, 6, 0}), blend);
    add(data, quad({-3, -3, -2}, {6, 0, 0}, {0, 6, 0}), steel);
    add(data, raised(-2.5f), material(data, ConductorMaterial{{eta, k}, by_beckmann, paint}));
    add_principled(data, paint);
    add_bumpy(data, grey, copper, steel);
    add_second(data, squares(data, {0.7f, 0.1f, 0.3f}, {0.2f, 0.8f, 0.4f}));
    const TextureId veined = solid(data);
    const auto stone = material(data, DiffuseMaterial{veined});
    Mesh rough = raised(3);
    data.materials[material(data, CoatedDiffuseMaterial{veined, 1.5f, satin})].bump_map = veined;
    add(data, rough, std::uint32_t(data.materials.size() - 1));
    add(data, raised(-3), stone);
    const auto part = std::uint32_t(data.shapes.size());
    add(data, waves(), dark_behind);
    Mesh tile = waves();
    for (Vec3& p : tile.positions) tile.uvs.push_back({p.x, p.y});
    const auto carved = material(data, PrincipledMaterial{});
    data.materials[carved].bump_map = squares(data, {0.1f, 0.2f, 0.3f}, {0.9f, 0.2f, 0.1f});
    add(data, tile, carved);
    add(data, raised(0.2f), stone);
    data.objects.push_back({"waves", {part, part + 1, part + 2}});
    Matrix upright;
    upright.m = {{{0, 0, 1, 2}, {0, 2, 0, 0}, {-1, 0, 0, 1}, {0, 0, 0, 1}}};
    data.instances.push_back({0, upright});
    return data;
}

inline constexpr std::size_t many = 2000;  // not a multiple of anything

// Of everything(), where rays from anywhere come to.
inline std::vector<Hit> some_hits(const Scene& scene) {
    std::vector<Hit> hits;
    for (std::uint32_t i = 0; hits.size() < many; ++i) {
        Samples samples(7, i);
        const Vec3 direction = sphere(samples.next_2d()), origin = direction * (3 * samples.next());
        if (const auto hit = scene.intersect({origin, sphere(samples.next_2d())})) hits.push_back(*hit);
    }
    hits[many / 2] = {Query::no_instance, flake, 0, 0.25f, 0.5f, 1};  // no ray meets the flake
    return hits;
}

// A map of dark and bright places.
inline std::shared_ptr<const Image> squares_of_sky() {
    std::vector<Rgb> pixels;
    for (int i = 0; i < 32; ++i) pixels.push_back(i % 3 ? Rgb{0.1f, 0.2f, 0.3f} : Rgb{6, 5, 2});
    return std::make_shared<const Image>(8, 4, pixels);
}

}  // namespace lightnet::test
