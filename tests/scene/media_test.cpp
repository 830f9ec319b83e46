// Light's way through media, against what is known exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/scene_media.hpp"
#include "tests/support/small_media.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::media_test {
namespace {

using namespace test;

/// Fills a ball with a medium; nothing else is there.
void fill(SceneData& data, Vec3 center, float radius, std::uint16_t inside, std::uint16_t outside) {
    add(data, ball(center, radius), material(data, NoMaterial{})).media = MediumSides{inside, outside};
}

// A grid of the unit cube, as large as `size` metres on each side, whose density grows along x.
Medium wedge(float size, Rgb extinction) {
    Medium medium = fog(extinction, {0.5f, 0.5f, 0.5f});
    VolumeGrid grid;
    grid.size = {16, 2, 2};
    for (int row = 0; row < 4; ++row)
        for (int x = 0; x < 16; ++x) grid.values.push_back((float(x) + 0.5f) / 16);
    medium.extinction.grid = std::make_shared<const VolumeGrid>(grid);
    for (std::size_t axis = 0; axis < 3; ++axis) medium.extinction.to_grid.m[axis][axis] = 1 / double(size);
    return medium;
}

struct Mean {
    Rgb passed, collided;  // mean weights of paths that got through, and of those that collided
    double squares = 0;    // of the former's red
};
constexpr std::uint32_t many = 1 << 14;

Mean mean_flight(const Scene& scene, const Ray& ray, Rgb carried = {1, 1, 1}) {
    Mean mean;
    for (std::uint32_t i = 0; i < many; ++i) {
        const Flight flight = scene.media().fly(ray, carried, Samples(7, i).next_2d());
        (flight.collision ? mean.collided : mean.passed) += flight.weight / float(many);
    }
    return mean;
}

void expect_near(Rgb found, Rgb expected, float bound) {
    EXPECT_NEAR(found.r, expected.r, bound);
    EXPECT_NEAR(found.g, expected.g, bound);
    EXPECT_NEAR(found.b, expected.b, bound);
}

TEST(Media, LeaveAsMuchOfLightAsBeerAndLambertSay) {
    SceneData data;
    data.media.push_back(fog({0.1f, 0.5f, 2}, {1, 1, 1}));
    fill(data, {0, 0, 0}, 1, 0, Query::no_medium);
    const Scene scene(data);
    ASSERT_TRUE(scene.has_media());
    const Rgb left{std::exp(-0.2f), std::exp(-1.0f), std::exp(-4.0f)};
    const Ray through{{-3, 0, 0}, {1, 0, 0}};
    expect_near(scene.media().transmittance(through, {}), left, 1e-5f);
    expect_near(scene.media().transmittance({{0, 0, 0}, {0, 1, 0}}, {}),
                {std::exp(-0.1f), std::exp(-0.5f), std::exp(-2.0f)}, 1e-5f);
    expect_near(scene.media().transmittance({{-3, 0, 0}, {1, 0, 0}, 1.5f}, {}), {1, 1, 1}, 0);
    for (const Rgb carried : {Rgb{1, 1, 1}, Rgb{0.2f, 3, 0.1f}}) {
        const Mean mean = mean_flight(scene, through, carried);
        expect_near(mean.passed, left, 0.02f);
        expect_near(mean.collided, Rgb{1, 1, 1} - left, 0.03f);
    }
}

TEST(Media, LieInsideOfEachOtherAndAroundEverything) {
    SceneData data;
    data.media = {fog({1, 1, 1}, {}), fog({0.25f, 0.25f, 0.25f}, {}), fog({2, 2, 2}, {})};
    fill(data, {0, 0, 0}, 2, 0, 1);
    fill(data, {0, 0, 0}, 1, 2, 0);
    data.around = 1;
    const Scene scene(data);
    // from outside of both to the middle: 3 m around, 1 m in the larger ball, 1 m in the smaller one
    EXPECT_NEAR(scene.media().transmittance({{-5, 0, 0}, {1, 0, 0}, 5}, {}).g, std::exp(-0.75f - 1 - 2), 1e-5f);
    EXPECT_NEAR(scene.media().transmittance({{0, 0, 0}, {0, 0, 1}, 0.5f}, {}).g, std::exp(-1.0f), 1e-5f);
    EXPECT_NEAR(scene.media().transmittance({{-5, 9, 0}, {1, 0, 0}, 4}, {}).g, std::exp(-1.0f), 1e-5f)
        << "met by no shape";
}

TEST(Media, OfAGridLeaveWhatItsIntegralLeaves) {
    SceneData data;
    data.media.push_back(wedge(4, {1.5f, 0.5f, 0.25f}));
    fill(data, {2, 2, 2}, 3.4f, 0, Query::no_medium);
    const Scene scene(data);
    const Ray along{{-6, 2, 2}, {1, 0, 0}};
    const auto left = [](float extinction) { return std::exp(-extinction * 4 / 2); };  // the mean density is 1 / 2
    const Rgb expected{left(1.5f), left(0.5f), left(0.25f)};
    Rgb sum;
    double squares = 0;
    for (std::uint32_t i = 0; i < many; ++i) {
        const Rgb one = scene.media().transmittance(along, Samples(3, i).next_2d());
        sum += one / float(many);
        squares += double(one.r) * one.r / many;
    }
    const auto error = float(std::sqrt(squares / many));
    expect_near(sum, expected, 5 * error);
    EXPECT_LT(error, 5e-3f);
    const Mean mean = mean_flight(scene, along);
    expect_near(mean.passed, expected, 0.02f);
    expect_near(mean.collided, Rgb{1, 1, 1} - expected, 0.02f);
}

// Points in blocks are looked up as those in one row are; blocks that are alike may be one.
TEST(VolumeGrids, OfBlocksAreThoseWithoutThem) {
    VolumeGrid rows, blocks;
    rows.size = blocks.size = {16, 8, 24};
    rows.fades = blocks.fades = true;
    blocks.values.assign(VolumeGrid::block_points, 0);
    const auto density = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return x < 8 && z < 16 ? 0.0f : float((x * 5 + y * 3 + z * 7) % 11);
    };
    for (std::uint32_t z = 0; z < 24; ++z)
        for (std::uint32_t y = 0; y < 8; ++y)
            for (std::uint32_t x = 0; x < 16; ++x) rows.values.push_back(density(x, y, z));
    for (std::uint32_t z = 0; z < 24; z += 8)
        for (std::uint32_t x = 0; x < 16; x += 8) {
            const bool empty = x < 8 && z < 16;
            blocks.blocks.push_back(empty ? 0 : std::uint32_t(blocks.values.size() / VolumeGrid::block_points));
            for (std::uint32_t i = 0; i < VolumeGrid::block_points && !empty; ++i)
                blocks.values.push_back(density(x + i % 8, i / 8 % 8, z + i / 64));
        }
    for (std::uint32_t i = 0; i < 2000; ++i) {
        Samples samples(4, i);
        const Vec2 along = samples.next_2d();
        const Vec3 place{1.2f * along.x - 0.1f, 1.2f * along.y - 0.1f, 1.2f * samples.next() - 0.1f};
        ASSERT_EQ(rows.at(place), blocks.at(place));
    }
    const auto light = [](const VolumeGrid& grid) {
        SceneData data;
        data.media.push_back(fog({0.3f, 0.2f, 0.1f}, {}));
        data.media[0].extinction.grid = std::make_shared<const VolumeGrid>(grid);
        fill(data, {0.5f, 0.5f, 0.5f}, 2, 0, Query::no_medium);
        return Scene(std::move(data))
            .media()
            .transmittance({{-3, 0.3f, 0.6f}, normalize({1, 0.05f, 0.1f})}, {0.3f, 0.7f});
    };
    EXPECT_EQ(light(rows), light(blocks));
    VolumeGrid wrong = blocks;
    wrong.blocks[1] = 77;
    Medium medium;
    medium.extinction.grid = std::make_shared<const VolumeGrid>(wrong);
    EXPECT_NE(medium.fault(), "");
}

// Of so many points that their bounds are those of whole blocks.
TEST(VolumeGrids, OfManyPointsLeaveWhatTheLawSays) {
    VolumeGrid grid;
    grid.size = {320, 320, 320};
    grid.values.assign(VolumeGrid::block_points, 0);
    grid.values.resize(2 * VolumeGrid::block_points, 2);
    for (std::uint32_t i = 0; i < 40 * 40 * 40; ++i) grid.blocks.push_back(i % 40 < 20 ? 1 : 0);  // half of it along x
    EXPECT_LT(grid.memory(), std::size_t{1} << 20);
    SceneData data;
    data.media.push_back(fog({1, 0.5f, 0}, {}));
    data.media[0].extinction.grid = std::make_shared<const VolumeGrid>(grid);
    fill(data, {0.5f, 0.5f, 0.5f}, 2, 0, Query::no_medium);
    const Scene scene(std::move(data));
    Rgb sum;
    for (std::uint32_t i = 0; i < many; ++i)
        sum += scene.media().transmittance({{-3, 0.3f, 0.6f}, {1, 0, 0}}, Samples(5, i).next_2d()) / float(many);
    expect_near(sum, {std::exp(-1.0f), std::exp(-0.5f), 1}, 0.015f);
}

// A glow that absorbs: ∫ emission × exp(-extinction t) dt.
TEST(Media, ShineAsMuchAsTheyLetThrough) {
    for (const bool grid : {false, true}) {
        SceneData data;
        Medium medium = grid ? wedge(4, {0.5f, 0.5f, 0.5f}) : fog({0.5f, 0.5f, 0.5f}, {});
        if (grid) {
            auto even = std::make_shared<VolumeGrid>();
            even->values = {1};
            medium.extinction.grid = even;
            medium.albedo.value = {};
        }
        medium.emission.value = {3, 2, 1};
        data.media.push_back(medium);
        fill(data, {2, 2, 2}, 2, 0, Query::no_medium);
        const Scene scene(data);
        Rgb sum;
        for (std::uint32_t i = 0; i < many; ++i)
            sum += scene.media().fly({{-6, 2, 2}, {1, 0, 0}}, {1, 1, 1}, Samples(3, i).next_2d()).emitted / float(many);
        const float shine = (1 - std::exp(-2.0f)) / 0.5f;
        expect_near(sum, Rgb{3, 2, 1} * shine, grid ? 0.06f : 1e-3f);
    }
}

PhaseFunction law(PhaseFunction::Law law, float g = 0) {
    PhaseFunction phase;
    phase.law = law;
    phase.g = g;
    return phase;
}

std::vector<PhaseFunction> phase_functions() {
    using Law = PhaseFunction::Law;
    PhaseFunction table = law(Law::tabulated), blend = law(Law::blend);
    table.table = {1, 0.25f, 0, 0.5f, 3};
    blend.table = {1, 3};
    blend.parts = {law(Law::henyey_greenstein, -0.5f), law(Law::rayleigh)};
    std::vector<PhaseFunction> all{law(Law::isotropic),
                                   law(Law::henyey_greenstein, 0.8f),
                                   law(Law::henyey_greenstein, -0.4f),
                                   law(Law::rayleigh),
                                   table,
                                   blend};
    for (PhaseFunction& phase : all) phase.normalise();
    return all;
}

TEST(PhaseFunctions, HaveAnIntegralOfOneAndAreSampledByTheirDensity) {
    for (const PhaseFunction& phase : phase_functions()) {
        ASSERT_EQ(phase.fault(), "");
        const PhaseBsdf bsdf{&phase, {0.5f, 0.25f, 1}};
        constexpr int bins = 20, steps = 100;
        std::vector<double> expected(bins), found(bins);
        double whole = 0;
        for (int i = 0; i < bins * steps; ++i) {
            const float cosine = -1 + 2 * (float(i) + 0.5f) / (bins * steps);
            expected[std::size_t(i / steps)] += 2.0 * pi * phase.density(cosine) * 2 / (bins * steps);
        }
        for (const double share : expected) whole += share;
        EXPECT_NEAR(whole, 1, 2e-3);
        const Vec3 outgoing = normalize({1, 2, -2});
        for (std::uint32_t i = 0; i < many; ++i) {
            Samples samples(5, i);
            const float choice = samples.next();
            const auto sample = bsdf.sample(outgoing, choice, samples.next_2d(), lobe::all);
            ASSERT_TRUE(sample);
            const auto [value, pdf] = bsdf.evaluate(outgoing, sample->incoming, lobe::all);
            EXPECT_FLOAT_EQ(pdf, sample->pdf);
            expect_near(value, bsdf.albedo * pdf, 1e-4f * pdf);
            expect_near(bsdf.evaluate(sample->incoming, outgoing, lobe::all).value, value, 1e-4f * pdf);
            const float cosine = -dot(outgoing, sample->incoming);
            found[std::size_t(std::clamp(int((cosine + 1) / 2 * bins), 0, bins - 1))] += 1.0 / many;
        }
        for (std::size_t i = 0; i < bins; ++i)
            EXPECT_NEAR(found[i], expected[i], 5 * std::sqrt(expected[i] / many) + 1e-3) << "bin " << i;
    }
}

TEST(Media, ThatCannotBeAreRefused) {
    const auto with = [](const std::function<void(SceneData&)>& change) {
        SceneData data;
        data.media.push_back(fog({1, 1, 1}, {1, 1, 1}));
        fill(data, {0, 0, 0}, 1, 0, Query::no_medium);
        change(data);
        return Scene(data);
    };
    EXPECT_THROW(with([](SceneData& data) { data.media[0].extinction.value.g = -1; }), Error);
    EXPECT_THROW(with([](SceneData& data) { data.shapes[0].media->outside = 3; }), Error);
    EXPECT_THROW(with([](SceneData& data) { data.around = 1; }), Error);
    EXPECT_THROW(with([](SceneData& data) { data.media[0].phase.g = 1; }), Error);
    const Scene scene = with([](SceneData&) {});
    Query question;
    question.put_into_space({1, 2, 3}, 7);
    EXPECT_THROW(scene.surface(question), Error) << "it may come from another host";
    question.medium = 0;
    EXPECT_EQ(scene.surface(question).position, (Vec3{1, 2, 3}));
}

}  // namespace
}  // namespace lightnet::media_test
