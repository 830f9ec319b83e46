// Triangles that share their corners.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/math/box.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/textures/members.hpp"
#include "core/scene/textures/vertex_values.hpp"

namespace lightnet {

/// Where the x axis of normal maps and grooves points at a vertex.
struct Tangent {
    Vec3 along;      // unit
    float hand = 1;  // their y axis is cross(normal, along) times this: 1 or -1
};
void visit_members(Is<Tangent> auto& tangent, const auto& visit) {
    auto& [along, hand] = tangent;
    visit(along, hand);
}

/// A shape: see IsShape for what its functions say. A point of it is named by its triangle and the weights of the
/// triangle's second and third corner.
struct Mesh {
    std::vector<Vec3> positions;  // world space
    std::vector<Vec3> normals;    // shading normals per vertex, or empty
    std::vector<Vec2> uvs;        // per vertex, or empty
    std::vector<Rgb> colours;     // per vertex, linear, or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
    bool flip_normals = false;  // geometric normal against the order of vertices; with shading normals
                                // a reader orders them so that both lie on the same side
    VertexValues values{};
    std::vector<Tangent> tangents{};  // per vertex, or empty: then textures are laid along their coordinates

    static constexpr const char* names = "meshes";
    static constexpr const char* part = "a vertex";
    std::uint64_t pieces() const { return triangles.size(); }
    std::string fault() const;
    void add_to(Box& box, const Matrix& by) const;
    float extent() const;
    float largest_piece() const;
    double area() const;
    std::size_t memory() const;
    const Mesh* placed() const { return this; }
};
void visit_members(Is<Mesh> auto& mesh, const auto& visit) {
    auto& [positions, normals, uvs, colours, triangles, flip_normals, values, tangents] = mesh;
    visit(positions, normals, uvs, colours, triangles, flip_normals, values, tangents);
}

}  // namespace lightnet
