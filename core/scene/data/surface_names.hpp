// Names of surfaces, for pictures that tell them apart.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// By what surfaces are called.
enum class NamedBy { object, mesh, material, lamp };

/// What has no name of its own.
inline constexpr std::string_view unnamed = "unnamed";

/// The names of all that rays can meet.
struct SurfaceNames {
    std::vector<std::string> of_shape;     // by shape; "": it is none of those
    std::vector<std::string> of_instance;  // by instance: instead of its shapes' names, where it has one
};

/// Objects: what stands there, as glTF names it, else as meshes. Meshes: the name of the shape, or where that has none
/// of its material; in an instance that of the object, where it has one. Materials: that of the shape's. Lamps: as
/// lamps_of() calls them, shapes alone.
SurfaceNames surface_names(const SceneData& scene, NamedBy by);

/// "object", "mesh", "material" or "lamp". Throws Error at others.
NamedBy named_by(std::string_view word);

}  // namespace lightnet
