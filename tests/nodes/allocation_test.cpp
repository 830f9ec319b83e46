// No memory is asked for per question: what a node needs it asks for once a call. This program counts.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "core/base/math/samples.hpp"
#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace {

thread_local std::size_t asked_for = 0;

}  // namespace

// Apart: g++ takes malloc and free that it sees through for a mistake.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++asked_for;
    if (void* memory = std::malloc(size ? size : 1)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace lightnet::allocation_test {
namespace {

using namespace test;

// Rough and smooth things under a lamp and a sky.
SceneData still_life() {
    SceneData data;
    data.environments.push_back({{0.5f, 0.5f, 0.5f}});
    data.camera = camera({0, 2, 6}, {0, 0.5f, 0}, 40);
    data.camera_given = true;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0.7f));
    add(data, ball({-1.5f, 1, 0}, 0.7f), material(data, DielectricMaterial{}));
    add(data, ball({0, 1, 0}, 0.7f), material(data, CoatedDiffuseMaterial{colour(data, {1, 1, 1})}));
    add(data, ball({1.5f, 1, 0}, 0.7f), material(data, PrincipledMaterial{}));
    add(data, quad({-1, 4, -1}, {2, 0, 0}, {0, 0, 2}), diffuse(data, 0)).emission = AreaEmission{{9, 9, 9}, false};
    return data;
}

std::size_t allocations_of(const LightOp& op, std::uint32_t count) {
    std::vector<Query> questions(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec2 at = Samples(1, i).next_2d();
        questions[i] = {.stream = mix(i), .primitive = i % 2, .u = at.x / 2, .v = at.y / 2, .outgoing = {0, 1, 0}};
    }
    std::vector<Rgb> answers(count);
    const std::size_t before = asked_for;
    op.light(questions, answers);
    return asked_for - before;
}

class Allocation : public testing::TestWithParam<std::pair<const char*, Rig::Params>> {};

TEST_P(Allocation, DoesNotGrowWithTheQuestions) {
    const Scene scene(still_life());
    Rig rig(scene);
    const auto& [kind, params] = GetParam();
    const LightOp& op = rig.add(kind, "op", {}, params);
    allocations_of(op, 64);
    const std::size_t few = allocations_of(op, 512), many = allocations_of(op, 8192);
    EXPECT_LE(many, few + 64) << "what grows by doubling may grow four times; there are 7680 questions more";
}

INSTANTIATE_TEST_SUITE_P(EachKind, Allocation,
                         testing::Values(std::pair<const char*, Rig::Params>{"DirectLighting", {}},
                                         std::pair<const char*, Rig::Params>{"PathTracing", {}},
                                         std::pair<const char*, Rig::Params>{
                                             "PathTracing", {{"paths", Value{"all"}}, {"samples", Value{4.0}}}},
                                         std::pair<const char*, Rig::Params>{"AmbientOcclusion", {}}));

TEST(Allocation, OfAPictureDoesNotGrowWithItsSamples) {
    const Scene scene(still_life());
    Rig rig(scene);
    const auto renderer = rig.path_tracer();
    const auto allocations = [&](std::uint32_t samples) {
        const Tile tile{0, 0, 32, 32, 0, samples};
        std::vector<Rgb> pixels(2 * 32 * 32);
        const std::size_t before = asked_for;
        renderer->render(tile, pixels);
        return asked_for - before;
    };
    allocations(1);
    // 1024 looks are one chunk of questions, 16384 are four
    const std::size_t one = allocations(1), sixteen = allocations(16);
    EXPECT_LE(sixteen, 4 * (one + 64)) << "there are 15360 looks more";
}

}  // namespace
}  // namespace lightnet::allocation_test
