#include "core/bsdf/dielectric.hpp"

#include "core/bsdf/fresnel.hpp"

namespace lightnet {

BsdfValue DielectricBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    const float cos_o = outgoing.z, cos_i = incoming.z;
    if (!(lobes & lobe::glossy) || smooth() || cos_o == 0 || cos_i == 0) return {};
    const bool reflected = cos_o * cos_i > 0;
    const float relative = reflected ? 1 : cos_o > 0 ? eta : 1 / eta;
    Vec3 m = incoming * relative + outgoing;
    if (length_squared(m) == 0) return {};
    m = normalize(m);
    if (m.z < 0) m = -m;
    const float o_m = dot(outgoing, m), i_m = dot(incoming, m);
    if (o_m * cos_o <= 0 || i_m * cos_i <= 0) return {};  // the facet is seen from behind

    const float reflectance = fresnel_dielectric(o_m, eta);
    const float visible_o = facets.visible(outgoing), visible_both = facets.visible(outgoing, incoming);
    if (reflected) {
        const float both = reflectance * facets.density(m) / (4 * std::fabs(cos_o));
        const float value = both * visible_both;
        return {{value, value, value}, both * visible_o};
    }
    const float root = i_m + o_m / relative;
    const float both = (1 - reflectance) * facets.density(m) * std::fabs(i_m * o_m / (root * root * cos_o));
    const float value = both * visible_both / (relative * relative);
    return {{value, value, value}, both * visible_o};
}

std::optional<BsdfSample> DielectricBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes()) || outgoing.z == 0) return {};
    if (smooth()) return sample_smooth(outgoing, choice);
    const Vec3 m = facets.sample_visible(outgoing, u);
    const float reflectance = fresnel_dielectric(dot(outgoing, m), eta);
    const bool reflected = choice < reflectance;
    BsdfSample result{{}, {}, 0, lobe::glossy, !reflected};
    if (reflected) {
        result.incoming = normalize(reflect(outgoing, m));
    } else {
        const Refracted refracted = refract(outgoing, m, eta);
        if (!refracted.possible) return {};
        result.incoming = normalize(refracted.direction);
        result.eta = refracted.eta;
    }
    if ((result.incoming.z * outgoing.z > 0) != reflected || result.incoming.z == 0) return {};
    const auto [value, pdf] = evaluate(outgoing, result.incoming, lobe::glossy);
    if (!(pdf > 0)) return {};
    result.weight = value / pdf;
    result.pdf = pdf;
    return result;
}

std::optional<BsdfSample> DielectricBsdf::sample_smooth(Vec3 outgoing, float choice) const {
    if (choice < fresnel_dielectric(outgoing.z, eta))
        return BsdfSample{{-outgoing.x, -outgoing.y, outgoing.z}, {1, 1, 1}, 0, lobe::specular};
    const Refracted refracted = refract(outgoing, {0, 0, 1}, eta);
    if (!refracted.possible) return {};
    const float scale = 1 / (refracted.eta * refracted.eta);
    return BsdfSample{normalize(refracted.direction), {scale, scale, scale}, 0, lobe::specular, true, refracted.eta};
}

std::optional<BsdfSample> ThinDielectricBsdf::sample(Vec3 outgoing, float choice, Vec2, std::uint8_t lobes) const {
    if (!(lobes & lobe::specular)) return {};
    float reflectance = fresnel_dielectric(outgoing.z, eta);
    // Light that goes back and forth inside the pane: a geometric series.
    if (reflectance < 1) reflectance = 2 * reflectance / (1 + reflectance);
    if (choice < reflectance) return BsdfSample{{-outgoing.x, -outgoing.y, outgoing.z}, {1, 1, 1}, 0, lobe::specular};
    return BsdfSample{-outgoing, {1, 1, 1}, 0, lobe::specular, true};
}

}  // namespace lightnet
