// Combinations of textures, made into one picture.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/scene/scene_data.hpp"

namespace lightnet::pbrt {

/// The texture whose value everywhere is `combine(values of the inputs)`. `exact` tells whether it is so: inputs that
/// are laid over the surface in different ways are sampled over the unit square of texture coordinates only.
struct Baked {
    Texture texture;
    bool exact = true;
};
Baked bake(const std::vector<Texture>& inputs, const std::function<Rgb(std::span<const Rgb>)>& combine);

/// A picture of texture coordinates: `value(uv)` at the centre of each pixel, repeated.
Texture paint(std::uint32_t size, const std::function<Rgb(Vec2)>& value);

}  // namespace lightnet::pbrt
