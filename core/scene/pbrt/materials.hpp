// pbrt's materials, made into those that a scene has.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/scene/pbrt/parameters.hpp"
#include "core/scene/pbrt/textures.hpp"
#include "core/scene/scene_data.hpp"

namespace lightnet::pbrt {

/// What the makers of materials look things up in.
struct MaterialSources {
    Textures& textures;
    const SceneData& scene;
    /// A finished material by its name; null: there is none.
    std::function<const Material*(const std::string&)> named;
};

/// The material of that type. Where a scene has nothing like it, the nearest is taken, with a warning. An unknown type
/// is reported and diffuse.
Material make_material(const std::string& type, Parameters& parameters, const MaterialSources& sources);

/// pbrt's "interface": a surface that isn't there, only a border of media.
bool is_interface(const std::string& type);

}  // namespace lightnet::pbrt
