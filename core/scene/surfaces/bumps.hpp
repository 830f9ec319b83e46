// Small bumps of a surface, by turning its shading normal.
#pragma once

#include "core/scene/data/scene_data.hpp"
#include "core/scene/surfaces/surface.hpp"

namespace lightnet {

/// The frame around `z` whose x axis lies along `tangent`.
Frame frame_along(Vec3 z, Vec3 tangent);

/// The shading normal under the material's normal map or bump map, whichever it has; it stays on its side of the
/// surface. Heights are compared over `step` of the texture coordinates.
Vec3 bumpy_normal(const SceneData& data, const Material& material, const SurfacePoint& point, float step);

/// The normal of a coat that does not follow the material's bumps.
Vec3 coat_normal(const SceneData& data, const PrincipledCoatNormal& coat, const SurfacePoint& point);

/// A step that suits the images of a texture: half a pixel.
float step_of(const SceneData& data, TextureId texture);

}  // namespace lightnet
