// Surfaces by the subdivision of Catmull and Clark, with creases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// What such a surface is made from: polygons of any number of corners, by vertices that their neighbours share.
struct Cage {
    /// An edge that stays sharp for as many subdivisions as `sharpness` says, from 10 on for all.
    struct Crease {
        std::uint32_t a = 0, b = 0;
        float sharpness = 0;
    };
    /// A vertex that does.
    struct Tip {
        std::uint32_t vertex = 0;
        float sharpness = 0;
    };
    enum class Borders { left_out, corners_stay, smooth };  // faces there are left out; their outline

    std::vector<Vec3> positions;
    std::vector<Rgb> colours;               // of these, or empty
    std::vector<Vec2> uvs;                  // any number
    std::vector<std::uint32_t> sizes;       // how many corners each face has, from 3 on
    std::vector<std::uint32_t> corners;     // of face after face: positions, of a face each once
    std::vector<std::uint32_t> uv_corners;  // as many: uvs; or empty
    std::vector<Crease> creases;
    std::vector<Tip> tips;
    std::vector<std::uint32_t> holes;  // faces that are not seen
    Borders borders = Borders::smooth;
    bool chaikin = false;  // creases run evenly into those of other sharpnesses
    int straight_uvs =
        4;  // texture coordinates: 0 nowhere, 1 to 3 at corners of their pieces, 4 along their outlines, 5 all
};

/// A surface, and which face of its cage each triangle comes from.
struct Subdivided {
    Mesh mesh;
    std::vector<std::uint32_t> face_of;
};

/// More of one cage are refused. Until a scene is built they take 200 bytes each at most.
inline constexpr std::size_t most_triangles_by_subdivision = std::size_t{1} << 23;

/// Each face split `levels` times (from 1 on), the vertices then moved to where they would end, with the surface's own
/// normals; creases that stay sharp have two. By OpenSubdiv. Throws Error where the faces make no surface, or too many.
Subdivided subdivided(const Cage& cage, int levels);

}  // namespace lightnet
