// glTF's meshes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/readers/gltf/materials.hpp"

namespace lightnet::gltf {

/// A primitive in its own space.
struct Primitive {
    Mesh mesh;
    MaterialId material = 0;
    std::optional<AreaEmission> emission;
};

/// All primitives of a mesh that have a surface. What is wrong is reported and left out.
std::vector<Primitive> read_mesh(const At& mesh, Document& document, Materials& materials);

}  // namespace lightnet::gltf
