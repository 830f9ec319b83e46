// Coats against walks of light between their two layers, one reflection after the other.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/math/samples.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/bsdf/coats.hpp"

namespace lightnet::coat_test {
namespace {

constexpr std::uint32_t tries = 1 << 15;

Vec3 from_above(float cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

/// Light of one direction, in and out again. `Base` is any model that reflects only.
template <class Base>
float walk(const DielectricBsdf& coat, const Base& base, CoatLayer layer, Vec3 outgoing, Samples samples) {
    const auto next = [&](const auto& model, Vec3 from) {
        const float choice = samples.next();
        return model.sample(from, choice, samples.next_2d(), lobe::all);
    };
    const auto first = next(coat, outgoing);
    if (!first) return 0;
    if (!first->transmitted) return first->weight.g;
    float weight = first->weight.g;
    Vec3 w = first->incoming;
    for (std::uint32_t bounce = 0; bounce < (layer.bounces ? layer.bounces : 200); ++bounce) {
        weight *= std::exp(-layer.thickness / -w.z);
        const auto below = next(base, -w);
        if (!below) return 0;
        weight *= below->weight.g * std::exp(-layer.thickness / below->incoming.z);
        const auto above = next(coat, -below->incoming);
        if (!above) return 0;
        weight *= above->weight.g;
        if (above->transmitted) return weight;
        w = above->incoming;
    }
    return 0;
}

template <class Base>
double walked_albedo(const DielectricBsdf& coat, const Base& base, CoatLayer layer, Vec3 outgoing) {
    double sum = 0;
    for (std::uint32_t i = 0; i < tries; ++i) sum += walk(coat, base, layer, outgoing, Samples(7, i));
    return sum / tries;
}

double albedo(const Bsdf::Model& model, Vec3 outgoing) {
    const Bsdf bsdf({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 1}, model);
    double sum = 0;
    for (std::uint32_t i = 0; i < tries; ++i) {
        Samples samples(9, i);
        const float choice = samples.next();
        if (const auto s = bsdf.sample(outgoing, choice, samples.next_2d(), lobe::all)) sum += s->weight.g;
    }
    return sum / tries;
}

struct Layers {
    float alpha, reflectance;
    CoatLayer layer{};
    float of_diffuse = 0.01f, of_metal = 0.015f;  // tolerances of the albedo, as shares
};
class OfACoat : public testing::TestWithParam<Layers> {};

TEST_P(OfACoat, OnADiffuseBaseTheAlbedoIsThatOfAWalkBetweenTheLayers) {
    const auto [alpha, reflectance, layer, tolerance, of_metal] = GetParam();
    const Microfacets facets{alpha, alpha};
    const Coat coat(1.5f, {facets}, layer), any(1.5f, {{}, true}, layer);
    const DiffuseBsdf base{{reflectance, reflectance, reflectance}};
    for (const float cosine : {0.95f, 0.6f, 0.25f, 0.1f}) {
        const double expected = walked_albedo({1.5f, facets}, base, layer, from_above(cosine));
        for (const Coat* one : {&coat, &any})
            EXPECT_NEAR(albedo(CoatedDiffuseBsdf{base.albedo, one, facets}, from_above(cosine)), expected,
                        (one == &any ? tolerance + 0.01f : tolerance) * expected)
                << "roughness " << alpha << ", cosine " << cosine;
    }
}

TEST_P(OfACoat, OnMetalTheAlbedoIsThatOfAWalkBetweenTheLayers) {
    const auto [alpha, reflectance, layer, of_diffuse, tolerance] = GetParam();
    const Microfacets above{alpha, alpha};
    const Coat coat(1.5f, {above}, layer);
    const Rgb k = absorption_for({reflectance, reflectance, reflectance});
    for (const Microfacets below : {Microfacets{0.1f, 0.1f}, Microfacets{0.3f, 0.3f}, Microfacets{}}) {
        const ConductorBsdf metal{{1, 1, 1}, k, below}, seen{{1, 1, 1}, k, seen_through(below, above, 1.5f)};
        const CoatedMetal both(coat, {above}, {below});
        for (const float cosine : {0.95f, 0.6f, 0.25f, 0.1f}) {
            const double expected = walked_albedo({1.5f, above}, metal, layer, from_above(cosine));
            EXPECT_NEAR(albedo(CoatedConductorBsdf{seen, &coat, above, &both, below}, from_above(cosine)), expected,
                        tolerance * expected)
                << "roughness " << alpha << " over " << below.alpha_u << ", cosine " << cosine;
        }
    }
}

// Of metal, the model takes Fresnel's term where single facets would mirror the light through the coat; very rough
// coats turn it far away from there.
INSTANTIATE_TEST_SUITE_P(Layers, OfACoat,
                         testing::Values(Layers{0, 0.7f}, Layers{0, 0.7f, {0.01f, 5}}, Layers{0, 0.95f, {0.01f, 2}},
                                         Layers{0, 0.8f, {0.3f, 0}}, Layers{0.05f, 0.7f, {}, 0.01f, 0.025f},
                                         Layers{0.1f, 0.7f, {0.01f, 5}}, Layers{0.1f, 0.95f, {0.01f, 2}},
                                         Layers{0.5f, 1}, Layers{0.3f, 0.8f, {0.01f, 5}, 0.01f, 0.04f},
                                         Layers{0.3f, 0.7f, {0.3f, 0}, 0.01f, 0.035f},
                                         Layers{0.6f, 0.5f, {0.01f, 5}, 0.01f, 0.1f}));

TEST(Coats, AreMadeOncePerKind) {
    Coats coats;
    const FacetRange rough{{0.2f, 0.2f}};
    const Coat& first = coats.coat(1.5f, rough, {0.01f, 5});
    EXPECT_EQ(&first, &coats.coat(1.5f, rough, {0.01f, 5}));
    EXPECT_NE(&first, &coats.coat(1.5f, rough, {0.01f, 4}));
    EXPECT_NE(&first, &coats.coat(1.5f, {{}, true}, {0.01f, 5}));
    EXPECT_NE(&first, &coats.coat(1.5f, {{0.2f, 0.2f, {FacetLaw::Normals::beckmann}}}, {0.01f, 5}));
    const CoatedMetal* over = coats.over_metal(first, rough, rough);
    EXPECT_EQ(over, coats.over_metal(first, rough, rough));
    EXPECT_NE(over, coats.over_metal(first, rough, {}));
    EXPECT_EQ(coats.over_metal(coats.coat(1.5f, {}, {}), {}, {}), nullptr);
}

}  // namespace
}  // namespace lightnet::coat_test
