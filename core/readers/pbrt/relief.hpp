// Heights that the vertices of a mesh are moved by.
#pragma once

#include <span>
#include <string>

#include "core/readers/pbrt/shapes.hpp"
#include "core/scene/textures/texture.hpp"

namespace lightnet::pbrt {

/// Splits the edges of a mesh in its own space, moves its vertices along their normals by what the texture says there,
/// makes smooth normals, and moves it into the world, as pbrt-v4 does (TriQuadMesh::Displace). What is wrong, or "".
/// Touches nothing but the mesh, so that it may be done in any thread.
std::string raise(Mesh& mesh, const Relief& relief, std::span<const Texture> textures);

}  // namespace lightnet::pbrt
