// Coats against walks of light between their two layers, one reflection after the other.
#include <gtest/gtest.h>

#include <cmath>

#include "core/bsdf/bsdf.hpp"
#include "core/math/samples.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t tries = 1 << 14;

Vec3 from_above(float cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

/// Light of one direction, in and out again. `Base` is any model that reflects only.
template <class Base>
float walk(const DielectricBsdf& coat, const Base& base, Coat::Layer layer, Vec3 outgoing, Samples samples) {
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
double walked_albedo(const DielectricBsdf& coat, const Base& base, Coat::Layer layer, Vec3 outgoing) {
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
    Coat::Layer layer;
    float tolerance;  // of the albedo on a diffuse base, as a share
};
class OfACoat : public testing::TestWithParam<Layers> {};

TEST_P(OfACoat, OnADiffuseBaseTheAlbedoIsThatOfAWalkBetweenTheLayers) {
    const auto [alpha, reflectance, layer, tolerance] = GetParam();
    const Ggx facets{alpha, alpha};
    const Coat coat(1.5f, facets, layer);
    const DiffuseBsdf base{{reflectance, reflectance, reflectance}};
    for (const float cosine : {0.95f, 0.6f, 0.25f}) {
        const double expected = walked_albedo({1.5f, facets}, base, layer, from_above(cosine));
        EXPECT_NEAR(albedo(CoatedDiffuseBsdf{base.albedo, &coat, facets}, from_above(cosine)), expected,
                    tolerance * expected)
            << "roughness " << alpha << ", cosine " << cosine;
    }
}

TEST_P(OfACoat, OnMetalTheAlbedoIsThatOfAWalkBetweenTheLayers) {
    const auto [alpha, reflectance, layer, tolerance] = GetParam();
    const Ggx facets{alpha, alpha}, below{0.1f, 0.1f};
    const Coat coat(1.5f, facets, layer);
    const Rgb k = absorption_for({reflectance, reflectance, reflectance});
    const ConductorBsdf seen{{1, 1, 1}, k, CoatedConductorBsdf::seen_through(below, facets, 1.5f)};
    for (const float cosine : {0.95f, 0.6f, 0.25f}) {
        const double expected =
            walked_albedo({1.5f, facets}, ConductorBsdf{{1, 1, 1}, k, below}, layer, from_above(cosine));
        EXPECT_NEAR(albedo(CoatedConductorBsdf{seen, &coat, facets}, from_above(cosine)), expected,
                    (0.11 + tolerance) * expected)
            << "roughness " << alpha << ", cosine " << cosine;
    }
}

// Smooth coats on diffuse bases are exact. Rough ones keep the light that single scattering loses; on metal that is a
// little rough the series takes the directions of both ends for all that lie between.
INSTANTIATE_TEST_SUITE_P(Layers, OfACoat,
                         testing::Values(Layers{0, 0.7f, {}, 0.008f}, Layers{0, 0.7f, {0.01f, 5}, 0.008f},
                                         Layers{0, 0.95f, {0.01f, 2}, 0.008f}, Layers{0, 0.8f, {0.3f, 0}, 0.008f},
                                         Layers{0.1f, 0.7f, {0.01f, 5}, 0.06f}));

}  // namespace
}  // namespace lightnet
