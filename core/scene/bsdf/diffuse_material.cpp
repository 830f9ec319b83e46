#include "core/scene/bsdf/diffuse_material.hpp"

#include <algorithm>

namespace lightnet {

std::variant<DiffuseBsdf, RoughDiffuseBsdf, DiffuseTransmissionBsdf> DiffuseMaterial::at(
    const MaterialInputs& inputs) const {
    const Rgb reflected = inputs.albedo(reflectance);
    if (transmittance) {
        const Rgb transmitted = inputs.albedo(*transmittance), sum = reflected + transmitted;
        const float most = std::max(1.0f, max_component(sum));
        return DiffuseTransmissionBsdf{reflected / most, transmitted / most};
    }
    if (sigma > 0) return RoughDiffuseBsdf{reflected, roughness_of_slopes(sigma)};
    return DiffuseBsdf{reflected};
}

}  // namespace lightnet
