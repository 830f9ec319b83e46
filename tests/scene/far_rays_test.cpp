// Rays that leave surfaces, far from the origin and at every size: free of their own surface, and of nothing else.
#include <gtest/gtest.h>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/math/transform.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/shapes/placed_quadric.hpp"
#include "tests/support/small_scenes.hpp"

#include <functional>
#include <string>
#include <vector>

namespace lightnet::far_rays_test {
namespace {

using namespace test;

constexpr std::array distances{0.0f, 1.0f, 37.3f, 1e3f, 1e4f, 1e5f, 1e6f};
constexpr std::array sizes{1e-3f, 0.3f, 1.0f, 50.0f, 1e4f};

Vec3 centre(float distance) { return Vec3{1, -0.83f, 0.61f} * distance; }

// Three axes that lie as those of no other shape do.
Frame turned() { return Frame::around(normalize({1, 2, 3})); }

Matrix affine(Vec3 x, Vec3 y, Vec3 z, Vec3 origin) {
    Matrix m;
    for (std::size_t i = 0; i < 3; ++i) m.m[i][0] = x[i], m.m[i][1] = y[i], m.m[i][2] = z[i], m.m[i][3] = origin[i];
    return m;
}

// Half of them graze the surface: by less than a thousandth, and down to nothing.
Vec3 way_out(Samples& samples, Vec3 normal, std::uint32_t i) {
    const Vec3 way = sphere(samples.next_2d());
    const Vec3 along = way - normal * dot(way, normal);
    const Vec3 grazing = normalize(along) + normal * (1e-3f * std::pow(samples.next(), 4.0f));
    const Vec3 chosen = normalize(i % 2 ? grazing : way);
    return dot(chosen, normal) < 0 ? -chosen : chosen;
}

struct Tried {
    std::size_t rays = 0, stopped = 0;
};

// `both`: of a flat shape the other side is as free.
Tried leave(const Scene& scene, const std::function<Hit(Samples&)>& name, std::uint32_t count, bool both) {
    Tried tried;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(17, i);
        const SurfacePoint at = scene.surface(name(samples));
        Vec3 way = way_out(samples, at.normal, i);
        if (both && i % 4 > 1) way = -way;
        ++tried.rays;
        tried.stopped += scene.occluded({at.origin_towards(way), way});
    }
    return tried;
}

// Its corners may have been rounded to one line.
bool is_there(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners) {
    const Vec3 a = mesh.positions[corners[0]];
    return length(cross(mesh.positions[corners[1]] - a, mesh.positions[corners[2]] - a)) > 0;
}

// A flat grid whose cells get smaller and smaller, so that slivers, tiny triangles and huge ones lie side by side.
Mesh uneven_floor(Vec3 origin, Vec3 x, Vec3 y) {
    constexpr std::array steps{0.0f, 1e-4f, 1e-3f, 0.0101f, 0.1f, 0.11f, 0.5f, 0.500077f, 1.0f};
    Mesh mesh;
    const auto n = std::uint32_t(steps.size());
    for (const float b : steps)
        for (const float a : steps) mesh.positions.push_back(origin + x * a + y * b);
    for (std::uint32_t j = 0; j + 1 < n; ++j)
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            const std::uint32_t at = j * n + i;
            for (const std::array<std::uint32_t, 3>& corners :
                 {std::array{at, at + 1, at + n + 1}, {at, at + n + 1, at + n}})
                if (is_there(mesh, corners)) mesh.triangles.push_back(corners);
        }
    return mesh;
}

Hit of_triangle(Samples& samples, const Mesh& mesh) {
    const auto which = std::uint32_t(samples.next() * float(mesh.triangles.size()));
    const Vec2 at = triangle(samples.next_2d());
    return {.primitive = which, .u = at.x, .v = at.y};
}

Quadric round(Quadric::Round kind, const Matrix& to_world) {
    Quadric quadric;
    quadric.round = kind;
    quadric.to_world = to_world;
    return quadric;
}

TEST(FarRays, LeaveOneTriangleHoweverItLies) {
    Tried all;
    for (const float distance : distances)
        for (const float size : sizes)
            for (const float thinness : {1.0f, 1e-2f, 1e-5f})
                for (const float aside : {0.0f, 0.5f, 1.0f}) {        // of the third corner
                    if (aside == 0.5f && thinness < 1e-2f) continue;  // rays can't tell how such a one is turned
                    const Frame f = turned();
                    Mesh mesh;
                    mesh.positions = {Vec3{}, f.x * size, f.x * (size * aside) + f.y * (size * thinness)};
                    for (Vec3& p : mesh.positions) p += centre(distance);
                    if (!is_there(mesh, {0, 1, 2})) continue;
                    for (std::uint32_t turn = 0; turn < 3; ++turn) {
                        SceneData data;
                        mesh.triangles = {{turn, (turn + 1) % 3, (turn + 2) % 3}};
                        add(data, mesh, diffuse(data, 0.5f));
                        const Scene scene(std::move(data));
                        const auto tried = leave(
                            scene, [&](Samples& s) { return of_triangle(s, mesh); }, 1200, true);
                        EXPECT_EQ(tried.stopped, 0u) << "at " << distance << ", size " << size << ", " << thinness
                                                     << " thin, corner " << turn << " at " << aside;
                        all.rays += tried.rays, all.stopped += tried.stopped;
                    }
                }
    EXPECT_EQ(all.stopped, 0u) << "of " << all.rays;
}

TEST(FarRays, LeaveALevelFloorOfTinyTrianglesBesideHugeOnes) {
    for (const float distance : distances)
        for (const float size : sizes) {
            SceneData data;
            const Mesh mesh = uneven_floor(centre(distance), {size, 0, 0}, {0, 0, -size});
            if (mesh.triangles.empty()) continue;
            add(data, mesh, diffuse(data, 0.5f));
            const Scene scene(std::move(data));
            const auto tried = leave(
                scene, [&](Samples& s) { return of_triangle(s, mesh); }, 30000, true);
            EXPECT_EQ(tried.stopped, 0u) << "at " << distance << ", size " << size;
        }
}

TEST(FarRays, LeaveBallsAndQuadrics) {
    const Frame f = turned();
    for (const float distance : distances)
        for (const float size : sizes) {
            if (size < 1e-6f * distance) continue;  // less than its position is rounded
            const auto look = [&](const ShapeGeometry& shape, const char* name) {
                SceneData data;
                add(data, shape, diffuse(data, 0.5f));
                const auto* quadric = std::get_if<Quadric>(&data.shapes[0].geometry);
                const bool flat = quadric && quadric->round == Quadric::Round::disk;
                const Scene scene(data);
                const auto point = [&](Samples& s) {
                    if (!quadric) return Hit{.u = s.next() - 0.5f, .v = s.next() - 0.5f};
                    const PlacedQuadric placed(*quadric);
                    const Vec2 at = placed.name_of(placed.own_uniform(s.next_2d()));
                    return Hit{.u = at.x, .v = at.y};
                };
                EXPECT_EQ(leave(scene, point, 6000, flat).stopped, 0u)
                    << name << " at " << distance << ", size " << size;
            };
            using Round = Quadric::Round;
            const Vec3 at = centre(distance);
            const Matrix even = affine(f.x * size, f.y * size, f.z * size, at),
                         flat = affine(f.x * size, f.y * (0.05f * size), f.z * size, at);
            look(ball(at, size), "ball");
            look(round(Round::disk, even), "disk");
            look(round(Round::disk, flat), "oval");
            look(round(Round::cylinder, even), "cylinder");
            look(round(Round::cylinder, flat), "oval cylinder");
            look(round(Round::sphere, even), "sphere");
            look(round(Round::sphere, flat), "ellipsoid");
        }
}

TEST(FarRays, LeaveInstances) {
    const Frame f = turned();
    for (const float distance : distances)
        for (const float size : sizes)
            for (const float own : {0.0f, 10.0f, 1e4f}) {  // distance within the object
                if (size * own > distance && own > 10) continue;
                SceneData data;
                const Mesh mesh = uneven_floor(centre(own), {1, 0, 0}, {0, 0, -1});
                const auto grey = diffuse(data, 0.5f);
                add(data, mesh, grey);
                data.objects = {{"floor", {0}}};
                data.instances = {{0, affine(f.x * size, f.y * (0.3f * size), f.z * size, centre(distance))}};
                const Scene scene(std::move(data));
                const auto name = [&](Samples& s) {
                    Hit hit = of_triangle(s, mesh);
                    hit.instance = 0;
                    return hit;
                };
                EXPECT_EQ(leave(scene, name, 10000, true).stopped, 0u)
                    << "at " << distance << ", size " << size << ", within its object at " << own;
            }
}

// From anywhere on its walls, also where they meet. Corners of a turned room are rounded, so that a few points lie
// beyond the next wall: as many as a step of a float is wide there.
TEST(FarRays, StayInAClosedRoom) {
    for (const float distance : distances)
        for (const float size : sizes)
            for (const Frame& f : {Frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, turned()}) {
                Mesh walls = room();
                for (Vec3& p : walls.positions)
                    p = centre(distance) + f.x * (p.x * size) + f.y * (p.y * size) + f.z * (p.z * size);
                if (distance > 1e4f * size) continue;
                SceneData data;
                add(data, walls, diffuse(data, 0.5f));
                const Scene scene(std::move(data));
                std::size_t gone = 0;
                constexpr std::uint32_t count = 20000;
                for (std::uint32_t i = 0; i < count; ++i) {
                    Samples samples(23, i);
                    const SurfacePoint at = scene.surface(of_triangle(samples, walls));
                    const Vec3 way = way_out(samples, at.normal, i);
                    gone += !scene.occluded({at.origin_towards(way), way});
                }
                const double step = 0x1p-24 * double{distance + size} / double{size};
                EXPECT_LE(double(gone), 50 * count * step) << "at " << distance << ", size " << size;
            }
}

// What is close above a floor hides it: the distance is what pbrt's bounds keep, too.
TEST(FarRays, MeetWhatLiesCloseAbove) {
    for (const float distance : distances) {
        const float height = std::max(1e-4f, 5e-7f * distance);
        for (const Frame& f : {Frame{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, turned()}) {
            SceneData data;
            const auto grey = diffuse(data, 0.5f);
            const Vec3 at = centre(distance);
            const Mesh floor = quad(at, f.x * 10, f.y * 10);
            add(data, floor, grey);
            add(data, quad(at + f.z * height - f.x * 10 - f.y * 10, f.x * 30, f.y * 30), grey);
            const Scene scene(std::move(data));
            std::size_t free = 0;
            for (std::uint32_t i = 0; i < 2000; ++i) {
                Samples samples(5, i);
                const SurfacePoint point = scene.surface(of_triangle(samples, floor));
                free += !scene.occluded({point.origin_towards(f.z), f.z});
            }
            EXPECT_EQ(free, 0u) << height << " above at " << distance;
        }
    }
}

// A lamp never hides its own points.
TEST(FarRays, ReachEveryPointOfALamp) {
    const Frame f = turned();
    for (const float distance : distances) {
        const Vec3 at = centre(distance);
        Mesh one = quad(at, f.y, f.x), two = one;
        one.triangles.pop_back();
        const Matrix even = affine(f.x, f.y, f.z * -1, at);
        const std::vector<ShapeGeometry> lamps{one,
                                               two,
                                               ball(at, 1),
                                               round(Quadric::Round::disk, even),
                                               round(Quadric::Round::cylinder, even),
                                               round(Quadric::Round::sphere, even)};
        for (const auto& lamp : lamps) {
            SceneData data;
            add(data, lamp, diffuse(data, 0.5f)).emission = AreaEmission{{1, 1, 1}, false};
            const Vec3 below = at - f.z * 3;
            const Mesh floor = quad(below - f.x * 5 - f.y * 5, f.x * 10, f.y * 10);
            add(data, floor, 0);
            const Scene scene(std::move(data));
            std::size_t hidden = 0, found = 0;
            for (std::uint32_t i = 0; i < 3000; ++i) {
                Samples samples(6, i);
                Hit hit = of_triangle(samples, floor);
                hit.geometry = 1;
                const SurfacePoint point = scene.surface(hit);
                const auto sample = scene.lights().sample(LitPoint(point.position), samples.next(), samples.next_2d());
                if (!sample) continue;
                ++found;
                hidden += scene.occluded(scene.ray_to(point, *sample));
            }
            EXPECT_GT(found, 300u) << "at " << distance << ", lamp " << &lamp - lamps.data();
            EXPECT_EQ(hidden, 0u) << "of " << found << " at " << distance << ", lamp " << &lamp - lamps.data();
        }
    }
}

// Plates close above each other, what is round, and an instance, under a sun and a lamp.
SceneData little_world(Vec3 at) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    const auto still = [&](float x, float y, float z) {
        return affine({0.6f, 0, 0}, {0, 0.6f, 0}, {0, 0, 0.6f}, at + Vec3{x, y, z});
    };
    add(data, quad(at + Vec3{-5, 0, 5}, {10, 0, 0}, {0, 0, -10}), grey);
    add(data, quad(at + Vec3{-4, 0.5f, -1}, {4, 0, 0}, {0, 0, -3}), grey);
    add(data, quad(at + Vec3{1, 0.125f, -1}, {3, 0, 0}, {0, 0, -3}), grey);
    add(data, ball(at + Vec3{-3, 0.8f, 2}, 0.75f), grey);
    add(data, round(Quadric::Round::sphere, still(-1, 0.8f, 2.5f)), grey);
    add(data, round(Quadric::Round::cylinder, still(1, 0.4f, 2)), grey);
    add(data, round(Quadric::Round::disk, still(2.5f, 0.7f, 1)), grey);
    const auto box = std::uint32_t(data.shapes.size());
    add(data, quad({-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1}), grey);
    data.objects = {{"plate", {box}}};
    data.instances = {{0, affine({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, at + Vec3{3.5f, 0.5f, 3})}};
    add(data, quad(at + Vec3{-1, 4, -1}, {2, 0, 0}, {0, 0, 2}), grey).emission = AreaEmission{{3, 3, 3}, false};
    DirectionalLight sun;
    sun.direction = normalize({-1, -2, -0.5f});
    sun.irradiance = {1, 1, 1};
    data.lights.push_back(sun);
    data.camera = camera(at + Vec3{0, 6, 12}, at, 50);
    data.camera_given = true;
    data.film.width = data.film.height = 64;
    return data;
}

struct Seen {
    double mean = 0;
    std::vector<double> blocks = std::vector<double>(64);  // 8 × 8 pixels each
};
Seen look_at(Vec3 at) {
    const Scene scene(little_world(at));
    Seen seen;
    constexpr std::uint32_t samples_of_pixel = 16;
    for (std::uint32_t pixel = 0; pixel < 64 * 64; ++pixel)
        for (std::uint32_t s = 0; s < samples_of_pixel; ++s) {
            Samples samples(pixel, s);
            const Vec2 film = samples.next_2d();
            const float choice = samples.next();
            const Vec2 u = samples.next_2d();
            const Ray ray = scene.camera().ray(float(pixel % 64) + film.x, float(pixel / 64) + film.y);
            const auto hit = scene.intersect(ray);
            if (!hit) continue;
            const SurfacePoint point = scene.surface(*hit);
            const auto light = scene.lights().sample(LitPoint(point.position), choice, u);
            const bool behind =
                light && (dot(light->direction, point.normal) > 0) == (dot(ray.direction, point.normal) > 0);
            if (!light || behind || scene.occluded(scene.ray_to(point, *light))) continue;
            const double value =
                double{light->radiance.g} * std::fabs(dot(light->direction, point.normal)) / light->pdf;
            seen.mean += value / (64 * 64 * samples_of_pixel);
            seen.blocks[pixel / 512 * 8 + pixel % 64 / 8] += value / (64 * samples_of_pixel);
        }
    return seen;
}

TEST(FarRays, SeeTheSameLightWhereverTheSceneStands) {
    const Seen here = look_at({0, 0, 0});
    for (const auto& [distance, bound] : {std::pair{1e4f, 0.005}, std::pair{1e5f, 0.03}}) {
        const Seen there = look_at({distance, distance, distance});
        EXPECT_NEAR(there.mean / here.mean, 1, bound) << distance;
        double apart = 0;
        for (std::size_t i = 0; i < here.blocks.size(); ++i) apart += std::fabs(there.blocks[i] - here.blocks[i]) / 64;
        EXPECT_LT(apart / here.mean, 2 * bound) << distance;
    }
}

}  // namespace
}  // namespace lightnet::far_rays_test
