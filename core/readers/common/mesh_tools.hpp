// Changes to meshes between a file and a scene.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/base/math/transform.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Moves a mesh into another space. Normals come out as unit vectors, or zero. False: a vertex is not finite there.
bool transform(Mesh& mesh, const Matrix& to_world);
/// A normal in another space: unit, or zero. It stays outside where the transform mirrors.
Vec3 moved_normal(Vec3 normal, const Matrix& to_world);
/// The shading normals decide on which side of a triangle its normal is: vertices are swapped where need be. Vertices
/// without a sound normal get the one of a triangle. For meshes that have normals.
void order_by_normals(Mesh& mesh);
/// Smooth shading normals from the faces around each vertex, weighted by their angles (Thürmer & Wüthrich 1998).
void smooth_normals(Mesh& mesh);
/// Turns the side of its normal, and its shading normals.
void flip(Mesh& mesh);

/// Cuts a polygon into triangles, `corners` being vertices of `positions`: a fan where it is convex, else ear by ear.
/// Polygons of very many corners are cut as fans, whatever they are.
void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
                 const std::function<void(std::uint32_t, std::uint32_t, std::uint32_t)>& triangle);

/// Gives each triangle vertices of its own, in its colour.
void paint(Mesh& mesh, const std::vector<Rgb>& of_triangles);

}  // namespace lightnet
