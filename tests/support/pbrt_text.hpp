// Scenes written inside a test.
#pragma once

#include <string>
#include <vector>

#include "core/readers/read_scene.hpp"
#include "tests/support/memory_files.hpp"

namespace lightnet::test {

inline SceneData read_text(const std::string& text, MemoryFiles files = {}) {
    files.add("scene.pbrt", text);
    return read_scene(files, "scene.pbrt");
}

/// The scene of statements behind WorldBegin, which is line 1.
inline SceneData read_world(const std::string& statements, MemoryFiles files = {}) {
    return read_text("WorldBegin\n" + statements, std::move(files));
}

/// All that is wrong with a scene, a line each; "" if nothing.
inline std::string errors_of(const std::string& text, MemoryFiles files = {}) {
    try {
        read_text(text, std::move(files));
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

inline std::string errors_of_world(const std::string& statements, MemoryFiles files = {}) {
    return errors_of("WorldBegin\n" + statements, std::move(files));
}

/// A scene's warnings, a line each.
inline std::string warnings_of(const SceneData& scene) {
    std::string text;
    for (const auto& warning : scene.warnings) text += to_string(warning) + "\n";
    return text;
}

inline const Mesh& mesh_of(const SceneData& scene, std::size_t shape = 0) {
    return std::get<Mesh>(scene.shapes.at(shape).geometry);
}

inline const Sphere& sphere_of(const SceneData& scene, std::size_t shape = 0) {
    return std::get<Sphere>(scene.shapes.at(shape).geometry);
}

inline const Quadric& quadric_of(const SceneData& scene, std::size_t shape = 0) {
    return std::get<Quadric>(scene.shapes.at(shape).geometry);
}

/// The normal of a mesh's triangle, as a scene takes it.
inline Vec3 normal_of(const Mesh& mesh, std::size_t triangle = 0) {
    const auto& t = mesh.triangles.at(triangle);
    const Vec3 n =
        normalize(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]));
    return mesh.flip_normals ? -n : n;
}

/// The material model of a shape.
template <class Model>
const Model& model_of(const SceneData& scene, std::size_t shape = 0) {
    return std::get<Model>(scene.materials.at(scene.shapes.at(shape).material).model);
}

/// The constant colour of a texture.
inline Rgb colour_of(const SceneData& scene, TextureId texture) { return scene.textures.at(texture).scale; }

/// An upright triangle whose normal is +z.
inline const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ]\n";
inline const std::string ball = "Shape \"sphere\"\n";

}  // namespace lightnet::test
