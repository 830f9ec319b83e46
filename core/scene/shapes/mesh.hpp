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

namespace lightnet {

/// A shape: see IsShape for what its functions say. A point of it is named by its triangle and the weights of the
/// triangle's second and third corner.
struct Mesh {
    std::vector<Vec3> positions;  // world space
    std::vector<Vec3> normals;    // shading normals per vertex, or empty
    std::vector<Vec2> uvs;        // per vertex, or empty
    std::vector<Rgb> colours;     // per vertex, linear, or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
    bool flip_normals = false;       // geometric normal against the order of vertices; with shading normals
                                     // a reader orders them so that both lie on the same side
    std::vector<Vec2> second_uvs{};  // per vertex, or empty: see SecondUvTexture

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
    auto& [positions, normals, uvs, colours, triangles, flip_normals, second_uvs] = mesh;
    visit(positions, normals, uvs, colours, triangles, flip_normals, second_uvs);
}

}  // namespace lightnet
