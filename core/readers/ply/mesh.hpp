// Meshes in the PLY format: ASCII and binary of both byte orders.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// The mesh of a PLY file: positions, normals (nx ny nz), texture coordinates (u v, s t and their like) and colours
/// (red green blue) per vertex; faces of three or more corners, cut into triangles inside of them, and triangle
/// strips.
/// Other properties and elements are skipped. Throws Error (without a file name) when the bytes are no sound PLY file;
/// allocates no more than a small multiple of them.
Mesh read_ply(std::span<const std::byte> bytes);

/// The name of the picture that it says it wears ("comment TextureFile", as MeshLab writes it); "": none. Throws Error
/// as read_ply() does.
std::string texture_of_ply(std::span<const std::byte> bytes);

/// What such a file holds that no picture of it alone shows: "property 'alpha' of 'vertex'", "element 'edge'", in the
/// order of the file. Throws Error as read_ply() does.
std::vector<std::string> skipped_in_ply(std::span<const std::byte> bytes);

/// A mesh with numbers of a name of their own, in the place of its colours.
struct AttributedMesh {
    Mesh mesh;
    std::vector<Rgb> of_triangles;  // where faces have them, and not vertices; else empty
    bool found = false;             // there is something of that name
};
/// A mesh with the numbers that Mitsuba calls "vertex_NAME" or "face_NAME": those of the properties NAME_0, NAME_1 and
/// NAME_2, or NAME_r, NAME_g and NAME_b, or NAME_x …; one alone is a grey. "vertex_color" and "face_color" may also be
/// red, green and blue.
AttributedMesh read_ply(std::span<const std::byte> bytes, std::string_view attribute);

}  // namespace lightnet
