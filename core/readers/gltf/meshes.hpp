// glTF's meshes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/readers/gltf/materials.hpp"
#include "core/readers/gltf/skins.hpp"

namespace lightnet::gltf {

/// A primitive in its own space, or in the world if a skin holds it.
struct Primitive {
    Mesh mesh;
    MaterialId material = 0;
    std::optional<AreaEmission> emission;
};

/// What moves the vertices of a mesh.
struct Moved {
    const std::vector<double>& weights;  // of its morph targets
    const Skin* skin = nullptr;          // null: it stands in its own space
};

/// All primitives of a mesh that have a surface. What is wrong is reported and left out.
std::vector<Primitive> read_mesh(const At& mesh, const Moved& moved, Document& document, Materials& materials);

}  // namespace lightnet::gltf
