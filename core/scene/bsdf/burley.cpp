#include "core/scene/bsdf/burley.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math/exponential.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/albedos.hpp"
#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/principled.hpp"

namespace lightnet {
namespace {

constexpr float coat_masking = 0.25f;  // α of what hides the facets of a coat, whatever theirs is

/// Schlick's (1 - cos)⁵.
float grazing(float cosine) { return schlick(0, 1, cosine); }
float mix(float a, float b, float share) { return a + (b - a) * share; }
Rgb mix(Rgb a, Rgb b, float share) { return a * (1 - share) + b * share; }
Rgb square_root(Rgb c) { return {std::sqrt(c.r), std::sqrt(c.g), std::sqrt(c.b)}; }

}  // namespace

float BurleyBsdf::Coat::density(float height) const {
    const float alpha2 = alpha * alpha;
    return (alpha2 - 1) / (pi * logarithm(alpha2) * (1 + (alpha2 - 1) * height * height));
}

Vec3 BurleyBsdf::Coat::sample(Vec2 u) const {
    const Vec2 d = disk(u);
    const float r2 = d.x * d.x + d.y * d.y, alpha2 = alpha * alpha;
    const float height2 = (1 - exponential(logarithm(alpha2) * (1 - r2))) / (1 - alpha2);
    const float aside = std::sqrt(std::max(0.0f, 1 - height2) / std::max(r2, 1e-20f));
    return normalize({d.x * aside, d.y * aside, std::sqrt(std::max(0.0f, height2))});
}

/// f × |cos incoming|. Burley leaves out 1 / (4 cos cos), and Mitsuba does.
float BurleyBsdf::Coat::value(Vec3 outgoing, Vec3 incoming, Vec3 facet) const {
    const Microfacets hiding{coat_masking, coat_masking};
    const float seen = hiding.visible(outgoing) * hiding.visible(incoming);
    return 0.25f * strength * schlick(principled_coat_f0, 1, dot(outgoing, facet)) * density(facet.z) * seen *
           incoming.z;
}

std::uint8_t BurleyBsdf::lobes() const {
    std::uint8_t all = 0;
    if (matt_share() > 0 || (matt.sheen > 0 && metallic < 1)) all |= lobe::diffuse;
    if (!thin || transmission > 0) all |= facet_lobe();
    if (coat.strength > 0) all |= lobe::glossy;
    return all;
}

/// Of the base, with luminance 1.
Rgb BurleyBsdf::hue() const {
    const float bright = luminance(base);
    return bright > 0 ? base / bright : Rgb{1, 1, 1};
}

/// Of a facet seen at `cosine`, which is below 0 from inside a solid.
Rgb BurleyBsdf::reflectance(float cosine) const {
    if (eta == 1) return {};  // in Mitsuba nothing reflects then, not even metal
    const float glass = fresnel_dielectric(cosine, eta);
    const Rgb plain{glass, glass, glass};
    if (cosine < 0) return plain * glass_share();
    const Rgb tinted = tint > 0 ? mix(plain, schlick(hue() * fresnel_dielectric(1, eta), 1, cosine), tint) : plain;
    if (thin) return tinted * transmission;
    return tinted * (1 - metallic) + schlick(base, 1, cosine) * metallic;
}

Rgb BurleyBsdf::transmittance(float cosine) const {
    const float passes = 1 - fresnel_dielectric(cosine, eta);
    return (thin ? base * transmission : square_root(base) * glass_share()) * passes;
}

/// The facets of what a sheet lets through are others than those that reflect, so that the height decides.
float BurleyBsdf::reflection_chance(float facet, float height) const {
    if (glass_share() == 0) return 1;
    const float cosine = thin ? height : facet;
    const float r = max_component(reflectance(cosine)), t = max_component(transmittance(cosine));
    return r + t > 0 ? r / (r + t) : 0.5f;
}

BurleyBsdf::Chances BurleyBsdf::chances(float height, std::uint8_t lobes) const {
    const float cosine = std::fabs(height);
    Chances by;
    if ((lobes & lobe::diffuse) && height > 0) {
        const float sheen = (1 - metallic) * (thin ? 1 - transmission : 1) * matt.sheen;
        const float all = matt_share() * max_component(base);
        by.matt = all * (1 - matt.through) + 0.1f * sheen * (1 - matt.through);
        by.through = all * matt.through;
    }
    if (lobes & facet_lobe()) {
        const GgxAlbedo albedo = ggx_albedo(std::sqrt(facets.alpha_u * facets.alpha_v), cosine);
        const float mirror = albedo(max_component(reflectance(1)), eta == 1 ? 0 : 1);
        by.facets = thin ? transmission : height > 0 ? mirror + glass_share() : glass_share();
    }
    if (coat.strength > 0 && height > 0 && (lobes & lobe::glossy))
        by.coat = 0.25f * coat.strength * schlick(principled_coat_f0, 1, cosine);
    const float sum = by.coat + by.matt + by.through + by.facets;
    if (!(sum > 0)) return {};
    for (float* chance : {&by.coat, &by.matt, &by.through, &by.facets}) *chance /= sum;
    return by;
}

/// Both directions above: Burley's diffuse with what it sends back, Hanrahan and Krueger's flat look, and sheen.
Rgb BurleyBsdf::matt_value(Vec3 o, Vec3 i) const {
    const Vec3 facet = normalize(o + i);
    const float out = grazing(o.z), in = grazing(i.z), cosine = dot(facet, i);
    const float back = 2 * matt.roughness * cosine * cosine;
    float shape = (1 - 0.5f * in) * (1 - 0.5f * out) + back * (out + in + out * in * (back - 1));
    if (matt.flatness > 0) {
        const float below = mix(1, back / 2, out) * mix(1, back / 2, in);
        shape = mix(shape, 1.25f * (below * (1 / (o.z + i.z) - 0.5f) + 0.5f), matt.flatness);
    }
    Rgb value = base * (matt_share() * shape * inverse_pi);
    if (matt.sheen > 0) {
        const float sheen = (1 - metallic) * (thin ? 1 - transmission : 1) * matt.sheen * grazing(cosine);
        value += mix({1, 1, 1}, hue(), matt.sheen_tint) * sheen;
    }
    return value * ((1 - matt.through) * i.z);
}

void BurleyBsdf::add_facets(Vec3 o, Vec3 i, float chance, BsdfValue& sum) const {
    const float side = o.z > 0 ? 1.0f : -1.0f;
    const bool reflected = o.z * i.z > 0;
    if (!reflected && glass_share() == 0) return;
    const Vec3 across = reflected ? i * side : Vec3{i.x, i.y, -i.z} * side;
    const bool bent = !reflected && !thin;
    const auto [value, pdf, cosine] =
        bent ? refraction(facets, o, i, eta) : reflection(reflected ? facets : window, o * side, across);
    if (cosine == 0) return;
    const float seen = bent ? cosine : cosine * side, mirror = reflection_chance(seen, o.z);
    sum.value += (reflected ? reflectance(seen) : transmittance(seen)) * value;
    sum.pdf += chance * (reflected ? mirror : 1 - mirror) * pdf;
}

BsdfValue BurleyBsdf::upright_value(Vec3 o, Vec3 i, std::uint8_t lobes) const {
    if (o.z == 0 || i.z == 0) return {};
    const Chances by = chances(o.z, lobes);
    BsdfValue sum;
    if ((lobes & lobe::diffuse) && o.z > 0 && i.z > 0) {
        sum.value += matt_value(o, i);
        sum.pdf += by.matt * i.z * inverse_pi;
    } else if ((lobes & lobe::diffuse) && o.z > 0 && matt.through > 0) {
        sum.value += base * (matt_share() * matt.through * inverse_pi * -i.z);
        sum.pdf += by.through * -i.z * inverse_pi;
    }
    if (!(lobes & lobe::glossy)) return sum;
    if (!smooth() && (!thin || transmission > 0)) add_facets(o, i, by.facets, sum);
    if (coat.strength > 0 && o.z > 0 && i.z > 0) {
        const Vec3 facet = normalize(o + i);
        const float value = coat.value(o, i, facet);
        sum.value += Rgb{value, value, value};
        sum.pdf += by.coat * coat.density(facet.z) * facet.z / (4 * dot(o, facet));
    }
    return sum;
}

BsdfValue BurleyBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    const float side = turned(outgoing) ? -1.0f : 1.0f;
    outgoing.z *= side, incoming.z *= side;
    return upright_value(outgoing, incoming, lobes);
}

std::optional<BsdfSample> BurleyBsdf::sample_smooth(Vec3 o, float choice, float chance) const {
    const float mirror = reflection_chance(o.z, o.z);
    if (choice < mirror) return BsdfSample{{-o.x, -o.y, o.z}, reflectance(o.z) / (chance * mirror), 0, lobe::specular};
    const Rgb weight = transmittance(o.z) / (chance * (1 - mirror));
    if (thin) return BsdfSample{-o, weight, 0, lobe::specular, true};
    const Refracted bent = refract(o, {0, 0, 1}, eta);
    if (!bent.possible) return {};
    return BsdfSample{normalize(bent.direction), weight / (bent.eta * bent.eta), 0, lobe::specular, true, bent.eta};
}

/// A direction by the facets; its weight is still to be found.
std::optional<BsdfSample> BurleyBsdf::sample_facets(Vec3 o, float choice, Vec2 u) const {
    bool transmitted = thin && choice >= reflection_chance(o.z, o.z);
    const Vec3 m = (transmitted ? window : facets).sample_visible(o, u);
    if (!thin) transmitted = choice >= reflection_chance(dot(o, m), o.z);
    return way_by_facet(o, m, transmitted, thin, eta);
}

std::optional<BsdfSample> BurleyBsdf::upright_sample(Vec3 o, float choice, Vec2 u, std::uint8_t lobes) const {
    const Chances by = chances(o.z, lobes);
    std::optional<BsdfSample> result = BsdfSample{};
    result->lobe = lobe::diffuse;
    if (choice < by.coat) {
        result->lobe = lobe::glossy;
        result->incoming = normalize(reflect(o, coat.sample(u)));
        if (result->incoming.z <= 0) return {};
    } else if ((choice -= by.coat) < by.matt) {
        result->incoming = cosine_hemisphere(u);
    } else if ((choice -= by.matt) < by.through) {
        result->incoming = -cosine_hemisphere(u);
        result->transmitted = true;
    } else {
        if (!(by.facets > 0)) return {};
        choice = (choice - by.through) / by.facets;
        if (smooth()) return sample_smooth(o, choice, by.facets);
        result = sample_facets(o, choice, u);
    }
    if (!result) return {};
    return weighed(*result, upright_value(o, result->incoming, lobes));
}

CosineChoices BurleyBsdf::cosine_choices(float outgoing, std::uint8_t lobes) const {
    if (!(lobes & this->lobes())) return {};
    const Chances by = chances(turned({0, 0, outgoing}) ? -outgoing : outgoing, lobes);
    return {by.coat, by.coat + by.matt};
}

std::optional<BsdfSample> BurleyBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes()) || outgoing.z == 0) return {};
    const float side = turned(outgoing) ? -1.0f : 1.0f;
    outgoing.z *= side;
    auto result = upright_sample(outgoing, choice, u, lobes);
    if (result) result->incoming.z *= side;
    return result;
}

float eta_of_specular(float specular) { return 2 / (1 - std::sqrt(0.08f * specular)) - 1; }

float stretch_of(float anisotropic) { return 1 / std::sqrt(std::sqrt(1 - 0.9f * anisotropic)); }

BurleyBsdf BurleyMaterial::at(const MaterialInputs& inputs) const {
    const auto share = [&](TextureId texture) { return inputs.share(1, texture); };
    BurleyBsdf model;
    model.thin = thin;
    model.base = inputs.albedo(base_colour);
    model.transmission = share(transmission);
    model.tint = share(tint);
    Roughness stretched = roughness;
    if (anisotropic) {
        const float by = stretch_of(share(*anisotropic));
        stretched.u *= by, stretched.v /= by;
    }
    model.facets = inputs.facets(stretched);
    // light that passes needs some difference, as in Mitsuba
    const float least = lets_through && !thin ? 1.001f : 1.0f;
    model.eta = std::max(least, specular ? eta_of_specular(share(*specular)) : inputs.times(1, eta));
    const float rough = inputs.times(std::sqrt(roughness.u * roughness.v), roughness.texture);
    model.matt = {rough, share(flatness), share(sheen), share(sheen_tint), thin ? share(through) : 0};
    if (thin) {
        // Burley 2015, figure 15
        model.window = facets_of(roughness, inputs.times(0.65f * model.eta - 0.35f, roughness.texture));
        if (!model.smooth() && is_specular(model.window.alpha_u, model.window.alpha_v))
            model.window = {specular_alpha, specular_alpha, roughness.law};
        return model;
    }
    model.metallic = share(metallic);
    model.coat = {share(coat), mix(0.1f, 0.001f, share(gloss))};
    return model;
}

}  // namespace lightnet
