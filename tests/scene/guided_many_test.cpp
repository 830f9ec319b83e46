// What a guide makes of many points at once is what it makes of each of them alone: to the same directions, and with
// the same weights but for rounding.
#include <gtest/gtest.h>

#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/estimate/path_vertices.hpp"
#include "core/scene/direct_light.hpp"
#include "tests/scene/many_surfaces.hpp"

namespace lightnet::guided_many_test {
namespace {

using namespace test;

struct Walk {
    Hit hit;
    Vec3 outgoing;
    const Rgb* inside;
    float choice;
    Vec2 numbers;
};

std::vector<Walk> some_walks(const Scene& scene) {
    static const Rgb absorption{0.1f, 0.2f, 0.3f};
    std::vector<Walk> walks;
    for (const Hit& hit : some_hits(scene)) {
        Samples samples(9, std::uint32_t(walks.size()));
        const Vec3 outgoing = sphere(samples.next_2d());
        const Rgb* inside = walks.size() % 7 ? nullptr : &absorption;
        walks.push_back({hit, outgoing, inside, samples.next(), samples.next_2d()});
    }
    return walks;
}

GuideSide side_of(const Walk& walk, const SurfacePoint& point, const Bsdf& bsdf) {
    return GuideSide::of(point.normal, bsdf.shading().z, walk.outgoing);
}

// Knows most places, where most light comes from one side.
LightGuide guide_of(const Scene& scene, const std::vector<Walk>& walks) {
    std::vector<GuideRecord> records;
    for (std::uint32_t i = 0; i < 60000; ++i) {
        const Walk& walk = walks[i % walks.size()];
        Samples samples(4, i);
        const SurfacePoint point = scene.surface(walk.hit);
        const Bsdf bsdf = scene.bsdf(point);
        const std::uint32_t turn = LightGuide::turn_of(side_of(walk, point, bsdf));
        if (turn % 5 == 3) continue;
        const Vec2 place = samples.next_2d();
        const GuideStep step{point.position, 1, turn, place};
        records.emplace_back(step, place.x < 0.3f ? 1.0f : 0.02f);
    }
    OneBuilder alone;
    return LightGuide(records, alone);
}

void expect_near(Rgb it, Rgb one) {
    for (const auto channel : {&Rgb::r, &Rgb::g, &Rgb::b})
        EXPECT_NEAR(it.*channel, one.*channel, 1e-4f * one.*channel + 1e-6f);
}

// Of all materials.
TEST(GuidedMany, StopsTellEachWalkWhatOneIsTold) {
    SceneData data = everything();
    add(data, quad({-1, -1, 4}, {0, 2, 0}, {2, 0, 0}), diffuse(data, 0)).emission = AreaEmission{{3, 2, 1}};
    data.environments.push_back({{1, 1, 1}, squares_of_sky()});
    const Scene scene(data);
    const auto walks = some_walks(scene);
    const LightGuide guide = guide_of(scene, walks);
    PathVertices vertices(scene, &guide);
    std::size_t lit = 0, led = 0, others = 0, with_gloss = 0, unknown = 0;
    for (std::size_t first = 0; first < walks.size(); first += lanes) {
        const auto some = std::span(walks).subspan(first, std::min(lanes, walks.size() - first));
        std::vector<float> choices;
        std::vector<Vec2> numbers;
        vertices.clear();
        for (const Walk& walk : some) {
            vertices.add(std::uint32_t(choices.size()), walk.hit, walk.outgoing, lobe::all, walk.inside);
            choices.push_back(walk.choice), numbers.push_back(walk.numbers);
        }
        vertices.find_points();
        vertices.find_bsdfs();
        ShadowRays rays;
        vertices.sample_lamps(
            {choices, numbers}, Heuristic::automatic, rays, [](auto) { return 1.0f; }, [](auto i) { return i; });
        std::vector<int> ray_of(some.size(), -1);
        for (std::size_t k = 0; k < rays.sums.size(); ++k) ray_of[rays.sums[k]] = int(k);
        std::vector<const PathVertices::Step*> step_of(some.size());
        std::vector<PathVertices::Step> steps;
        steps.reserve(some.size());
        vertices.scatter<true>(
            numbers, [&](std::uint32_t i) { return choices[i]; },
            [&](std::uint32_t i, const PathVertices::Step& step) {
                steps.push_back(step);
                step_of[i] = &steps.back();
            });
        for (std::size_t i = 0; i < some.size(); ++i) {
            const Walk& walk = some[i];
            const SurfacePoint point = scene.surface(walk.hit);
            const Bsdf bsdf = scene.bsdf(point);
            const auto cosine = bsdf.cosine_choices(walk.outgoing, lobe::all);
            const GuidedPoint known = guide.at(point.position, side_of(walk, point, bsdf), cosine);
            unknown += !known;
            const Gathering at{point, bsdf, walk.outgoing, lobe::all, walk.inside, known ? &known : nullptr};
            const auto ray = ray_to_lamp(scene, at, {walk.choice, walk.numbers}, Heuristic::automatic);
            ASSERT_EQ(ray_of[i] >= 0, ray.has_value());
            lit += ray.has_value();
            if (ray) expect_near(rays.light[std::size_t(ray_of[i])], ray->light);

            const float choice = bsdf.chooses() ? walk.choice : 0;
            const bool leads = known && known.leads(choice);
            auto sample = bsdf.sample(walk.outgoing, choice, walk.numbers, lobe::all);
            if (leads) {
                const Vec3 way = known.direction(known.warped(walk.numbers).place);
                const auto [value, pdf] = bsdf.value_and_pdf(walk.outgoing, way, lobe::all);
                sample.reset();
                if (pdf > 0) sample = BsdfSample{way, value / pdf, pdf, lobe::diffuse};
            }
            ASSERT_EQ(step_of[i] != nullptr, sample.has_value()) << first + i;
            if (!sample) continue;
            const PathVertices::Step& step = *step_of[i];
            EXPECT_EQ(step.sample.incoming, sample->incoming) << first + i;
            EXPECT_EQ(step.sample.lobe, sample->lobe);
            const bool follows = known && sample->lobe != lobe::specular;
            const float pdf = follows ? known.pdf(sample->incoming, sample->pdf) : sample->pdf;
            EXPECT_EQ(step.known, follows ? known.radiance() : -1) << first + i;
            if (follows) {
                EXPECT_NEAR(step.sample.pdf / pdf, 1, 1e-4) << first + i;
                EXPECT_NEAR(step.favour * sample->pdf / pdf, 1, 1e-4);
                expect_near(step.sample.weight, sample->weight);
            }
            led += leads, others += known && !leads, with_gloss += leads && cosine.chance() < 1;
        }
    }
    EXPECT_GT(lit, 300u);
    EXPECT_GT(led, 300u);
    EXPECT_GT(with_gloss, 100u);
    EXPECT_GT(others, 100u);
    EXPECT_GT(unknown, 100u);
}

}  // namespace
}  // namespace lightnet::guided_many_test
