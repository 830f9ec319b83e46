// The material of game engines and film studios: metal, plastic, glass and cloth by a few numbers.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/facets.hpp"
#include "core/scene/bsdf/material_inputs.hpp"
#include "core/scene/bsdf/microfacets.hpp"
#include "core/scene/bsdf/normal_map.hpp"
#include "core/scene/bsdf/scattering.hpp"
#include "core/scene/bsdf/seen.hpp"
#include "core/scene/bsdf/thin_film.hpp"

namespace lightnet {

/// glTF 2.0's metallic-roughness model (appendix B of its specification) with the extensions specular, ior,
/// transmission, volume, sheen, clearcoat, anisotropy, iridescence, dispersion and diffuse transmission. Its mixes and
/// layers are those of the specification; where that shares light between layers by a rule which can give more than it
/// got, or depends on the order of the two directions, a symmetric one by directional albedos stands here: never above
/// 1, and reciprocal.
struct PrincipledBsdf {
    static constexpr bool two_sided = false;  // but for solids that let light through, it is made so
    static constexpr bool chooses = true;
    Rgb base;
    float metallic = 0, transmission = 0;
    Microfacets facets{};
    float eta = 1.5f;  // inside over outside
    Rgb f0;            // of the dielectric's reflection, head-on
    float f90 = 1;     // and at grazing angles
    Rgb sheen;
    float sheen_alpha = 0.1f;
    float coat = 0, coat_alpha = 0;
    bool thin = true;
    Vec2 groove{1, 0};       // cosine and sine of the turn from the frame's x to the first of the facets' tangents
    ThinFilm film{};         // on the facets
    float film_f0 = 1;       // its film_ceiling() over f0
    float dispersion = 0;    // the index is eta - this for red, and eta + this for blue
    float translucence = 0;  // share of the diffuse base that lets light through instead
    Rgb passed;              // colour of that
    Vec3 coat_up{0, 0, 1};   // normal of the coat, unit

    bool smooth() const { return is_specular(facets.alpha_u, facets.alpha_v); }
    bool smooth_coat() const { return is_specular(coat_alpha, coat_alpha); }
    std::uint8_t lobes() const;
    CosineChoices cosine_choices(float outgoing, std::uint8_t lobes) const;
    BsdfValue evaluate(Vec3 outgoing, Vec3 incoming, std::uint8_t lobes) const;
    std::optional<BsdfSample> sample(Vec3 outgoing, float choice, Vec2 u, std::uint8_t lobes) const;

    // What the formulas of one point and of many are made of. Heights are the z of directions.

    /// With which probability each part is sampled, seen from that height.
    struct Chances {
        float coat = 0, sheen = 0, diffuse = 0, facets = 0;
    };
    Chances chances(float height, std::uint8_t lobes) const;
    /// Of the layers above the base: how much of the light to or from the base they leave.
    struct Layers {
        float below_coat = 1, below_sheen = 1;
    };
    Layers layers(float height) const;
    float plastic_share() const { return (1 - metallic) * (1 - transmission); }
    /// Share of light from that height that the dielectric's reflection leaves to the diffuse part below it.
    float passes(float height) const;
    /// Share of diffuse light that the dielectric's reflection leaves to the diffuse part below it.
    float passes_on_average() const;

private:
    bool turned(Vec3 outgoing) const { return outgoing.z < 0 && sheet(); }
    bool sheet() const { return thin || transmission == 0; }  // both sides look alike
    bool tilted() const { return coat_up.x != 0 || coat_up.y != 0; }
    bool grooved() const { return groove.x != 1; }
    bool plain_glass() const { return film.share == 0 && dispersion == 0; }
    PrincipledBsdf upright(bool turn) const;
    float index(std::size_t colour) const { return eta + (float(colour) - 1) * dispersion; }
    Rgb filmed(Rgb bare, Rgb below, float cosine) const;
    Rgb opaque_reflectance(float cosine) const;
    Rgb glass_mirror(float cosine) const;
    float ceiling_f0() const;
    float ceiling_f90() const { return film.share > 0 ? 1 : f90; }
    float through_chance() const;
    float alpha() const;
    float glass_share() const { return (1 - metallic) * transmission; }
    Rgb glass_tint() const;
    float glass_reflectance(float cosine) const;
    Rgb reflectance(float cosine) const;
    Rgb transmittance(float cosine) const;
    float dispersed_transmittance(float cosine, std::size_t colour) const;
    float reflection_chance(float cosine) const;
    float window_share(float height) const;
    Layers layers(float height, float above_coat) const;
    Layers layers(Vec3 direction) const;
    Layers layers(Vec3 outgoing, Vec3 incoming) const;
    Chances chances(const Layers& above, float height, std::uint8_t lobes) const;
    Chances chances(Vec3 outgoing, std::uint8_t lobes) const;
    void add_translucent(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances, BsdfValue& sum) const;
    void add_dispersed(Vec3 o, Vec3 i, float passes, const Chances& chances, BsdfValue& sum) const;
    void add_coat(Vec3 o, Vec3 i, const Chances& chances, BsdfValue& sum) const;
    std::optional<BsdfSample> sample_coat(Vec3 o, Vec2 u, float chance) const;
    void add_diffuse(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances, BsdfValue& sum) const;
    void add_glossy(Vec3 o, Vec3 i, const Layers& layers, const Chances& chances, BsdfValue& sum) const;
    BsdfValue upright_value(Vec3 o, Vec3 i, std::uint8_t lobes) const;
    std::optional<BsdfSample> upright_sample(Vec3 o, float choice, Vec2 u, std::uint8_t lobes) const;
    std::optional<BsdfSample> mirror(Vec3 o, const Rgb& value, float chance) const;
    std::optional<BsdfSample> window(Vec3 o, float choice, float chance) const;
    std::optional<BsdfSample> sample_smooth(Vec3 o, float choice, float chance) const;
    std::optional<BsdfSample> sample_facets(Vec3 o, float choice, Vec2 u) const;
};

/// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", between `f0` head-on and `f90`.
[[gnu::always_inline]] inline float schlick(float f0, float f90, float cosine) {
    cosine = cosine < 0 ? -cosine : cosine;
    cosine = cosine < 1 ? cosine : 1;
    const float rest = 1 - cosine, square = rest * rest;
    return f0 + (f90 - f0) * square * square * rest;
}
[[gnu::always_inline]] inline Rgb schlick(Rgb f0, float f90, float cosine) {
    return {schlick(f0.r, f90, cosine), schlick(f0.g, f90, cosine), schlick(f0.b, f90, cosine)};
}
/// What an opaque facet reflects, by the shares of metal and of plastic.
[[gnu::always_inline]] inline Rgb principled_mirror(Rgb base, float metallic, Rgb f0, float f90, float plastic,
                                                    float cosine) {
    return schlick(base, 1, cosine) * metallic + schlick(f0, f90, cosine) * plastic;
}
inline constexpr float principled_coat_f0 = 0.04f;  // its index is 1.5
/// The reflection of a clear coat.
[[gnu::always_inline]] inline float principled_coat(float coat, float cosine) {
    return coat * schlick(principled_coat_f0, 1, cosine);
}
/// The diffuse base, of which `share` counts, below the dielectric's reflection. Kelemen and Szirmay-Kalos 2001:
/// symmetric, and the base gets all that the reflection leaves.
[[gnu::always_inline]] inline Rgb principled_base(Rgb base, float share, float passes_out, float passes_in,
                                                  float passes_on_average, float cosine) {
    return base * (share * (passes_out * passes_in / passes_on_average) * (cosine * inverse_pi));
}

/// An opaque one without cloth, films and grooves from one direction (see seen.hpp).
struct SeenPrincipled {
    using Model = PrincipledBsdf;
    FacetsOf<GgxLaw> facets, coat_facets;
    Rgb base, f0;
    float f90, metallic, plastic, coat;
    float by_coat, by_base, by_facets;  // chances
    float left;                         // by the coat
    float passes, passes_on_average;
    float height;                       // of outgoing
    std::uint32_t smooth, smooth_coat;  // as Model has them

    static SeenPrincipled of(const Model& model, float outgoing, std::uint8_t lobes);
    struct Arriving {
        float left, passes;
    };
    static Arriving arriving(const Model& model, float incoming);
    template <bool>
    [[gnu::always_inline]] BsdfValue value(Vec3 outgoing, Vec3 incoming, const Arriving& in) const {
        const float below = left < in.left ? left : in.left;
        const Rgb by_cosine = principled_base(base, plastic * below, passes, in.passes, passes_on_average, incoming.z);
        const float base_pdf = by_base * (incoming.z * inverse_pi);
        const auto [value, pdf, cosine] = reflection(facets, outgoing, incoming);
        const Rgb gloss = reflected(cosine) * (value * below);
        const auto [above, above_pdf, above_cosine] = reflection(coat_facets, outgoing, incoming);
        const float by_varnish = principled_coat(coat, above_cosine) * above;
        const bool rough_coat = (coat > 0) & (smooth_coat == 0);
        const auto sum = [&](float one, float another) {
            const float both = one + (smooth ? 0 : another);
            return both + (rough_coat ? by_varnish : 0);
        };
        const float own_pdf = by_facets * pdf, both_pdf = base_pdf + (smooth ? 0 : own_pdf);
        return {{sum(by_cosine.r, gloss.r), sum(by_cosine.g, gloss.g), sum(by_cosine.b, gloss.b)},
                both_pdf + (rough_coat ? by_coat * above_pdf : 0)};
    }
    template <bool>
    [[gnu::always_inline]] Proposal propose(Vec3 outgoing, float choice, Vec2 u) const {
        const bool above = choice < by_coat, below = choice - by_coat < by_base;
        const float alpha = above ? coat_facets.alpha_u : facets.alpha_u;
        const std::uint32_t facets_left = by_facets > 0;
        const bool mirrors = (above ? smooth_coat : smooth & facets_left) != 0;
        const Vec3 by_alpha = reflected_by(FacetsOf<GgxLaw>{alpha, alpha}, outgoing, u);
        const Vec3 gloss = chosen(mirrors, Vec3{-outgoing.x, -outgoing.y, outgoing.z}, by_alpha);
        const Vec3 by_facets_left{gloss.x, gloss.y, facets_left ? gloss.z : 0};
        const Vec3 own = chosen(below, cosine_hemisphere(u), by_facets_left);
        const std::uint32_t gloss_lobe = mirrors ? lobe::specular : lobe::glossy;
        const std::uint32_t own_lobe = below ? std::uint32_t{lobe::diffuse} : gloss_lobe;
        return {chosen(above, gloss, own), above ? gloss_lobe : own_lobe};
    }
    [[gnu::always_inline]] Rgb mirrored(float choice) const {
        const float above = principled_coat(coat, height) / by_coat;
        return chosen(choice < by_coat, Rgb{above, above, above}, reflected(height) * left / by_facets);
    }
    CosineChoices cosine_choices() const { return {by_coat, by_coat + by_base}; }
    [[gnu::always_inline]] Rgb reflected(float cosine) const {
        return principled_mirror(base, metallic, f0, f90, plastic, cosine);
    }
};
inline SeenPrincipled SeenPrincipled::of(const Model& model, float outgoing, std::uint8_t lobes) {
    const auto chances = model.chances(outgoing, lobes);
    const float plastic = model.plastic_share(), left = model.layers(outgoing).below_coat;
    const float passes = plastic > 0 ? model.passes(outgoing) : 0, on_average = model.passes_on_average();
    return {.facets = model.facets.of<GgxLaw>(),
            .coat_facets = {model.coat_alpha, model.coat_alpha},
            .base = model.base,
            .f0 = model.f0,
            .f90 = model.f90,
            .metallic = model.metallic,
            .plastic = plastic,
            .coat = model.coat,
            .by_coat = chances.coat,
            .by_base = chances.diffuse,
            .by_facets = chances.facets,
            .left = left,
            .passes = passes,
            .passes_on_average = on_average,
            .height = outgoing,
            .smooth = model.smooth(),
            .smooth_coat = model.smooth_coat()};
}

inline SeenPrincipled::Arriving SeenPrincipled::arriving(const Model& model, float incoming) {
    return {model.coat > 0 ? model.layers(incoming).below_coat : 1,
            model.plastic_share() > 0 ? model.passes(incoming) : 0};
}

/// KHR_materials_anisotropy.
struct PrincipledGrooves {
    float strength = 0;                  // how much rougher facets are along their first tangent: α² … 1
    Vec2 along{1, 0};                    // cosine and sine of its turn from the direction in which u grows
    std::optional<TextureId> texture{};  // turns it by red and green, -1 … 1, and times the strength by blue
};
void visit_members(Is<PrincipledGrooves> auto& grooves, const auto& visit) {
    auto& [strength, along, texture] = grooves;
    visit(strength, along, texture);
}

/// KHR_materials_iridescence.
struct PrincipledFilm {
    float share = 0, eta = 1.3f;
    float least = 100, most = 400;  // nanometres, where the texture of its thickness is 0 and 1; without one the latter
    std::optional<TextureId> share_texture{}, thickness_texture{};
};
void visit_members(Is<PrincipledFilm> auto& film, const auto& visit) {
    auto& [share, eta, least, most, share_texture, thickness_texture] = film;
    visit(share, eta, least, most, share_texture, thickness_texture);
}

/// KHR_materials_diffuse_transmission.
struct PrincipledTranslucence {
    float share = 0;
    Rgb colour{1, 1, 1};
    std::optional<TextureId> share_texture{}, colour_texture{};
};
void visit_members(Is<PrincipledTranslucence> auto& translucence, const auto& visit) {
    auto& [share, colour, share_texture, colour_texture] = translucence;
    visit(share, colour, share_texture, colour_texture);
}

/// Where the coat's normal is another than the surface's.
struct PrincipledCoatNormal {
    bool own = false;                // it does not follow the material's bumps
    std::optional<NormalMap> map{};  // but this normal map
};
void visit_members(Is<PrincipledCoatNormal> auto& normal, const auto& visit) {
    auto& [own, map] = normal;
    visit(own, map);
}

/// The principled model of Burley (2012, 2015), of which glTF's metallic-roughness model with its extensions is a part.
/// Numbers are 0 … 1 where nothing else is said; a texture multiplies.
struct PrincipledMaterial {
    static constexpr const char* name = "principled";
    TextureId base_colour = 0;
    float metallic = 0, transmission = 0;
    std::optional<TextureId> metallic_texture{}, transmission_texture{};
    Roughness roughness{0.5f, 0.5f, {}, Roughness::Means::square};
    float eta = 1.5f;
    float specular = 1;            // times the dielectric reflection
    Rgb specular_colour{1, 1, 1};  // of it, head-on; may exceed 1
    std::optional<TextureId> specular_texture{}, specular_colour_texture{};
    float sheen = 0, sheen_roughness = 0.3f;
    Rgb sheen_colour{1, 1, 1};
    std::optional<TextureId> sheen_texture{}, sheen_roughness_texture{};  // the first has colours
    float clearcoat = 0;
    std::optional<TextureId> clearcoat_texture{};
    Roughness clearcoat_roughness{0.03f, 0.03f, {}, Roughness::Means::square};
    bool thin = true;  // of transmission: a pane rather than a solid
    PrincipledGrooves grooves{};
    PrincipledFilm film{};
    float dispersion = 0;  // half of what blue's index is above red's
    PrincipledTranslucence translucence{};
    PrincipledCoatNormal coat_normal{};

    Transparency transparency() const {
        if (!(transmission > 0) && !(translucence.share > 0)) return Transparency::opaque;
        return thin ? Transparency::sheet : Transparency::solid;
    }
    /// Opaque, and without cloth and films.
    bool plain() const {
        return !(transmission > 0) && !(sheen > 0) && !(film.share > 0) && !(translucence.share > 0) &&
               !(grooves.strength > 0);
    }
    PrincipledBsdf at(const MaterialInputs& inputs) const;
};
void visit_members(Is<PrincipledMaterial> auto& material, const auto& visit) {
    auto& [base_colour, metallic, transmission, metallic_texture, transmission_texture, roughness, eta, specular,
           specular_colour, specular_texture, specular_colour_texture, sheen, sheen_roughness, sheen_colour,
           sheen_texture, sheen_roughness_texture, clearcoat, clearcoat_texture, clearcoat_roughness, thin, grooves,
           film, dispersion, translucence, coat_normal] = material;
    visit(base_colour, metallic, transmission, metallic_texture, transmission_texture, roughness, eta, specular,
          specular_colour, specular_texture, specular_colour_texture, sheen, sheen_roughness, sheen_colour,
          sheen_texture, sheen_roughness_texture, clearcoat, clearcoat_texture, clearcoat_roughness, thin, grooves,
          film, dispersion, translucence, coat_normal);
}

}  // namespace lightnet
