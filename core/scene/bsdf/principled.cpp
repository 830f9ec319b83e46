#include "core/scene/bsdf/principled.hpp"

#include <algorithm>
#include <cmath>

#include "core/scene/bsdf/albedos.hpp"
#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"

namespace lightnet {
namespace {

constexpr Rgb grey(float value) { return {value, value, value}; }

}  // namespace

float PrincipledBsdf::alpha() const { return std::sqrt(facets.alpha_u * facets.alpha_v); }

std::uint8_t PrincipledBsdf::lobes() const {
    std::uint8_t all = smooth() ? lobe::specular : lobe::glossy;
    if (plastic_share() > 0 || max_component(sheen) > 0) all |= lobe::diffuse;
    if (coat > 0) all |= smooth_coat() ? lobe::specular : lobe::glossy;
    return all;
}

/// Glass knows Fresnel's own formula, as Schlick's has no total reflection; so its colour is a factor.
Rgb PrincipledBsdf::glass_tint() const {
    const float head_on = fresnel_dielectric(1, eta);
    if (!(head_on > 0)) return {};
    return {std::min(1.0f, f0.r / head_on), std::min(1.0f, f0.g / head_on), std::min(1.0f, f0.b / head_on)};
}

float PrincipledBsdf::glass_reflectance(float cosine) const { return fresnel_dielectric(cosine, eta); }

/// Of a facet seen at `cosine`, which is below 0 from inside a solid.
Rgb PrincipledBsdf::reflectance(float cosine) const {
    Rgb sum = principled_mirror(base, metallic, f0, f90, plastic_share(), cosine);
    if (glass_share() > 0) {
        const float glass = glass_reflectance(cosine);
        // what is reflected totally has nowhere else to go
        sum += (glass < 1 ? glass_tint() * glass : grey(1)) * glass_share();
    }
    return sum;
}

Rgb PrincipledBsdf::transmittance(float cosine) const {
    const float glass = glass_reflectance(cosine);
    return base * (glass_share() * (1 - glass));
}

/// With which probability a facet, once sampled, is taken for a mirror, not for a window.
float PrincipledBsdf::reflection_chance(float cosine) const {
    if (glass_share() == 0) return 1;
    const float r = max_component(reflectance(cosine)), t = max_component(transmittance(cosine));
    return r > 0 ? r / (r + t) : 0;
}

float PrincipledBsdf::passes(float height) const {
    return 1 - std::min(1.0f, ggx_albedo(alpha(), height)(max_component(f0), f90));
}

float PrincipledBsdf::passes_on_average() const {
    return std::max(1e-4f, 1 - ggx_mean_albedo(alpha())(max_component(f0), f90));
}

PrincipledBsdf::Layers PrincipledBsdf::layers(float height) const {
    Layers result;
    if (height < 0 && !thin) return result;  // inside there are none
    const float cosine = std::fabs(height), cloth = std::min(1.0f, max_component(sheen));
    if (coat > 0) result.below_coat = 1 - coat * ggx_albedo(coat_alpha, cosine)(principled_coat_f0, 1);
    if (cloth > 0) result.below_sheen = 1 - cloth * std::min(1.0f, sheen_albedo(sheen_alpha, cosine));
    return result;
}

PrincipledBsdf::Layers PrincipledBsdf::layers(Vec3 outgoing, Vec3 incoming) const {
    const Layers out = layers(outgoing.z), in = layers(incoming.z);
    return {std::min(out.below_coat, in.below_coat), std::min(out.below_sheen, in.below_sheen)};
}

PrincipledBsdf::Chances PrincipledBsdf::chances(float height, std::uint8_t lobes) const {
    const float cosine = std::fabs(height);
    const auto [below_coat, below_sheen] = layers(height);
    const std::uint8_t own = smooth() ? lobe::specular : lobe::glossy;
    Chances result;
    float rest = below_coat;
    if (coat > 0 && height > 0 && (lobes & (smooth_coat() ? lobe::specular : lobe::glossy)))
        result.coat = 1 - below_coat;
    if ((lobes & lobe::diffuse) && height > 0) result.sheen = rest * (1 - below_sheen);
    rest *= below_sheen;
    const GgxAlbedo albedo = ggx_albedo(alpha(), cosine);
    const float plastic = std::min(1.0f, albedo(max_component(f0), f90));
    if (lobes & lobe::diffuse) result.diffuse = rest * plastic_share() * (1 - plastic) * max_component(base);
    if (lobes & own) {
        result.facets = metallic * albedo(max_component(base), 1) + plastic_share() * plastic;
        if (glass_share() > 0) result.facets += glass_share() * window_share(height);
        result.facets *= rest;
    }
    const float sum = result.coat + result.sheen + result.diffuse + result.facets;
    if (!(sum > 0)) return {};
    for (float* chance : {&result.coat, &result.sheen, &result.diffuse, &result.facets}) *chance /= sum;
    return result;
}

/// Of light on glass: what it reflects or lets through.
float PrincipledBsdf::window_share(float height) const {
    const float glass = glass_reflectance(height);
    return glass < 1 ? (1 - glass) * max_component(base) + glass * max_component(glass_tint()) : 1;
}

/// Both directions turned upwards: the diffuse base below the dielectric's reflection, and cloth.
void PrincipledBsdf::add_diffuse(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances, BsdfValue& sum) const {
    if (plastic_share() > 0) {
        sum.value += principled_base(base, plastic_share() * (layers.below_coat * layers.below_sheen), passes(o.z),
                                     passes(i.z), passes_on_average(), i.z);
        sum.pdf += chances.diffuse * (i.z * inverse_pi);
    }
    if (chances.sheen > 0) {
        const float most = std::max({1.0f, sheen_albedo(sheen_alpha, o.z), sheen_albedo(sheen_alpha, i.z)});
        sum.value += sheen * (layers.below_coat * sheen_value(sheen_alpha, o, i) / most);
        sum.pdf += chances.sheen * inverse_pi / 2;
    }
}

void PrincipledBsdf::add_glossy(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances, BsdfValue& sum) const {
    const float side = o.z > 0 ? 1.0f : -1.0f, passes = layers.below_coat * layers.below_sheen;
    const bool reflected = o.z * i.z > 0;
    if (!smooth() && (reflected || glass_share() > 0)) {
        const Vec3 across = reflected ? i * side : Vec3{i.x, i.y, -i.z} * side;
        const bool bent = !reflected && !thin;
        const auto [value, pdf, cosine] = bent ? refraction(facets, o, i, eta) : reflection(facets, o * side, across);
        const float seen = bent ? cosine : cosine * side;
        if (cosine != 0) {
            sum.value += (reflected ? reflectance(seen) : transmittance(seen)) * (value * passes);
            const float mirror_chance = reflection_chance(seen);
            sum.pdf += chances.facets * (reflected ? mirror_chance : 1 - mirror_chance) * pdf;
        }
    }
    if (coat > 0 && !smooth_coat() && reflected && o.z > 0) {
        const auto [value, pdf, cosine] = reflection({coat_alpha, coat_alpha}, o, i);
        sum.value += grey(principled_coat(coat, cosine) * value);
        sum.pdf += chances.coat * pdf;
    }
}

BsdfValue PrincipledBsdf::upright_value(Vec3 o, Vec3 i, std::uint8_t lobes) const {
    if (o.z == 0 || i.z == 0) return {};
    const Layers above = layers(o, i);
    const Chances by = chances(o.z, lobes);
    BsdfValue sum;
    const float side = o.z > 0 ? 1.0f : -1.0f;
    if ((lobes & lobe::diffuse) && o.z * i.z > 0) add_diffuse(o * side, i * side, above, by, sum);
    if (lobes & lobe::glossy) add_glossy(o, i, above, by, sum);
    return sum;
}

BsdfValue PrincipledBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    if (turned(outgoing)) {
        outgoing.z = -outgoing.z;
        incoming.z = -incoming.z;
    }
    return upright_value(outgoing, incoming, lobes);
}

std::optional<BsdfSample> PrincipledBsdf::mirror(Vec3 o, const Rgb& value, float chance) const {
    if (!(chance > 0)) return {};
    return BsdfSample{{-o.x, -o.y, o.z}, value / chance, 0, lobe::specular};
}

std::optional<BsdfSample> PrincipledBsdf::window(Vec3 o, float chance) const {
    if (!(chance > 0)) return {};
    const auto passes = [&](Vec3 i) {
        const Layers above = layers(o, i);
        return transmittance(o.z) * (above.below_coat * above.below_sheen / chance);
    };
    if (thin) return BsdfSample{-o, passes(-o), 0, lobe::specular, true};
    const Refracted refracted = refract(o, {0, 0, 1}, eta);
    if (!refracted.possible) return {};
    const Vec3 i = normalize(refracted.direction);
    return BsdfSample{i, passes(i) / (refracted.eta * refracted.eta), 0, lobe::specular, true, refracted.eta};
}

std::optional<BsdfSample> PrincipledBsdf::sample_smooth(Vec3 o, float choice, float chance) const {
    const float mirror_chance = reflection_chance(o.z);
    if (choice >= mirror_chance) return window(o, chance * (1 - mirror_chance));
    const Layers above = layers(o, {-o.x, -o.y, o.z});
    return mirror(o, reflectance(o.z) * (above.below_coat * above.below_sheen), chance * mirror_chance);
}

/// A direction by the facets; its weight is still to be found.
std::optional<BsdfSample> PrincipledBsdf::sample_facets(Vec3 o, float choice, Vec2 u) const {
    const Vec3 m = facets.sample_visible(o, u);
    BsdfSample result;
    result.lobe = lobe::glossy;
    result.transmitted = choice >= reflection_chance(dot(o, m));
    if (result.transmitted && !thin) {
        const Refracted refracted = refract(o, m, eta);
        if (!refracted.possible) return {};
        result.incoming = normalize(refracted.direction);
        result.eta = refracted.eta;
    } else {
        result.incoming = normalize(reflect(o, m));
        if (result.transmitted) result.incoming.z = -result.incoming.z;
    }
    if ((result.incoming.z * o.z < 0) != result.transmitted) return {};
    return result;
}

std::optional<BsdfSample> PrincipledBsdf::upright_sample(Vec3 o, float choice, Vec2 u, std::uint8_t lobes) const {
    const Chances by = chances(o.z, lobes);
    std::optional<BsdfSample> result = BsdfSample{};
    result->lobe = lobe::diffuse;
    if (choice < by.coat) {
        if (smooth_coat()) return mirror(o, grey(principled_coat(coat, o.z)), by.coat);
        result->lobe = lobe::glossy;
        result->incoming = normalize(reflect(o, Microfacets{coat_alpha, coat_alpha}.sample_visible(o, u)));
        if (result->incoming.z <= 0) return {};
    } else if ((choice -= by.coat) < by.sheen) {
        result->incoming = cone(u, 1);
    } else if ((choice -= by.sheen) < by.diffuse) {
        result->incoming = cosine_hemisphere(u) * (o.z > 0 ? 1.0f : -1.0f);
    } else {
        if (!(by.facets > 0)) return {};
        choice = (choice - by.diffuse) / by.facets;
        if (smooth()) return sample_smooth(o, choice, by.facets);
        result = sample_facets(o, choice, u);
    }
    if (!result) return {};
    const auto [value, pdf] = upright_value(o, result->incoming, lobes);
    if (!(pdf > 0)) return {};
    result->weight = value / pdf;
    result->pdf = pdf;
    return result;
}

CosineChoices PrincipledBsdf::cosine_choices(float outgoing, std::uint8_t lobes) const {
    if (!(lobes & this->lobes())) return {};
    const Chances by = chances(turned({0, 0, outgoing}) ? -outgoing : outgoing, lobes);
    const float begin = by.coat + by.sheen;
    return {begin, begin + by.diffuse};
}

std::optional<BsdfSample> PrincipledBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes()) || outgoing.z == 0) return {};
    const bool turn = turned(outgoing);
    if (turn) outgoing.z = -outgoing.z;
    auto result = upright_sample(outgoing, choice, u, lobes);
    if (result && turn) result->incoming.z = -result->incoming.z;
    return result;
}

PrincipledBsdf PrincipledMaterial::at(const MaterialInputs& inputs) const {
    PrincipledBsdf model;
    model.base = inputs.albedo(base_colour);
    model.metallic = inputs.share(metallic, metallic_texture);
    model.transmission = inputs.share(transmission, transmission_texture);
    model.facets = inputs.facets(roughness);
    model.eta = eta;
    model.thin = thin || eta == 1;
    const float share = inputs.share(specular, specular_texture);
    Rgb tint = specular_colour;
    if (specular_colour_texture) tint *= inputs.colour(*specular_colour_texture);
    model.f0 = limited(tint * fresnel_dielectric(1, eta)) * share;
    model.f90 = share;
    if (sheen > 0) {
        model.sheen = sheen_colour * sheen;
        if (sheen_texture) model.sheen *= inputs.colour(*sheen_texture);
        model.sheen = limited(model.sheen);
        const float rough = inputs.share(sheen_roughness, sheen_roughness_texture);
        model.sheen_alpha = std::max(least_sheen_alpha, rough * rough);
    }
    model.coat = inputs.share(clearcoat, clearcoat_texture);
    model.coat_alpha = inputs.facets(clearcoat_roughness).alpha_u;
    return model;
}

}  // namespace lightnet
