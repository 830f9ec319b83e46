#include "core/scene/surfaces/bumps.hpp"

#include <algorithm>
#include <cmath>

#include "core/scene/textures/look_up.hpp"

namespace lightnet {
namespace {

// Nearer to the surface than this, in cosines to the geometric normal, no shading normal goes.
constexpr float least_cosine = 0.05f;

Vec3 kept_above(Vec3 z, Vec3 normal) {
    const float cosine = dot(z, normal);
    if (cosine >= least_cosine) return z;
    const Vec3 flat = z - normal * cosine;
    const float size = length(flat);
    if (!(size > 0)) return normal;
    return flat * (std::sqrt(1 - least_cosine * least_cosine) / size) + normal * least_cosine;
}

Vec3 mapped_normal(const SceneData& data, const NormalMap& map, const SurfacePoint& point) {
    const Rgb colour = look_up(data.textures, map.texture, place_of(point));
    const float x = (2 * colour.r - 1) * map.scale, y = (2 * colour.g - 1) * map.scale;
    const Frame frame = frame_along(point.shading.z, point.along_u);
    // pictures are laid either way round on a surface
    const bool mirrored = map.green == NormalMap::Green::along_v && dot(frame.y, point.along_v) < 0;
    const float hand = mirrored ? -1.0f : 1.0f;
    return frame.x * x + frame.y * (hand * y) + frame.z * (2 * colour.b - 1);
}

// Blinn 1978, "Simulation of Wrinkled Surfaces"; without the change of the normal along the surface.
Vec3 bumped_normal(const SceneData& data, TextureId map, const SurfacePoint& point, float step) {
    const auto height = [&](float u, float v) {
        TexturePlace place = place_of(point);
        place.uv = {place.uv.x + u, place.uv.y + v};
        place.position = place.position + point.along_u * u + point.along_v * v;
        return value_at(data.textures, map, place).r;
    };
    const float low_u = height(-step, 0), high_u = height(step, 0);
    const float low_v = height(0, -step), high_v = height(0, step);
    const Vec3 z = point.shading.z;
    const auto flat = [&](Vec3 along) { return along - z * dot(z, along); };
    const Vec3 u = flat(point.along_u) + z * ((high_u - low_u) / (2 * step));
    const Vec3 v = flat(point.along_v) + z * ((high_v - low_v) / (2 * step));
    const Vec3 n = cross(u, v);
    return dot(n, z) < 0 ? -n : n;
}

Vec3 sound_normal(Vec3 turned, const SurfacePoint& point) {
    const float size = length(turned);
    if (!(size > 0) || !std::isfinite(size)) return point.shading.z;
    return kept_above(turned / size, point.normal);
}

}  // namespace

Frame frame_along(Vec3 z, Vec3 tangent) {
    const Vec3 x = tangent - z * dot(z, tangent);
    const float size = length(x);
    if (!(size > 1e-12f)) return Frame::around(z);
    return {x / size, cross(z, x / size), z};
}

Vec3 bumpy_normal(const SceneData& data, const Material& material, const SurfacePoint& point, float step) {
    return sound_normal(material.normal_map ? mapped_normal(data, *material.normal_map, point)
                                            : bumped_normal(data, *material.bump_map, point, step),
                        point);
}

Vec3 coat_normal(const SceneData& data, const PrincipledCoatNormal& coat, const SurfacePoint& point) {
    return coat.map ? sound_normal(mapped_normal(data, *coat.map, point), point) : point.shading.z;
}

float step_of(const SceneData& data, TextureId texture) {
    constexpr float widest = 1e-3f;
    const auto& pattern = data.textures[texture].pattern;
    if (const auto* image = std::get_if<ImageTexture>(&pattern); image && image->image && !image->image->empty()) {
        const auto pixels = [](std::uint32_t size, float scale) {
            return float(size) * std::max(std::fabs(scale), 1e-3f);
        };
        return 0.5f / std::max(pixels(image->image->width, image->uv.scale.x),
                               pixels(image->image->height, image->uv.scale.y));
    }
    float least = widest;
    for (const TextureId input : inputs_of(data.textures[texture])) least = std::min(least, step_of(data, input));
    return least;
}

}  // namespace lightnet
