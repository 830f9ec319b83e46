#include "core/readers/common/dispersion.hpp"

namespace lightnet {

std::optional<PrincipledMaterial> dispersing_glass(const Rgb& indices, const Roughness& roughness, TextureId white) {
    const float half = (indices.b - indices.r) / 2;
    if (!(half > 0) || !(indices.r >= 1)) return std::nullopt;
    PrincipledMaterial glass;
    glass.base_colour = white;
    glass.transmission = 1;
    glass.thin = false;
    glass.eta = (indices.r + indices.b) / 2;
    glass.dispersion = half;
    glass.roughness = roughness;
    return glass;
}

}  // namespace lightnet
