#include "core/scene/bsdf/principled.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math/frame.hpp"
#include "core/scene/bsdf/albedos.hpp"
#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/fresnel.hpp"

namespace lightnet {
namespace {

constexpr Rgb uncoloured(float value) { return {value, value, value}; }

/// A direction, seen by whose x axis is turned by that cosine and sine.
Vec3 along_groove(Vec2 groove, Vec3 w) {
    return {groove.x * w.x + groove.y * w.y, groove.x * w.y - groove.y * w.x, w.z};
}

/// Red, green or blue, evenly.
std::size_t colour_of(float choice) {
    return std::min(static_cast<std::size_t>(std::max(0.0f, choice) * 3), std::size_t{2});
}

}  // namespace

float PrincipledBsdf::alpha() const { return std::sqrt(facets.alpha_u * facets.alpha_v); }

std::uint8_t PrincipledBsdf::lobes() const {
    std::uint8_t all = smooth() ? lobe::specular : lobe::glossy;
    if (plastic_share() > 0 || max_component(sheen) > 0) all |= lobe::diffuse;
    if (coat > 0) all |= smooth_coat() ? lobe::specular : lobe::glossy;
    return all;
}

float PrincipledBsdf::ceiling_f0() const {
    const float bare = max_component(f0);
    return film.share > 0 ? bare * (1 - film.share) + film_f0 * film.share : bare;
}

float PrincipledBsdf::passes(float height) const {
    return 1 - std::min(1.0f, ggx_albedo(alpha(), height)(ceiling_f0(), ceiling_f90()));
}

float PrincipledBsdf::passes_on_average() const {
    return std::max(1e-4f, 1 - ggx_mean_albedo(alpha())(ceiling_f0(), ceiling_f90()));
}

/// Of what the base scatters evenly, how much goes through.
float PrincipledBsdf::through_chance() const {
    if (translucence == 0) return 0;
    const float back = max_component(base) * (1 - translucence), through = max_component(passed) * translucence;
    return through > 0 ? through / (back + through) : 0;
}

PrincipledBsdf::Layers PrincipledBsdf::layers(float height) const { return layers(height, std::fabs(height)); }

PrincipledBsdf::Layers PrincipledBsdf::layers(Vec3 direction) const {
    return layers(direction.z, std::fabs(tilted() ? dot(direction, coat_up) : direction.z));
}

PrincipledBsdf::Layers PrincipledBsdf::layers(float height, float above_coat) const {
    Layers result;
    if (height < 0 && !sheet()) return result;  // inside there are none
    const float cosine = std::fabs(height), cloth = std::min(1.0f, max_component(sheen));
    if (coat > 0) result.below_coat = 1 - coat * ggx_albedo(coat_alpha, above_coat)(principled_coat_f0, 1);
    if (cloth > 0) result.below_sheen = 1 - cloth * std::min(1.0f, sheen_albedo(sheen_alpha, cosine));
    return result;
}

PrincipledBsdf::Layers PrincipledBsdf::layers(Vec3 outgoing, Vec3 incoming) const {
    const Layers out = layers(outgoing), in = layers(incoming);
    return {std::min(out.below_coat, in.below_coat), std::min(out.below_sheen, in.below_sheen)};
}

PrincipledBsdf::Chances PrincipledBsdf::chances(float height, std::uint8_t lobes) const {
    return chances(layers(height), height, lobes);
}

PrincipledBsdf::Chances PrincipledBsdf::chances(Vec3 outgoing, std::uint8_t lobes) const {
    return chances(layers(outgoing), outgoing.z, lobes);
}

PrincipledBsdf::Chances PrincipledBsdf::chances(const Layers& above, float height, std::uint8_t lobes) const {
    const float cosine = std::fabs(height);
    const auto [below_coat, below_sheen] = above;
    const std::uint8_t own = smooth() ? lobe::specular : lobe::glossy;
    Chances result;
    float rest = below_coat;
    if (coat > 0 && height > 0 && (lobes & (smooth_coat() ? lobe::specular : lobe::glossy)))
        result.coat = 1 - below_coat;
    if ((lobes & lobe::diffuse) && height > 0) result.sheen = rest * (1 - below_sheen);
    rest *= below_sheen;
    const GgxAlbedo albedo = ggx_albedo(alpha(), cosine);
    const float plastic = std::min(1.0f, albedo(ceiling_f0(), ceiling_f90()));
    const float even = translucence > 0
                           ? max_component(base) * (1 - translucence) + max_component(passed) * translucence
                           : max_component(base);
    if (lobes & lobe::diffuse) result.diffuse = rest * plastic_share() * (1 - plastic) * even;
    if (lobes & own) {
        result.facets = metallic * albedo(film.share > 0 ? 1 : max_component(base), 1) + plastic_share() * plastic;
        if (glass_share() > 0) result.facets += glass_share() * window_share(height);
        result.facets *= rest;
    }
    const float sum = result.coat + result.sheen + result.diffuse + result.facets;
    if (!(sum > 0)) return {};
    for (float* chance : {&result.coat, &result.sheen, &result.diffuse, &result.facets}) *chance /= sum;
    return result;
}

/// Both directions turned upwards: the diffuse base below the dielectric's reflection, and cloth.
void PrincipledBsdf::add_diffuse(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances, BsdfValue& sum) const {
    if (plastic_share() > 0) {
        const float share = plastic_share() * (1 - translucence);
        sum.value += principled_base(base, share * (layers.below_coat * layers.below_sheen), passes(o.z), passes(i.z),
                                     passes_on_average(), i.z);
        sum.pdf += chances.diffuse * (1 - through_chance()) * (i.z * inverse_pi);
    }
    if (chances.sheen > 0) {
        const float most = std::max({1.0f, sheen_albedo(sheen_alpha, o.z), sheen_albedo(sheen_alpha, i.z)});
        sum.value += sheen * (layers.below_coat * sheen_value(sheen_alpha, o, i) / most);
        sum.pdf += chances.sheen * inverse_pi / 2;
    }
}

/// What the base sends through to the other side.
void PrincipledBsdf::add_translucent(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances,
                                     BsdfValue& sum) const {
    const float out = std::fabs(o.z), in = std::fabs(i.z), share = plastic_share() * translucence;
    sum.value += principled_base(passed, share * (layers.below_coat * layers.below_sheen), passes(out), passes(in),
                                 passes_on_average(), in);
    sum.pdf += chances.diffuse * through_chance() * (in * inverse_pi);
}

/// What refracting facets send, by an index for each colour.
void PrincipledBsdf::add_dispersed(Vec3 o, Vec3 i, float passes, const Chances& chances, BsdfValue& sum) const {
    float* const values[]{&sum.value.r, &sum.value.g, &sum.value.b};
    for (std::size_t colour = 0; colour < 3; ++colour) {
        const auto [value, pdf, cosine] = refraction(facets, o, i, index(colour));
        if (cosine == 0) continue;
        *values[colour] += dispersed_transmittance(cosine, colour) * (value * passes);
        sum.pdf += chances.facets * (1 - reflection_chance(cosine)) * pdf / 3;
    }
}

/// Where the coat's normal is up.
void PrincipledBsdf::add_coat(Vec3 o, Vec3 i, const Chances& chances, BsdfValue& sum) const {
    if (tilted()) {
        const Frame frame = Frame::around(coat_up);
        o = frame.to_local(o), i = frame.to_local(i);
        if (o.z <= 0 || i.z <= 0) return;
    }
    const auto [value, pdf, cosine] = reflection({coat_alpha, coat_alpha}, o, i);
    sum.value += uncoloured(principled_coat(coat, cosine) * value);
    sum.pdf += chances.coat * pdf;
}

void PrincipledBsdf::add_glossy(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances, BsdfValue& sum) const {
    const float side = o.z > 0 ? 1.0f : -1.0f, passes = layers.below_coat * layers.below_sheen;
    const bool reflected = o.z * i.z > 0;
    if (!smooth() && (reflected || glass_share() > 0)) {
        const Vec3 across = reflected ? i * side : Vec3{i.x, i.y, -i.z} * side;
        const bool bent = !reflected && !thin;
        if (bent && dispersion != 0) return add_dispersed(o, i, passes, chances, sum);
        const auto [value, pdf, cosine] = bent ? refraction(facets, o, i, eta) : reflection(facets, o * side, across);
        const float seen = bent ? cosine : cosine * side;
        if (cosine != 0) {
            sum.value += (reflected ? reflectance(seen) : transmittance(seen)) * (value * passes);
            const float mirror_chance = reflection_chance(seen);
            sum.pdf += chances.facets * (reflected ? mirror_chance : 1 - mirror_chance) * pdf;
        }
    }
    if (coat > 0 && !smooth_coat() && reflected && o.z > 0) {
        add_coat(o, i, chances, sum);
    }
}

BsdfValue PrincipledBsdf::upright_value(Vec3 o, Vec3 i, std::uint8_t lobes) const {
    if (o.z == 0 || i.z == 0) return {};
    const Layers above = layers(o, i);
    const Chances by = chances(o, lobes);
    BsdfValue sum;
    const float side = o.z > 0 ? 1.0f : -1.0f;
    if ((lobes & lobe::diffuse) && o.z * i.z > 0) add_diffuse(o * side, i * side, above, by, sum);
    if ((lobes & lobe::diffuse) && o.z * i.z < 0 && translucence > 0) add_translucent(o, i, above, by, sum);
    if (lobes & lobe::glossy) add_glossy(o, i, above, by, sum);
    return sum;
}

/// Without grooves that are turned; `turn`: the surface is upside down, and its own normal is flipped already.
PrincipledBsdf PrincipledBsdf::upright(bool turn) const {
    PrincipledBsdf result = *this;
    result.groove = {1, 0};
    if (turn) result.coat_up = {-coat_up.x, -coat_up.y, coat_up.z};
    result.coat_up = along_groove(groove, result.coat_up);
    return result;
}

BsdfValue PrincipledBsdf::evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const {
    const bool turn = turned(outgoing);
    if (turn) {
        outgoing.z = -outgoing.z;
        incoming.z = -incoming.z;
    }
    if (grooved() || tilted())
        return upright(turn).upright_value(along_groove(groove, outgoing), along_groove(groove, incoming), lobes);
    return upright_value(outgoing, incoming, lobes);
}

std::optional<BsdfSample> PrincipledBsdf::mirror(Vec3 o, const Rgb& value, float chance) const {
    if (!(chance > 0)) return {};
    return BsdfSample{{-o.x, -o.y, o.z}, value / chance, 0, lobe::specular};
}

/// `choice`: which colour's index bends the light, where it matters.
std::optional<BsdfSample> PrincipledBsdf::window(Vec3 o, float choice, float chance) const {
    if (!(chance > 0)) return {};
    const bool dispersed = dispersion != 0 && !thin;
    const std::size_t colour = dispersed ? colour_of(choice) : 1;
    const auto passes = [&](Vec3 i) {
        const Layers above = layers(o, i);
        return transmittance(o.z) * (above.below_coat * above.below_sheen / chance);
    };
    if (thin) return BsdfSample{-o, passes(-o), 0, lobe::specular, true};
    const Refracted refracted = refract(o, {0, 0, 1}, dispersed ? index(colour) : eta);
    if (!refracted.possible) return {};
    const Vec3 i = normalize(refracted.direction);
    Rgb weight = passes(i) / (refracted.eta * refracted.eta);
    if (dispersed) weight = weight * Rgb{colour == 0 ? 3.0f : 0, colour == 1 ? 3.0f : 0, colour == 2 ? 3.0f : 0};
    return BsdfSample{i, weight, 0, lobe::specular, true, refracted.eta};
}

std::optional<BsdfSample> PrincipledBsdf::sample_smooth(Vec3 o, float choice, float chance) const {
    const float mirror_chance = reflection_chance(o.z);
    if (choice >= mirror_chance)
        return window(o, (choice - mirror_chance) / (1 - mirror_chance), chance * (1 - mirror_chance));
    const Layers above = layers(o, {-o.x, -o.y, o.z});
    return mirror(o, reflectance(o.z) * (above.below_coat * above.below_sheen), chance * mirror_chance);
}

/// A direction by the facets; its weight is still to be found.
std::optional<BsdfSample> PrincipledBsdf::sample_facets(Vec3 o, float choice, Vec2 u) const {
    const Vec3 m = facets.sample_visible(o, u);
    const float mirror_chance = reflection_chance(dot(o, m));
    const bool transmitted = choice >= mirror_chance;
    const bool spread = transmitted && !thin && dispersion != 0;
    const float own = spread ? index(colour_of((choice - mirror_chance) / (1 - mirror_chance))) : eta;
    return way_by_facet(o, m, transmitted, thin, own);
}

/// A direction off the coat; the weight of a rough one is still to be found.
std::optional<BsdfSample> PrincipledBsdf::sample_coat(Vec3 o, Vec2 u, float chance) const {
    const Frame frame = tilted() ? Frame::around(coat_up) : Frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Vec3 own = frame.to_local(o);
    if (own.z <= 0) return {};
    if (smooth_coat()) {
        auto result = mirror(own, uncoloured(principled_coat(coat, own.z)), chance);
        if (!result) return {};
        result->incoming = frame.to_world(result->incoming);
        return result->incoming.z > 0 ? result : std::nullopt;
    }
    const Vec3 in = reflect(own, Microfacets{coat_alpha, coat_alpha}.sample_visible(own, u));
    BsdfSample result;
    result.lobe = lobe::glossy;
    result.incoming = normalize(frame.to_world(in));
    if (in.z <= 0 || result.incoming.z <= 0) return {};
    return result;
}

std::optional<BsdfSample> PrincipledBsdf::upright_sample(Vec3 o, float choice, Vec2 u, std::uint8_t lobes) const {
    const Chances by = chances(o, lobes);
    std::optional<BsdfSample> result = BsdfSample{};
    result->lobe = lobe::diffuse;
    if (choice < by.coat && tilted()) {
        result = sample_coat(o, u, by.coat);
        if (!result || result->lobe == lobe::specular) return result;
    } else if (choice < by.coat) {
        if (smooth_coat()) return mirror(o, uncoloured(principled_coat(coat, o.z)), by.coat);
        result->lobe = lobe::glossy;
        result->incoming = normalize(reflect(o, Microfacets{coat_alpha, coat_alpha}.sample_visible(o, u)));
        if (result->incoming.z <= 0) return {};
    } else if ((choice -= by.coat) < by.sheen) {
        result->incoming = cone(u, 1);
    } else if ((choice -= by.sheen) < by.diffuse) {
        result->incoming = cosine_hemisphere(u) * (o.z > 0 ? 1.0f : -1.0f);
        result->transmitted = translucence > 0 && choice >= by.diffuse * (1 - through_chance());
        if (result->transmitted) result->incoming.z = -result->incoming.z;
    } else {
        if (!(by.facets > 0)) return {};
        choice = (choice - by.diffuse) / by.facets;
        if (smooth()) return sample_smooth(o, choice, by.facets);
        result = sample_facets(o, choice, u);
    }
    if (!result) return {};
    return weighed(*result, upright_value(o, result->incoming, lobes));
}

CosineChoices PrincipledBsdf::cosine_choices(float outgoing, std::uint8_t lobes) const {
    if (!(lobes & this->lobes()) || tilted()) return {};
    const Chances by = chances(turned({0, 0, outgoing}) ? -outgoing : outgoing, lobes);
    const float begin = by.coat + by.sheen;
    return {begin, begin + (translucence > 0 ? by.diffuse * (1 - through_chance()) : by.diffuse)};
}

std::optional<BsdfSample> PrincipledBsdf::sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const {
    if (!(lobes & this->lobes()) || outgoing.z == 0) return {};
    const bool turn = turned(outgoing);
    if (turn) outgoing.z = -outgoing.z;
    const bool other = grooved() || tilted();
    auto result = other ? upright(turn).upright_sample(along_groove(groove, outgoing), choice, u, lobes)
                        : upright_sample(outgoing, choice, u, lobes);
    if (result && other) result->incoming = along_groove({groove.x, -groove.y}, result->incoming);
    if (result && turn) result->incoming.z = -result->incoming.z;
    return result;
}

}  // namespace lightnet
