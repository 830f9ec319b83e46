// Motion while the shutter is open: what moves is at each time what a scene that stands still there is.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/readers/shutter.hpp"
#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::motion_test {
namespace {

using namespace test;

Matrix placed(Vec3 at, double turn) {
    Matrix m;
    m.m[0][0] = m.m[2][2] = std::cos(turn), m.m[0][2] = std::sin(turn), m.m[2][0] = -std::sin(turn);
    m.m[0][3] = at.x, m.m[1][3] = at.y, m.m[2][3] = at.z;
    return m;
}

Mesh moved(Mesh mesh, Vec3 by) {
    for (Vec3& p : mesh.positions) p += by;
    return mesh;
}

Quadric cylinder(Vec3 at) {
    Quadric quadric;
    quadric.round = Quadric::Round::cylinder;
    quadric.to_world = placed(at, 0);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) quadric.to_world.m[i][j] *= 0.4;
    return quadric;
}

float lerp(float a, float b, float part) { return a + (b - a) * part; }
Vec3 lerp(Vec3 a, Vec3 b, float part) { return a + (b - a) * part; }

/// A floor and one of each shape, all of which go straight on.
struct Things {
    // As at a part of the shutter's time.
    static SceneData at(float part) {
        SceneData data;
        const auto matte = diffuse(data, 0.6f);
        add(data, quad({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}), matte);
        add(data, moved(quad({-2, 1, -1}, {1, 0, 0}, {0, 1, 0.5f}), lerp({}, {1, 0.5f, 0}, part)), matte);
        add(data, ball(lerp({1, 1, 0}, {0, 2, 0.5f}, part), lerp(0.5f, 0.7f, part)), matte);
        add(data, cylinder(lerp({2, 0.5f, 1}, {2, 1.5f, 0}, part)), matte);
        add(data, quad({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), matte);
        data.objects.push_back({"plate", {4}});
        data.instances.push_back({0, {}});
        const Matrix first = placed({-1, 2, 1}, 0.2), last = placed({0, 1.5f, 1}, 0.6);
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                data.instances[0].to_world.m[i][j] = first.m[i][j] + (last.m[i][j] - first.m[i][j]) * double{part};
        return data;
    }
    static SceneData moving() {
        SceneData data = at(0);
        const SceneData last = at(1);
        for (std::uint32_t s = 1; s < 4; ++s) data.motion.shapes.push_back({s, {last.shapes[s].geometry}});
        data.motion.instances.push_back({0, {last.instances[0].to_world}});
        return data;
    }
};

std::vector<Ray> rays_across(std::size_t count, Key key) {
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(key, i);
        const Vec3 from = sphere(samples.next_2d()) * 6.0f + Vec3{0, 7, 0}, to = sphere(samples.next_2d()) * 1.5f;
        rays.push_back({from, normalize(to + Vec3{0, 1, 0.5f} - from), Ray().far, ShutterTime(samples.next() * 65536)});
    }
    return rays;
}

TEST(Motion, MeetsWhatStandsThereAtThatTime) {
    const Scene moving(Things::moving());
    for (const ShutterTime time : {ShutterTime(0), ShutterTime(13107), ShutterTime(40000), shutter_closes}) {
        const Scene still(Things::at(part_of_shutter(time)));
        std::size_t apart = 0, on_moving = 0;
        for (Ray ray : rays_across(3000, 7)) {
            ray.time = time;
            const auto hit = moving.intersect(ray), expected = still.intersect(ray);
            ray.time = 0;
            if (hit.has_value() != expected.has_value() || (hit && hit->geometry != expected->geometry)) {
                ++apart;  // at an edge
                continue;
            }
            if (!hit) continue;
            EXPECT_EQ(hit->time, time);
            on_moving += hit->geometry > 0;
            const SurfacePoint at = moving.surface(*hit), there = still.surface(*expected);
            EXPECT_LT(length(at.position - there.position), 1e-4f) << "shape " << hit->geometry;
            EXPECT_GT(dot(at.normal, there.normal), 0.9999f);
            EXPECT_EQ(at.time, time);
            const Ray away = at.ray_towards(at.normal);
            EXPECT_EQ(away.time, time);
            EXPECT_TRUE(!moving.occluded({away.origin, away.direction, 1e-2f, time})) << "shape " << hit->geometry;
        }
        EXPECT_GT(on_moving, 300u);
        EXPECT_LE(apart, 6u);
    }
}

TEST(Motion, IsTheSameForSingleRaysAndPackets) {
    const Scene scene(Things::moving());
    const auto rays = rays_across(4000, 9);
    std::vector<std::optional<Hit>> hits(rays.size());
    std::vector<std::uint8_t> hidden(rays.size());
    scene.intersect(rays, hits);
    scene.occluded(rays, hidden);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto alone = scene.intersect(rays[i]);
        ASSERT_EQ(alone.has_value(), hits[i].has_value()) << i;
        EXPECT_EQ(hidden[i] != 0, scene.occluded(rays[i]));
        if (!alone) continue;
        EXPECT_EQ(std::tuple(alone->instance, alone->geometry, alone->primitive, alone->u, alone->v, alone->distance),
                  std::tuple(hits[i]->instance, hits[i]->geometry, hits[i]->primitive, hits[i]->u, hits[i]->v,
                             hits[i]->distance))
            << i;
    }
}

Rgb answer(const LightOp& op, Query question, std::uint32_t samples) {
    std::vector<Query> questions(samples, question);
    for (std::uint32_t i = 0; i < samples; ++i) questions[i].sample = i;
    std::vector<Rgb> answers(samples);
    op.light(questions, answers);
    Rgb sum;
    for (const Rgb& one : answers) sum += one;
    return sum / float(samples);
}

SceneData lit_floor() {
    SceneData data;
    add(data, quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), diffuse(data, 0.6f));
    return data;
}
SceneData lamp_scene(ShapeGeometry lamp, bool two) {
    SceneData data = lit_floor();
    add(data, std::move(lamp), diffuse(data, 0)).emission = AreaEmission{{10, 10, 10}, true};
    if (two) data.lights.push_back(PointLight{{-3, 4, 0}, {5, 5, 5}});
    return data;
}

// Lamps that pass: what falls on the floor at a time is what a lamp that stands there sends.
void expect_light_at_each_time(const SceneData& moving, const std::function<SceneData(float)>& at) {
    const Scene scene(moving);
    Rig rig(scene);
    for (const ShutterTime time : {ShutterTime(0), ShutterTime(30000), shutter_closes}) {
        const Scene still(at(part_of_shutter(time)));
        Rig still_rig(still);
        Query question{.stream = 5, .primitive = 0, .u = 0, .v = 0.5f, .outgoing = {0, 1, 0}};
        const float expected = answer(still_rig.add("DirectLighting", "direct"), question, 1 << 13).r;
        question.time = time;
        for (const char* heuristic : {"power", "lamps", "directions"}) {
            const auto& op = rig.add("DirectLighting", std::string(heuristic) + std::to_string(time), {},
                                     {{"heuristic", Value{std::string(heuristic)}}});
            if (std::string(heuristic) != "directions" || moving.lights.empty()) {
                EXPECT_NEAR(answer(op, question, 1 << 13).r / expected, 1, 0.02) << heuristic << ' ' << time;
            }
        }
    }
}

TEST(Motion, LampsOfEachShapeShineFromWhereTheyAreAtThatTime) {
    const auto square = [](float part) {
        return moved(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, lerp(2, 1, part)}), lerp({}, {3, 1, 0}, part));
    };
    const auto round = [](float part) { return ball(lerp({0, 2, 0}, {2, 3, 0}, part), lerp(0.5f, 0.9f, part)); };
    const auto tube = [](float part) { return cylinder(lerp({0, 2, 0}, {1, 1, 1}, part)); };
    for (const bool two : {false, true}) {
        const auto check = [&](const auto& shape) {
            SceneData moving = lamp_scene(shape(0), two);
            moving.motion.shapes.push_back({1, {shape(0.5f), shape(1)}});
            expect_light_at_each_time(moving, [&](float part) { return lamp_scene(shape(part), two); });
        };
        check(square), check(round), check(tube);
    }
}

TEST(Motion, PointsAndSpotsShineFromWhereTheyAreAtThatTime) {
    const auto point = [](float part) -> BareLight { return PointLight{lerp({0, 2, 0}, {3, 1, 0}, part), {9, 9, 9}}; };
    const auto spot = [](float part) -> BareLight {
        SpotLight light;
        light.position = lerp({0, 2, 0}, {1, 3, 0}, part);
        light.axis = {0, -1, 0};
        light.intensity = {9, 9, 9};
        light.inner = 0.3f, light.outer = lerp(0.7f, 0.9f, part);
        return light;
    };
    const auto check = [&](const auto& light) {
        const auto at = [&](float part) {
            SceneData data = lit_floor();
            data.lights.push_back(light(part));
            return data;
        };
        SceneData moving = at(0);
        moving.motion.lights.push_back({0, {light(1)}});
        expect_light_at_each_time(moving, at);
    };
    check(point), check(spot);
}

SceneData bright_edge(float part) {
    SceneData data;
    add(data, quad({-10 - 0.5f + part, -10, 0}, {10, 0, 0}, {0, 20, 0}), diffuse(data, 0)).emission =
        AreaEmission{{1, 1, 1}, true};
    data.camera = camera({0, 0, 1}, {0, 0, 0}, 90);
    data.camera_given = true;
    data.film.width = data.film.height = 8;
    return data;
}

// The edge goes from -0.5 to 0.5 of a picture that is 2 wide: a pixel is covered for the time that it is behind.
TEST(Motion, BrightEdgeThatMovesOverPixelsIsAsBrightAsItCoversThem) {
    SceneData data = bright_edge(0);
    data.motion.shapes.push_back({0, {bright_edge(1).shapes[0].geometry}});
    const Scene scene(data);
    Rig rig(scene);
    rig.add("DirectLighting", "nothing");  // the lamp is black
    const auto pixels = picture(*rig.renderer("nothing"), 8, 8, 1024);
    const bool mirrored = scene.camera().project({0.9f, 0, 0}).x < scene.camera().project({-0.9f, 0, 0}).x;
    for (std::size_t column = 0; column < 8; ++column) {
        double covered = 0;
        for (int i = 0; i < 1000; ++i) {
            const double edge = -0.5 + (i + 0.5) / 1000, left = -1 + 0.25 * double(column);
            covered += std::clamp((edge - left) / 0.25, 0.0, 1.0) / 1000;
        }
        double mean = 0;
        for (std::size_t row = 0; row < 8; ++row)
            mean += double{pixels[row * 8 + (mirrored ? 7 - column : column)].r} / 8;
        EXPECT_NEAR(mean, covered, 0.01) << column;
    }
}

// Everything at once, the camera too, by all light paths.
TEST(Motion, BlurIsTheAverageOfManyInstants) {
    const auto at = [](float part) {
        SceneData data = Things::at(part);
        data.environments.push_back({{0.4f, 0.5f, 0.6f}});
        add(data, ball(lerp({-2, 4, 0}, {2, 3, 0}, part), 0.4f), 0).emission = AreaEmission{{20, 18, 15}, false};
        data.camera = camera(lerp({0, 2, 6}, {1, 2.5f, 6}, part), lerp({0, 1, 0}, {0.5f, 1, 0}, part), 50);
        data.camera_given = true;
        return data;
    };
    SceneData data = at(0);
    const SceneData last = at(1);
    for (const std::uint32_t s : {1u, 2u, 3u, 5u}) data.motion.shapes.push_back({s, {last.shapes[s].geometry}});
    data.motion.instances.push_back({0, {last.instances[0].to_world}});
    for (int i = 1; i <= 4; ++i) data.camera.later.push_back(at(float(i) / 4).camera);
    const auto rendered = [](SceneData of, std::uint64_t seed, std::uint32_t samples) {
        of.film.width = of.film.height = 12;
        const Scene scene(std::move(of));
        Rig rig(scene, seed);
        return picture(*rig.path_tracer(), 12, 12, samples);
    };
    std::vector<Rgb> average(144);
    for (std::uint32_t i = 0; i < 64; ++i) {
        const auto instant = rendered(at((float(i) + 0.5f) / 64), 100 + i, 32);
        for (std::size_t p = 0; p < 144; ++p) average[p] += instant[p] / 64.0f;
    }
    double worst = 0, squares = 0, mean = 0, expected = 0;
    for (const std::uint64_t seed : {1u, 2u}) {
        const auto blurred = rendered(data, seed, 1024);
        for (std::size_t p = 0; p < 144; ++p) {
            const double off = (double{luminance(blurred[p])} - double{luminance(average[p])}) /
                               (double{luminance(average[p])} + 0.05);
            worst = std::max(worst, std::fabs(off)), squares += off * off / 288;
            mean += double{luminance(blurred[p])} / 288, expected += double{luminance(average[p])} / 144;
        }
    }
    EXPECT_NEAR(2 * mean / expected, 1, 0.01);
    EXPECT_LT(std::sqrt(squares), 0.03);
    EXPECT_LT(worst, 0.15);
}

SceneData spinning(double seconds) {
    SceneData data;
    diffuse(data, 0.5f);
    Mesh mesh;
    for (int i = 0; i < 3; ++i) {
        const double angle = seconds * std::numbers::pi + i * 2 * std::numbers::pi / 3;
        mesh.positions.push_back({float(std::cos(angle)), float(std::sin(angle)), 0});
    }
    mesh.triangles = {{0, 1, 2}};
    add(data, mesh, 0);
    data.animations.push_back({"spin", 2});
    return data;
}

TEST(Shutter, TakesAsManyStepsAsAWayHasBends) {
    const auto scene = read_in_shutter(spinning, {0, 1}, "wheel");
    ASSERT_EQ(scene.motion.shapes.size(), 1u);
    const auto& later = scene.motion.shapes[0].later;
    EXPECT_EQ(later.size(), 32u);
    for (const auto& step : later)
        for (const Vec3 corner : std::get<Mesh>(step).positions) EXPECT_NEAR(length(corner), 1, 1e-5f);
    const auto straight = [](double seconds) {
        SceneData data = spinning(0);
        for (Vec3& p : std::get<Mesh>(data.shapes[0].geometry).positions) p.x += float(seconds);
        return data;
    };
    EXPECT_EQ(read_in_shutter(straight, {0, 1}, "sled").motion.shapes.at(0).later.size(), 1u);
    EXPECT_TRUE(read_in_shutter(straight, {1, 1}, "sled").motion.empty());
}

TEST(Shutter, LeavesWhatChangesItsPartsAsAtFirst) {
    const auto growing = [](double seconds) {
        SceneData data = spinning(0);
        auto& mesh = std::get<Mesh>(data.shapes[0].geometry);
        if (seconds > 0.5) mesh.triangles.push_back({0, 2, 1});
        return data;
    };
    const auto scene = read_in_shutter(growing, {0, 1}, "plant");
    EXPECT_TRUE(scene.motion.empty());
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].what.find("stands still"), std::string::npos);
}

}  // namespace
}  // namespace lightnet::motion_test
