// pbrt's materials, made into those that a scene has.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/textures.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// What the makers of materials look things up in.
struct MaterialSources {
    Textures& textures;
    /// A finished material by its name; none: there is no such.
    std::function<std::optional<MaterialId>(const std::string&)> named;
    /// What a file of that name says that was measured; null: it can't be had, and a warning says so.
    std::function<std::shared_ptr<const Measurement>(const std::string& file, const SourceLine& where)> measured;
    /// Says what fills the shapes of the material that is being made.
    std::function<void(Medium)> fill;
};

/// The material of that type. Where a scene has nothing like it, the nearest is taken, with a warning. An unknown type
/// is reported and diffuse.
Material make_material(const std::string& type, Parameters& parameters, const MaterialSources& sources);

}  // namespace lightnet::pbrt
