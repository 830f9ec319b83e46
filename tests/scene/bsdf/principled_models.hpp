// What the principled model can be, by its numbers.
#pragma once

#include "core/scene/bsdf/principled.hpp"

namespace lightnet::models_test {

inline PrincipledBsdf principled(float metallic, float transmission, Microfacets facets, bool thin = true) {
    PrincipledBsdf model;
    model.base = {0.8f, 0.5f, 0.2f};
    model.metallic = metallic;
    model.transmission = transmission;
    model.facets = facets;
    model.f0 = {0.04f, 0.04f, 0.04f};
    model.thin = thin;
    return model;
}

inline PrincipledBsdf velvet() {
    PrincipledBsdf model = principled(0, 0, {0.8f, 0.8f});
    model.sheen = {0.9f, 0.6f, 0.7f};
    model.sheen_alpha = 0.2f;
    return model;
}

inline PrincipledBsdf everything(float coat_alpha) {
    PrincipledBsdf model = principled(0.3f, 0.4f, {0.2f, 0.35f}, false);
    model.sheen = {0.3f, 0.2f, 0.4f};
    model.sheen_alpha = 0.3f;
    model.coat = 0.7f;
    model.coat_alpha = coat_alpha;
    model.f0 = {0.02f, 0.03f, 0.04f};
    model.f90 = 0.9f;
    return model;
}

inline PrincipledBsdf filmed(PrincipledBsdf model, float share, float thickness) {
    model.film = {share, 1.33f, thickness};
    model.film_f0 = film_ceiling(model.film, model.f0);
    return model;
}

inline PrincipledBsdf dispersed(Microfacets facets) {
    PrincipledBsdf model = principled(0, 1, facets, false);
    model.dispersion = 0.06f;
    return model;
}

inline PrincipledBsdf leaf(PrincipledBsdf model, float share) {
    model.translucence = share;
    model.passed = {0.6f, 0.9f, 0.3f};
    return model;
}

inline PrincipledBsdf grooved(PrincipledBsdf model) {
    model.groove = {0.6f, 0.8f};
    return model;
}

/// Its coat has a normal of its own.
inline PrincipledBsdf tilted(PrincipledBsdf model, float coat_alpha) {
    model.coat = 0.8f;
    model.coat_alpha = coat_alpha;
    model.coat_up = normalize(Vec3{0.3f, -0.2f, 0.9f});
    return model;
}

}  // namespace lightnet::models_test
