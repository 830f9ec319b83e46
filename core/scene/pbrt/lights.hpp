// pbrt's lights.
#pragma once

#include <optional>
#include <string>

#include "core/scene/pbrt/parameters.hpp"
#include "core/scene/pbrt/textures.hpp"
#include "core/scene/scene_data.hpp"

namespace lightnet::pbrt {

/// What an AreaLightSource statement says of the shapes behind it.
struct AreaLight {
    AreaEmission emission;
    std::optional<float> power;  // watts (pbrt: of each shape); decides the radiance with the shape's area

    /// The emission of a shape with that area.
    AreaEmission on(double area) const;
};

std::optional<AreaLight> make_area_light(const std::string& type, Parameters& parameters, Textures& textures,
                                         const Sources& sources);

/// A light that is no shape. Only constant environments are supported: of a picture the mean is taken, with a warning.
std::optional<EnvironmentData> make_light(const std::string& type, Parameters& parameters, Textures& textures,
                                          const Sources& sources);

}  // namespace lightnet::pbrt
