// The principled material at a place.
#include <algorithm>
#include <cmath>

#include "core/scene/bsdf/albedos.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/bsdf/principled.hpp"

namespace lightnet {
namespace {

void set_grooves(const PrincipledGrooves& grooves, const MaterialInputs& inputs, PrincipledBsdf& model) {
    float strength = grooves.strength;
    model.groove = grooves.along;
    if (grooves.texture) {
        const Rgb map = inputs.colour(*grooves.texture);
        const Vec2 own{2 * map.r - 1, 2 * map.g - 1};
        const float size = std::sqrt(own.x * own.x + own.y * own.y);
        strength = std::min(1.0f, strength * map.b);
        if (size > 1e-3f)
            model.groove = {(grooves.along.x * own.x - grooves.along.y * own.y) / size,
                            (grooves.along.y * own.x + grooves.along.x * own.y) / size};
    }
    auto& [along, across, law] = model.facets;
    along = across + (1 - across) * strength * strength;
    if (!is_specular(along, across)) across = std::max(across, specular_alpha);
}

void set_film(const PrincipledFilm& film, const MaterialInputs& inputs, PrincipledBsdf& model) {
    const float at = film.thickness_texture ? std::min(1.0f, inputs.colour(*film.thickness_texture).r) : 1;
    model.film = {inputs.share(film.share, film.share_texture), film.eta, film.least + (film.most - film.least) * at};
    if (!(model.film.thickness > 0)) model.film.share = 0;
    if (model.film.share > 0) model.film_f0 = film_ceiling(model.film, model.f0);
}

void set_translucence(const PrincipledTranslucence& translucence, const MaterialInputs& inputs, PrincipledBsdf& model) {
    model.translucence = inputs.share(translucence.share, translucence.share_texture);
    model.passed = translucence.colour;
    if (translucence.colour_texture) model.passed *= inputs.colour(*translucence.colour_texture);
    model.passed = limited(model.passed);
}

}  // namespace

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
    if (grooves.strength > 0) set_grooves(grooves, inputs, model);
    if (film.share > 0) set_film(film, inputs, model);
    if (translucence.share > 0) set_translucence(translucence, inputs, model);
    if (!model.thin) model.dispersion = dispersion;
    model.coat = inputs.share(clearcoat, clearcoat_texture);
    model.coat_alpha = inputs.facets(clearcoat_roughness).alpha_u;
    return model;
}

}  // namespace lightnet
