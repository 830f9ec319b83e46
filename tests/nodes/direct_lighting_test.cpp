#include <gtest/gtest.h>

#include <cmath>

#include "core/base/math/samples.hpp"
#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::direct_lighting_test {
namespace {

using namespace test;

Rgb answer(const LightOp& op, Query question, std::uint32_t samples) {
    std::vector<Query> questions(samples, question);
    for (std::uint32_t i = 0; i < samples; ++i) questions[i].sample = i;
    std::vector<Rgb> answers(samples);
    op.light(questions, answers);
    Rgb sum;
    for (const Rgb& one : answers) sum += one;
    return sum / float(samples);
}

// A floor of the given material under a lamp; shape 0 is the floor, and the question is about its middle.
SceneData floor_and(ShapeGeometry lamp, Rgb radiance) {
    SceneData data;
    add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), diffuse(data, 0.6f));
    add(data, std::move(lamp), diffuse(data, 0)).emission = AreaEmission{radiance, false};
    return data;
}
const Query middle{.stream = 5, .primitive = 0, .u = 0.5f, .v = 0.0f, .outgoing = {0, 1, 0}};

// Query `middle` names the point (0, 0, 0): half way between the first two corners of triangle 0.
TEST(DirectLighting, OfASquareHasTheAnalyticFormFactor) {
    SceneData data = floor_and(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), {10, 10, 10});
    const Scene scene(data);
    Query question = middle;
    question.u = 0;
    question.v = 0.5f;  // half of the diagonal
    ASSERT_NEAR(length(scene.surface(question).position), 0, 1e-5f);
    Rig rig(scene);
    // Form factor of a parallel square, four times that of a quarter above its corner (Siegel & Howell, configuration
    // 11).
    const double x = 0.5, s = std::sqrt(1 + x * x), quarter = 2 * x / s * std::atan(x / s) / (2 * std::numbers::pi);
    const double expected = 0.6 * 10 * 4 * quarter;
    for (const char* heuristic : {"power", "balance", "lamps", "directions"}) {
        const auto& op = rig.add("DirectLighting", heuristic, {}, {{"heuristic", Value{std::string(heuristic)}}});
        EXPECT_NEAR(answer(op, question, 1 << 14).r / expected, 1, 2e-3);
    }
}

TEST(DirectLighting, OfABallIsThatOfAPointAsFarAway) {
    const Scene scene(floor_and(ball({0, 3, 0}, 1), {4, 4, 4}));
    Query question = middle;
    question.u = 0;
    question.v = 0.5f;
    Rig rig(scene);
    // irradiance of a ball at the zenith: π L sin²
    EXPECT_NEAR(answer(rig.add("DirectLighting", "direct"), question, 1 << 12).r, 0.6 * 4 / 9, 2e-4);
}

TEST(DirectLighting, ManySamplesPerQuestionMeanTheSame) {
    const Scene scene(floor_and(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), {10, 10, 10}));
    Rig rig(scene);
    const auto& one = rig.add("DirectLighting", "direct");
    const auto& four = rig.add("DirectLighting", "direct", {}, {{"samples", Value{4.0}}});
    EXPECT_NEAR(answer(one, middle, 4096).r, answer(four, middle, 1024).r, 1e-2);
}

TEST(DirectLighting, SeesTheEnvironmentWhereNothingHidesIt) {
    SceneData data;
    add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), diffuse(data, 0.6f));
    data.environments.push_back({{2, 2, 2}});
    const Scene scene(data);
    Rig rig(scene);
    EXPECT_NEAR(answer(rig.add("DirectLighting", "direct"), middle, 16).r, 1.2f, 1e-5f);
}

struct Spread {
    double mean = 0, variance = 0;
};

Spread spread_of(const LightOp& op, const Query& question, std::uint32_t answers) {
    std::vector<Query> questions(answers, question);
    for (std::uint32_t i = 0; i < answers; ++i) questions[i].stream = i;
    std::vector<Rgb> found(answers);
    op.light(questions, found);
    Spread spread;
    for (const Rgb& one : found) spread.mean += one.g / answers;
    for (const Rgb& one : found) spread.variance += std::pow(one.g - spread.mean, 2) / (answers - 1);
    return spread;
}

TEST(DirectLighting, TakesAsManySamplesAsItsErrorWants) {
    const Scene scene(floor_and(quad({-1, 0.2f, -1}, {2, 0, 0}, {0, 0, 2}), {10, 10, 10}));
    Rig rig(scene);
    Query question = middle;
    question.u = 0, question.v = 0.5f;
    const auto exact = spread_of(rig.add("DirectLighting", "many", {}, {{"samples", Value{64.0}}}), question, 4000);
    for (const double error : {0.1, 0.05}) {
        const auto& op =
            rig.add("DirectLighting", "direct", {}, {{"error", Value{error}}, {"most_samples", Value{1024.0}}});
        const auto spread = spread_of(op, question, 4000);
        EXPECT_NEAR(spread.mean, exact.mean, 4 * std::sqrt(spread.variance / 4000) + 1e-3 * exact.mean)
            << "trials decide, and are no part of the answer";
        EXPECT_LT(std::sqrt(spread.variance), 1.5 * error * exact.mean);
    }
    const auto& none = rig.add("DirectLighting", "one", {}, {{"error", Value{1.0}}, {"most_samples", Value{1.0}}});
    EXPECT_GT(std::sqrt(spread_of(none, question, 4000).variance), 0.1 * exact.mean) << "one sample has noise to lose";
}

// 400 lamps over a floor: few of them are near. Choosing all alike, as their power says, is what the tree is held to.
TEST(DirectLighting, ChoosesAmongManyLampsTheFewThatMatter) {
    SceneData data;
    add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), diffuse(data, 0.6f));
    const std::uint32_t black = diffuse(data, 0);
    std::vector<Vec3> corners;
    for (int x = 0; x < 20; ++x)
        for (int z = 0; z < 20; ++z) {
            corners.push_back({float(x) - 9.6f, 1, float(z) - 9.6f});
            add(data, quad(corners.back(), {0.2f, 0, 0}, {0, 0, 0.2f}), black).emission =
                AreaEmission{{10, 10, 10}, false};
        }
    const Scene scene(std::move(data));
    Rig rig(scene);
    Query question = middle;
    question.u = 0, question.v = 0.5f;
    const Vec3 point = scene.surface(question).position;
    ASSERT_NEAR(length(point), 0, 1e-4f);
    const auto tree = spread_of(rig.add("DirectLighting", "direct"), question, 20000);

    Spread even;
    constexpr int count = 20000;
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
        Samples samples(17, std::uint32_t(i));
        const auto& corner = corners[std::min(corners.size() - 1, std::size_t(samples.next() * float(corners.size())))];
        const Vec2 u = samples.next_2d();
        const Vec3 way = corner + Vec3{0.2f * u.x, 0, 0.2f * u.y} - point;
        const double distance2 = length_squared(way), cosine = way.y / std::sqrt(distance2);
        values.push_back(0.6 / 3.14159265 * 10 * cosine * cosine / distance2 * 0.04 * double(corners.size()));
        even.mean += values.back() / count;
    }
    for (const double value : values) even.variance += std::pow(value - even.mean, 2) / (count - 1);
    EXPECT_NEAR(tree.mean, even.mean, 4 * std::sqrt((tree.variance + even.variance) / count));
    EXPECT_LT(tree.variance, 0.35 * even.variance) << "a third, as the decisions say";
}

TEST(DirectLighting, DependsOnItsQuestionAlone) {
    const Scene scene(furnace(0.5f, 1));
    Rig rig(scene);
    rig.add("DirectLighting", "direct");
    rig.add("PathTracing", "bounce");
    for (const auto* op : {&rig.add("DirectLighting", "direct"), &rig.add("PathTracing", "bounce")}) {
        std::vector<Query> questions;
        for (std::uint32_t i = 0; i < 64; ++i)
            questions.push_back({.stream = i / 4,
                                 .primitive = i % 12,
                                 .u = 0.3f,
                                 .v = 0.2f,
                                 .outgoing = scene.surface(Query{.primitive = i % 12}).normal,
                                 .sample = i});
        std::vector<Rgb> together(questions.size()), alone(1), backwards(questions.size());
        op->light(questions, together);
        for (std::size_t i = 0; i < questions.size(); ++i) {
            op->light(std::span(questions).subspan(i, 1), alone);
            EXPECT_EQ(alone[0], together[i]);
        }
        std::reverse(questions.begin(), questions.end());
        op->light(questions, backwards);
        std::reverse(backwards.begin(), backwards.end());
        EXPECT_EQ(backwards, together);
    }
}

TEST(AmbientOcclusion, IsOneInTheOpenAndNothingInAClosedRoom) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    add(data, quad({-50, 5, -50}, {0, 0, 100}, {100, 0, 0}), grey);
    add(data, room(), grey);
    const Scene scene(data);
    Rig rig(scene);
    const auto& op = rig.add("AmbientOcclusion", "open");
    EXPECT_EQ(answer(op, middle, 16), (Rgb{1, 1, 1}));
    Query inside = middle;
    inside.geometry = 1;
    inside.outgoing = scene.surface(inside).normal;
    EXPECT_EQ(answer(op, inside, 16), (Rgb{0, 0, 0}));
    const auto& near = rig.add("AmbientOcclusion", "near", {}, {{"distance", Value{0.01}}});
    EXPECT_GT(answer(near, {.geometry = 1, .u = 0.3f, .v = 0.3f, .outgoing = inside.outgoing}, 16).r, 0.9f);
}

TEST(AmbientOcclusion, IsHalfBesideATallWall) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), grey);
    add(data, quad({0, 0, -5000}, {0, 0, 10000}, {0, 10000, 0}), grey);
    const Scene scene(data);
    Rig rig(scene);
    Query beside = middle;
    beside.u = 0.01f;
    beside.v = 0.49f;
    ASSERT_LT(std::fabs(scene.surface(beside).position.x), 2);
    EXPECT_NEAR(answer(rig.add("AmbientOcclusion", "open"), beside, 256).r, 0.5f, 5e-3f);
}

}  // namespace
}  // namespace lightnet::direct_lighting_test
