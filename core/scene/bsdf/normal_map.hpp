// Normals of a surface by a texture.
#pragma once

#include "core/scene/textures/members.hpp"
#include "core/scene/textures/texture.hpp"

namespace lightnet {

struct NormalMap {
    /// How green is laid where texture coordinates are mirrored: along ∂p/∂v all the same (glTF, OBJ); or across blue
    /// and red, so that the three are always right-handed (pbrt, Mitsuba).
    enum class Green { along_v, across };
    TextureId texture = 0;  // linear, 0.5 is 0: red along ∂p/∂u, blue along the shading normal
    float scale = 1;        // of red and green
    Green green = Green::along_v;
};
void visit_members(Is<NormalMap> auto& map, const auto& visit) {
    auto& [texture, scale, green] = map;
    visit(texture, scale, green);
}

}  // namespace lightnet
