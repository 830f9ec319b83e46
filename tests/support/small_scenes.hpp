// Scenes of a few shapes, made in code.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "core/scene/data/scene_data.hpp"

namespace lightnet::test {

inline TextureId colour(SceneData& data, Rgb value) {
    data.textures.emplace_back().scale = value;
    return TextureId(data.textures.size() - 1);
}

template <class Model>
std::uint32_t material(SceneData& data, Model model) {
    data.materials.emplace_back().model = std::move(model);
    return std::uint32_t(data.materials.size() - 1);
}

inline std::uint32_t diffuse(SceneData& data, float albedo) {
    DiffuseMaterial matte;
    matte.reflectance = colour(data, {albedo, albedo, albedo});
    return material(data, matte);
}

inline std::uint32_t mirror(SceneData& data, float reflectance) {
    ConductorMaterial metal;
    metal.metal.reflectance = colour(data, {reflectance, reflectance, reflectance});
    return material(data, metal);
}

inline Shape& add(SceneData& data, ShapeGeometry geometry, std::uint32_t of) {
    return data.shapes.emplace_back(Shape{std::move(geometry), of, {}, {}});
}

/// A parallelogram; its normal is that of `a` × `b`.
inline Mesh quad(Vec3 corner, Vec3 a, Vec3 b) {
    Mesh mesh;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// The unit square at z = 0, texture coordinates x and y.
inline Mesh textured_square() {
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return mesh;
}

inline TextureId picture(SceneData& data, std::uint32_t width, std::uint32_t height, const std::vector<Rgb>& pixels) {
    ImageTexture image;
    image.image = std::make_shared<const Image>(width, height, pixels);
    data.textures.emplace_back().pattern = image;
    return TextureId(data.textures.size() - 1);
}

inline Sphere ball(Vec3 center, float radius) {
    Sphere sphere;
    sphere.center = center;
    sphere.radius = radius;
    return sphere;
}

/// A unit cube seen from inside, [0,1]³; normals inwards.
inline Mesh room() {
    Mesh mesh;
    const auto wall = [&](Vec3 corner, Vec3 a, Vec3 b) {
        const auto first = std::uint32_t(mesh.positions.size());
        for (const Vec3 p : {corner, corner + a, corner + a + b, corner + b}) mesh.positions.push_back(p);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    };
    const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    wall({0, 0, 0}, y, z);
    wall({1, 0, 0}, z, y);
    wall({0, 0, 0}, z, x);
    wall({0, 1, 0}, x, z);
    wall({0, 0, 0}, x, y);
    wall({0, 0, 1}, y, x);
    return mesh;
}

/// A camera at `eye` that looks at `target`, y upwards.
inline CameraData camera(Vec3 eye, Vec3 target, float fov) {
    const Vec3 z = normalize(target - eye), x = normalize(cross(z, {0, 1, 0})), y = cross(x, z);
    CameraData camera;
    camera.fov = fov;
    for (std::size_t i = 0; i < 3; ++i) {
        camera.to_world.m[i][0] = x[i];
        camera.to_world.m[i][1] = y[i];
        camera.to_world.m[i][2] = z[i];
        camera.to_world.m[i][3] = eye[i];
    }
    return camera;
}

/// The room with walls that shine, seen from inside.
inline SceneData furnace(float albedo, float emission) {
    SceneData data;
    add(data, room(), diffuse(data, albedo)).emission = AreaEmission{{emission, emission, emission}, false};
    data.camera = camera({0.3f, 0.4f, 0.2f}, {0.8f, 0.6f, 0.9f}, 80);
    data.camera_given = true;
    return data;
}

}  // namespace lightnet::test
