// A square in OBJ and a material for it.
#pragma once

#include <string>
#include <utility>

#include "tests/support/scene_text.hpp"

namespace lightnet::test::obj_text {

/// A picture of one white pixel (Radiance HDR).
inline const std::string dot = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x80\x80\x81", 4);
inline const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Half of the square, of a material with these statements of MTL.
inline SceneData with_material(const std::string& statements, MemoryFiles files = {}) {
    files.add("m.mtl", "newmtl a\n" + statements);
    return read_as("m.obj", "mtllib m.mtl\nusemtl a\n" + corners + "f 1 2 3\n", std::move(files));
}
inline const Material& material_of(const SceneData& scene) { return scene.materials[scene.shapes[0].material]; }

}  // namespace lightnet::test::obj_text
