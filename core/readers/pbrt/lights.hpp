// pbrt's lights.
#pragma once

#include <optional>
#include <string>

#include "core/base/math/transform.hpp"
#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/textures.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// What an AreaLightSource statement says of the shapes behind it.
struct AreaLight {
    AreaEmission emission;
    std::optional<float> power;  // watts (pbrt: of each shape); decides the radiance with the shape's area
    float brightness = 1;        // mean luminance of the image on it, for the power

    /// The emission of a shape with that area.
    AreaEmission on(double area) const;
};

std::optional<AreaLight> make_area_light(const std::string& type, Parameters& parameters, Textures& textures,
                                         const Sources& sources);

/// Makes a light that is no shape, and adds it to the scene. What is wrong is reported.
void add_light(const std::string& type, Parameters& parameters, Textures& textures, const Sources& sources,
               const Matrix& to_world, SceneData& scene);

}  // namespace lightnet::pbrt
