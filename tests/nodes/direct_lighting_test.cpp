#include <gtest/gtest.h>

#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet {
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
SceneData floor_and(std::variant<Mesh, Sphere> lamp, Rgb radiance) {
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
    for (const char* heuristic : {"power", "balance"}) {
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
}  // namespace lightnet
