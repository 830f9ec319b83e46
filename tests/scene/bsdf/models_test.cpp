// What holds for every model of scattering.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <type_traits>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "tests/scene/bsdf/hair_models.hpp"
#include "tests/scene/bsdf/measured_models.hpp"
#include "tests/scene/bsdf/principled_models.hpp"

namespace lightnet::models_test {
namespace {

constexpr FacetLaw beckmann{FacetLaw::Normals::beckmann},
    mitsubas{FacetLaw::Normals::beckmann, FacetLaw::Masking::independent};
const FacetRange any_ggx{{}, true};

// Their tables take a tenth of a second each, so only tests that look at them make them.
const Coat& smooth_coat() {
    static const Coat coat(1.5f, {});
    return coat;
}
const Coat& rough_coat() {
    static const Coat coat(1.5f, {{0.3f, 0.3f}});
    return coat;
}
const Coat& any_coat() {
    static const Coat coat(1.5f, any_ggx);
    return coat;
}
const Coat& grooved_coat() {
    static const Coat coat(1.5f, {{0.1f, 0.5f}});
    return coat;
}
const Coat& beckmann_coat() {
    static const Coat coat(1.5f, {{0.3f, 0.3f, mitsubas}});
    return coat;
}
const CoatedMetal& mirror_below() {
    static const CoatedMetal metal(smooth_coat(), {}, {});
    return metal;
}
const CoatedMetal& metal_below() {
    static const CoatedMetal metal(smooth_coat(), {}, {{0.2f, 0.2f}});
    return metal;
}
const CoatedMetal& grooves_below() {
    static const CoatedMetal metal(rough_coat(), {{0.3f, 0.3f}}, {{0.2f, 0.4f}});
    return metal;
}
const CoatedMetal& any_below() {
    static const CoatedMetal metal(any_coat(), any_ggx, any_ggx);
    return metal;
}

const ConductorBsdf copper{{0.2f, 0.9f, 1.1f}, {3.9f, 2.4f, 2.2f}};

Bsdf::Model lacquered(const Coat& coat, const CoatedMetal& both, Microfacets below, Microfacets above = {}) {
    const ConductorBsdf metal{copper.eta / 1.5f, copper.k / 1.5f, seen_through(below, above, 1.5f)};
    return CoatedConductorBsdf{metal, &coat, above, &both, below};
}

// Its parts add up; with a bright base that would be more than it got.
BurleyBsdf burley(Microfacets facets, float transmission = 0, bool thin = false) {
    BurleyBsdf model;
    model.base = {0.6f, 0.4f, 0.2f};
    model.transmission = transmission;
    model.facets = facets;
    model.window = {facets.alpha_u / 2, facets.alpha_v / 2, facets.law};
    model.matt.roughness = std::sqrt(std::sqrt(facets.alpha_u * facets.alpha_v));
    model.thin = thin;
    return model;
}

BurleyBsdf all_of_burley(bool thin) {
    BurleyBsdf model = burley({0.2f, 0.35f, {FacetLaw::Normals::ggx, FacetLaw::Masking::independent}}, 0.4f, thin);
    model.tint = 0.3f;
    model.matt.flatness = 0.4f, model.matt.sheen = 0.5f, model.matt.sheen_tint = 0.5f;
    if (thin)
        model.matt.through = 0.3f;
    else
        model.metallic = 0.3f, model.coat = {0.8f, 0.1f};
    return model;
}

/// A model that is made when it is wanted.
struct Made {
    std::function<Bsdf::Model()> make;
    template <class Model>
    Made(Model model) {
        if constexpr (std::is_invocable_v<Model>)
            make = model;
        else
            make = [model] { return Bsdf::Model(model); };
    }
};

struct Case {
    const char* name;
    Made model;
    std::optional<Made> second{};  // mixed with the first
    friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

    Bsdf on(const Frame& frame) const {
        const Bsdf first(frame, frame.z, model.make());
        if (!second) return first;
        return {frame.z, {{first, 0.3f}, {Bsdf(frame, frame.z, second->make()), 0.7f}}};
    }
};

const std::vector<Case> cases{
    {"diffuse", DiffuseBsdf{{0.8f, 0.5f, 0.2f}}},
    {"rough_diffuse", RoughDiffuseBsdf{{0.8f, 0.5f, 0.2f}, 0.4f}},
    {"roughest_diffuse", RoughDiffuseBsdf{{1, 1, 1}, 1}},
    {"diffuse_transmission", DiffuseTransmissionBsdf{{0.5f, 0.3f, 0.1f}, {0.2f, 0.5f, 0.3f}}},
    {"mirror", ConductorBsdf{{1, 1, 1}, absorption_for({0.9f, 0.8f, 0.7f}), {}}},
    {"rough_conductor", ConductorBsdf{copper.eta, copper.k, {0.3f, 0.3f}}},
    {"anisotropic_conductor", ConductorBsdf{copper.eta, copper.k, {0.1f, 0.5f}}},
    {"beckmann_conductor", ConductorBsdf{copper.eta, copper.k, {0.3f, 0.3f, beckmann}}},
    {"very_rough_beckmann_conductor", ConductorBsdf{copper.eta, copper.k, {0.9f, 0.9f, beckmann}}},
    {"anisotropic_beckmann_conductor", ConductorBsdf{copper.eta, copper.k, {0.1f, 0.5f, mitsubas}}},
    {"conductor_of_independent_masking",
     ConductorBsdf{copper.eta, copper.k, {0.4f, 0.4f, {FacetLaw::Normals::ggx, FacetLaw::Masking::independent}}}},
    {"tinted_conductor", ConductorBsdf{copper.eta, copper.k, {0.6f, 0.6f}, {0.5f, 0.7f, 1}}},
    {"glass", DielectricBsdf{1.5f, {}}},
    {"rough_glass", DielectricBsdf{1.5f, {0.3f, 0.3f}}},
    {"beckmann_glass", DielectricBsdf{1.5f, {0.3f, 0.3f, mitsubas}}},
    {"anisotropic_glass", DielectricBsdf{1.5f, {0.15f, 0.4f}}},
    {"tinted_glass", DielectricBsdf{1.5f, {}, {{0.5f, 0.6f, 0.7f}, {0.9f, 0.8f, 0.3f}}}},
    {"tinted_rough_glass", DielectricBsdf{1.33f, {0.3f, 0.3f}, {{0.5f, 0.6f, 0.7f}, {0.9f, 0.8f, 0.3f}}}},
    {"pane", ThinDielectricBsdf{1.5f}},
    {"tinted_pane", ThinDielectricBsdf{1.5f, {{0.5f, 0.6f, 0.7f}, {0.9f, 0.8f, 0.3f}}}},
    {"plastic",
     [] {
         return CoatedDiffuseBsdf{{0.8f, 0.5f, 0.2f}, &smooth_coat()};
     }},
    {"rough_plastic",
     [] {
         return CoatedDiffuseBsdf{{0.8f, 0.5f, 0.2f}, &rough_coat(), {0.3f, 0.3f}};
     }},
    {"beckmann_plastic",
     [] {
         return CoatedDiffuseBsdf{{0.8f, 0.5f, 0.2f}, &beckmann_coat(), {0.3f, 0.3f, mitsubas}};
     }},
    {"plastic_of_any_roughness",
     [] {
         return CoatedDiffuseBsdf{{0.8f, 0.5f, 0.2f}, &any_coat(), {0.2f, 0.2f}, {0.9f, 0.8f, 0.7f}};
     }},
    {"plastic_of_one_hue",
     [] {
         return CoatedDiffuseBsdf{{0.8f, 0.5f, 0.2f}, &smooth_coat(), {}, {1, 1, 1}, false};
     }},
    {"plastic_with_grooves",
     [] {
         return CoatedDiffuseBsdf{{0.8f, 0.5f, 0.2f}, &grooved_coat(), {0.1f, 0.5f}};
     }},
    {"lacquered_mirror", [] { return lacquered(smooth_coat(), mirror_below(), {}); }},
    {"lacquered_metal",
     [] {
         return lacquered(smooth_coat(), metal_below(), {0.2f, 0.2f});
     }},
    {"matt_lacquered_metal",
     [] {
         return lacquered(rough_coat(), grooves_below(), {0.2f, 0.4f}, {0.3f, 0.3f});
     }},
    {"lacquered_metal_of_any_roughness",
     [] {
         return lacquered(any_coat(), any_below(), {0.1f, 0.1f}, {0.25f, 0.25f});
     }},
    {"principled_plastic", principled(0, 0, {0.25f, 0.25f})},
    {"principled_smooth_plastic", principled(0, 0, {})},
    {"principled_metal", principled(1, 0, {0.15f, 0.4f})},
    {"principled_mirror", principled(1, 0, {})},
    {"principled_half_metal", principled(0.5f, 0, {0.4f, 0.4f})},
    {"principled_glass", principled(0, 1, {}, false)},
    {"principled_rough_glass", principled(0, 1, {0.3f, 0.3f}, false)},
    {"principled_pane", principled(0, 1, {})},
    {"principled_rough_pane", principled(0, 1, {0.3f, 0.3f})},
    {"velvet", velvet()},
    {"everything", everything(0.1f)},
    {"everything_smoothly_coated", everything(0)},
    {"grooved_metal", grooved(principled(1, 0, {0.5f, 0.1f}))},
    {"grooved_plastic", grooved(principled(0, 0, {1, 0.04f}))},
    {"grooved_rough_glass", grooved(principled(0, 1, {0.4f, 0.15f}, false))},
    {"filmed_mirror", filmed(principled(1, 0, {}), 1, 300)},
    {"filmed_metal", filmed(principled(1, 0, {0.3f, 0.3f}), 0.7f, 550)},
    {"filmed_plastic", filmed(principled(0, 0, {0.25f, 0.25f}), 1, 400)},
    {"filmed_smooth_plastic", filmed(principled(0, 0, {}), 1, 250)},
    {"filmed_glass", filmed(principled(0, 1, {}, false), 1, 350)},
    {"filmed_rough_glass", filmed(principled(0, 1, {0.3f, 0.3f}, false), 0.8f, 350)},
    {"soap_bubble", filmed(principled(0, 1, {}), 1, 200)},
    {"dispersing_glass", dispersed({})},
    {"dispersing_rough_glass", dispersed({0.3f, 0.3f})},
    {"leaf", leaf(principled(0, 0, {0.3f, 0.3f}), 0.6f)},
    {"smooth_leaf", leaf(principled(0.2f, 0, {}), 1)},
    {"translucent_solid", leaf(principled(0, 0, {0.4f, 0.4f}, false), 0.5f)},
    {"coated_leaf", leaf(everything(0.1f), 0)},
    {"leaf_with_a_window", leaf(principled(0, 0.4f, {0.3f, 0.3f}), 0.5f)},
    {"coat_of_another_normal", tilted(principled(0, 0, {0.4f, 0.4f}), 0.15f)},
    {"smooth_coat_of_another_normal", tilted(grooved(principled(1, 0, {0.4f, 0.2f})), 0)},
    {"all_of_it", tilted(grooved(filmed(leaf(principled(0.3f, 0.2f, {0.5f, 0.2f}), 0.5f), 0.6f, 450)), 0.2f)},
    {"burley_matt", burley({0.25f, 0.25f})},
    {"burley_smooth", burley({})},
    {"burley_glass", burley({}, 1)},
    {"burley_rough_glass", burley({0.3f, 0.3f}, 1)},
    {"burley_pane", burley({}, 1, true)},
    {"burley_solid", all_of_burley(false)},
    {"burley_sheet", all_of_burley(true)},
    {"measured_metal", [] { return measured_metal(); }},
    {"measured_grooves", [] { return measured_grooves(); }},
    {"hair", hair_of({0.3f, 0.3f, 2}, {0.3f, 0.6f, 1.2f})},
    {"flat_rough_hair_of_large_scales", hair_of({0.9f, 0.95f, 20}, {0, 0.1f, 0.5f}, -0.8f)},
    {"mixture", DiffuseBsdf{{0.8f, 0.5f, 0.2f}}, ConductorBsdf{copper.eta, copper.k, {0.3f, 0.3f}}},
    {"mixture_with_a_mirror", RoughDiffuseBsdf{{0.8f, 0.5f, 0.2f}, 0.4f}, ConductorBsdf{copper.eta, copper.k, {}}},
    {"mixture_with_nothing",
     [] {
         return CoatedDiffuseBsdf{{0.8f, 0.5f, 0.2f}, &smooth_coat()};
     },
     ThinDielectricBsdf{1}},
};

class EveryModel : public testing::TestWithParam<Case> {
protected:
    // The shading frame is turned, so that world and local coordinates differ.
    const Frame frame = Frame::around(normalize({0.3f, -0.5f, 0.8f}));
    const Bsdf bsdf = GetParam().on(frame);

    Vec3 direction(float cosine, float turn) const {
        const float sine = std::sqrt(1 - cosine * cosine);
        return normalize(frame.to_world({sine * std::cos(turn), sine * std::sin(turn), cosine}));
    }
    std::vector<Vec3> outgoing() const {
        return {direction(0.95f, 0.3f), direction(0.5f, 2), direction(0.2f, 4), direction(-0.6f, 1)};
    }
};

// Sum over a grid of equal solid angles.
template <class Function>
double integral(const Frame& frame, Function value, int rows = 240, int columns = 480) {
    double sum = 0;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const float z = -1 + 2 * (float(i) + 0.5f) / float(rows);
            const float turn = 2 * pi * (float(j) + 0.5f) / float(columns), sine = std::sqrt(1 - z * z);
            sum += value(normalize(frame.to_world({sine * std::cos(turn), sine * std::sin(turn), z})));
        }
    return sum * 4 * pi / rows / columns;
}

constexpr std::uint32_t tries = 1 << 15;

std::optional<BsdfSample> draw(const Bsdf& bsdf, Vec3 outgoing, std::uint32_t i, std::uint8_t lobes = lobe::all) {
    Samples samples(11, i);
    const float choice = samples.next();
    return bsdf.sample(outgoing, choice, samples.next_2d(), lobes);
}

TEST_P(EveryModel, NeverGivesMoreThanItGot) {
    for (const Vec3 o : outgoing()) {
        double red = 0, green = 0, blue = 0;
        for (std::uint32_t i = 0; i < tries; ++i)
            if (const auto s = draw(bsdf, o, i)) {
                ASSERT_TRUE(finite(s->weight) && finite(s->incoming) && s->pdf >= 0);
                const float squeezed = s->eta * s->eta;
                red += s->weight.r * squeezed, green += s->weight.g * squeezed, blue += s->weight.b * squeezed;
            }
        EXPECT_LE(std::max({red, green, blue}) / tries, 1.002);
    }
}

TEST_P(EveryModel, SamplesWithTheDensityThatItStates) {
    for (const Vec3 o : outgoing()) {
        std::uint32_t found = 0;
        for (std::uint32_t i = 0; i < tries; ++i)
            if (const auto s = draw(bsdf, o, i); s && s->lobe != lobe::specular) ++found;
        const double stated = integral(frame, [&](Vec3 i) { return bsdf.pdf(o, i, lobe::all); });
        EXPECT_NEAR(double(found) / tries, stated, 5e-3);
    }
}

TEST_P(EveryModel, AlbedoBySamplesIsTheAlbedoByQuadrature) {
    for (const Vec3 o : outgoing()) {
        double sum = 0;
        for (std::uint32_t i = 0; i < tries; ++i)
            if (const auto s = draw(bsdf, o, i); s && s->lobe != lobe::specular) sum += s->weight.g;
        const double stated = integral(frame, [&](Vec3 i) { return bsdf.evaluate(o, i, lobe::all).g; });
        EXPECT_NEAR(sum / tries, stated, 5e-3);
    }
}

TEST_P(EveryModel, WeightIsValueOverDensity) {
    for (const Vec3 o : outgoing())
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const auto s = draw(bsdf, o, i);
            if (!s || s->lobe == lobe::specular || s->pdf < 1e-4f) continue;
            const auto [value, pdf] = bsdf.value_and_pdf(o, s->incoming, lobe::all);
            EXPECT_NEAR(pdf / s->pdf, 1, 0.02);  // directions went to world space and back
            EXPECT_NEAR(s->weight.r * s->pdf, value.r, 0.02f * value.r + 1e-5f);
            EXPECT_EQ(s->transmitted, dot(s->incoming, frame.z) * dot(o, frame.z) < 0);
        }
}

// Pearson's test on cells of equal solid angle; cells with few expected samples are put together.
TEST_P(EveryModel, PassesTheChiSquareTest) {
    constexpr int rows = 20, columns = 20, fine = 16;
    for (const Vec3 o : outgoing()) {
        std::vector<double> seen(rows * columns), expected(rows * columns);
        for (std::uint32_t i = 0; i < tries; ++i) {
            // independent numbers: stratified ones would fit too well
            const auto u = [&](Key k) { return float(child(k, i) >> 40) * 0x1p-24f; };
            const auto s = bsdf.sample(o, u(1), {u(2), u(3)}, lobe::all);
            if (!s || s->lobe == lobe::specular) continue;
            const Vec3 w = frame.to_local(s->incoming);
            const int row = std::clamp(int((w.z + 1) / 2 * rows), 0, rows - 1);
            const float turn = std::atan2(w.y, w.x);
            ++seen[row * columns +
                   std::clamp(int((turn < 0 ? turn + 2 * pi : turn) / (2 * pi) * columns), 0, columns - 1)];
        }
        for (int i = 0; i < rows * fine; ++i)
            for (int j = 0; j < columns * fine; ++j) {
                const float z = -1 + 2 * (float(i) + 0.5f) / (rows * fine), sine = std::sqrt(1 - z * z);
                const float turn = 2 * pi * (float(j) + 0.5f) / (columns * fine);
                const Vec3 w = normalize(frame.to_world({sine * std::cos(turn), sine * std::sin(turn), z}));
                expected[i / fine * columns + j / fine] +=
                    double{bsdf.pdf(o, w, lobe::all)} * 4 * pi / (rows * columns * fine * fine) * tries;
            }
        double chi = 0, rest_seen = 0, rest_expected = 0;
        int cells = 0;
        for (std::size_t c = 0; c < seen.size(); ++c) {
            rest_seen += seen[c];
            rest_expected += expected[c];
            if (rest_expected < 20) continue;
            chi += (rest_seen - rest_expected) * (rest_seen - rest_expected) / rest_expected;
            ++cells;
            rest_seen = rest_expected = 0;
        }
        EXPECT_LE(chi, cells + 5 * std::sqrt(2.0 * cells) + 10) << cells << " cells";
    }
}

TEST_P(EveryModel, IsReciprocal) {
    const Bsdf::Model model = GetParam().model.make();
    if (const auto* many = std::get_if<PrincipledBsdf>(&model); many && many->coat_up.x != 0)
        return;  // against the surface's normal no other normal's reflection is
    if (std::holds_alternative<MeasuredBsdf>(model)) return;  // as far as what was measured is: see measured_test.cpp
    if (std::holds_alternative<HairBsdf>(model)) return;      // as a whole, not at a point: see hair_test.cpp
    for (std::uint32_t k = 0; k < 2000; ++k) {
        Samples samples(5, k);
        const Vec3 a = sphere(samples.next_2d()), b = sphere(samples.next_2d());
        const float cos_a = std::fabs(dot(a, frame.z)), cos_b = std::fabs(dot(b, frame.z));
        if (cos_a < 0.05f || cos_b < 0.05f) continue;
        // radiance in glass is larger by η², so f/η² is what both ways share
        const auto scale = [&](Vec3 w) {
            const auto* glass = std::get_if<DielectricBsdf>(&model);
            const auto* many = std::get_if<PrincipledBsdf>(&model);
            const bool solid = many && !many->thin && many->transmission > 0;
            const auto* burley = std::get_if<BurleyBsdf>(&model);
            const float bent = burley && !burley->thin ? burley->eta : 1;
            const float eta = glass ? glass->eta : solid ? many->eta - many->dispersion : bent;  // of red
            return dot(w, frame.z) < 0 ? eta * eta : 1.0f;
        };
        const float there = bsdf.evaluate(a, b, lobe::all).r / cos_b / scale(a);
        const float back = bsdf.evaluate(b, a, lobe::all).r / cos_a / scale(b);
        EXPECT_NEAR(there, back, 2e-3f * there + 1e-5f);
    }
}

TEST_P(EveryModel, IsTheSumOfItsLobes) {
    for (std::uint32_t k = 0; k < 500; ++k) {
        Samples samples(6, k);
        const Vec3 a = sphere(samples.next_2d()), b = sphere(samples.next_2d());
        const Rgb sum = bsdf.evaluate(a, b, lobe::diffuse) + bsdf.evaluate(a, b, lobe::glossy);
        EXPECT_FLOAT_EQ(sum.r, bsdf.evaluate(a, b, lobe::all).r);
        EXPECT_TRUE(is_black(bsdf.evaluate(a, b, lobe::specular)));
        EXPECT_EQ(bsdf.pdf(a, b, lobe::specular), 0);
    }
}

TEST_P(EveryModel, SamplesOnlyTheLobesAskedFor) {
    for (const std::uint8_t mask : {lobe::diffuse, lobe::glossy, lobe::specular})
        for (std::uint32_t i = 0; i < 200; ++i) {
            const auto s = draw(bsdf, direction(0.7f, 1), i, mask);
            EXPECT_TRUE(!s || s->lobe == mask);
            EXPECT_TRUE(!s || (bsdf.lobes() & mask));
        }
}

INSTANTIATE_TEST_SUITE_P(Models, EveryModel, testing::ValuesIn(cases),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace lightnet::models_test
