// What is worked out for many points at once is, to the bit, what is worked out for each of them alone.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "core/math/samples.hpp"
#include "core/math/sampling.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet {
namespace {

using namespace test;

constexpr std::size_t many = 1000;  // not a multiple of anything

auto parts(const Frame& f) { return std::tuple(f.x, f.y, f.z); }
auto parts(const SurfacePoint& p) {
    return std::tuple(p.position, p.normal, parts(p.shading), p.uv, p.vertex_colour, p.along_u, p.along_v, p.geometry,
                      p.primitive, p.u, p.v, p.offset);
}
auto parts(const BsdfSample& s) { return std::tuple(s.incoming, s.weight, s.pdf, s.lobe, s.transmitted, s.eta); }
auto parts(const Ray& r) { return std::tuple(r.origin, r.direction, r.far); }

Vec3 somewhere(Samples& samples) { return sphere(samples.next_2d()) * (3 * samples.next()); }

// A wavy sheet: its shading normals are far from its geometric ones, and turn away from some who see it.
Mesh waves() {
    Mesh mesh;
    constexpr std::uint32_t side = 6;
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x) {
            const float a = float(x) - 3, b = float(y) - 3;
            mesh.positions.push_back({a, b, 0.8f * std::sin(2 * a) * std::cos(b)});
            mesh.normals.push_back(normalize({-std::sin(a), std::cos(3 * b), 0.4f}));
        }
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t at = y * (side + 1) + x;
            mesh.triangles.push_back({at, at + 1, at + side + 1});
            mesh.triangles.push_back({at + 1, at + side + 2, at + side + 1});
        }
    return mesh;
}

// Meshes with and without normals, flipped ones, ones with textures and vertex colours, triangles without area, balls
// and instances; surfaces that are diffuse, black from behind, mirrors, glass and blends.
SceneData everything() {
    SceneData data;
    const auto grey = diffuse(data, 0.5f), steel = mirror(data, 0.8f);
    const auto brown = material(data, DiffuseMaterial{colour(data, {0.6f, 0.4f, 0.2f})});
    const auto dark_behind = diffuse(data, 0.7f);
    data.materials[dark_behind].one_sided = true;
    const auto blend = material(data, MixtureMaterial{brown, steel, colour(data, {0.3f, 0.3f, 0.3f})});
    const auto glass = material(data, DielectricMaterial{});
    data.materials[glass].absorption = {1, 2, 3};
    data.textures.emplace_back().pattern = VertexColour{};
    const auto painted = material(data, DiffuseMaterial{TextureId(data.textures.size() - 1)});

    add(data, waves(), brown);
    Mesh flat = waves();
    flat.normals.clear();
    flat.flip_normals = true;
    for (Vec3& p : flat.positions) p.z -= 1;
    add(data, flat, dark_behind);
    Mesh bright = waves();
    for (Vec3& p : bright.positions) {
        p.z += 1;
        bright.colours.push_back({std::fabs(p.x) / 3, std::fabs(p.y) / 3, 0.5f});
        bright.uvs.push_back({p.x, p.y});
    }
    add(data, bright, painted);
    Mesh flake = quad({0, 0, -3}, {0, 0, 0}, {2, 0, 0});  // no area
    add(data, flake, grey);
    add(data, ball({1, 2, 0}, 0.7f), brown);
    add(data, ball({-1, 1, 0}, 0.5f), glass);
    add(data, quad({-3, -3, 2}, {6, 0, 0}, {0, 6, 0}), blend);
    add(data, quad({-3, -3, -2}, {6, 0, 0}, {0, 6, 0}), steel);
    const auto part = std::uint32_t(data.shapes.size());
    add(data, waves(), dark_behind);
    data.objects.push_back({"waves", {part}});
    Matrix upright;
    upright.m = {{{0, 0, 1, 2}, {0, 2, 0, 0}, {-1, 0, 0, 1}, {0, 0, 0, 1}}};
    data.instances.push_back({0, upright});
    return data;
}

std::vector<Hit> some_hits(const Scene& scene) {
    std::vector<Hit> hits;
    for (std::uint32_t i = 0; hits.size() < many; ++i) {
        Samples samples(7, i);
        const Vec3 origin = somewhere(samples);
        if (const auto hit = scene.intersect({origin, sphere(samples.next_2d())})) hits.push_back(*hit);
    }
    hits[many / 2] = {Query::no_instance, 3, 0, 0.25f, 0.5f, 1};  // no ray meets the flake
    return hits;
}

// Points, how they scatter, and who looks at them.
struct Surfaces {
    explicit Surfaces(const Scene& scene) : hits(some_hits(scene)), points(many) {
        scene.surfaces(hits, points);
        scene.bsdfs(points, bsdfs);
        for (std::uint32_t i = 0; i < many; ++i) {
            Samples samples(8, i);
            outgoing.push_back(sphere(samples.next_2d()));
            choices.push_back(samples.next());
            numbers.push_back(samples.next_2d());
            lobes.push_back(i % 7 ? lobe::all : std::uint8_t(lobe::all & ~lobe::diffuse));
        }
    }
    std::vector<Hit> hits;
    std::vector<SurfacePoint> points;
    std::vector<Bsdf> bsdfs;
    std::vector<Vec3> outgoing;
    std::vector<float> choices;
    std::vector<Vec2> numbers;
    std::vector<std::uint8_t> lobes;
};

TEST(Many, PointsAreThoseOfOne) {
    const Scene scene(everything());
    const auto hits = some_hits(scene);
    std::vector<SurfacePoint> points(many);
    scene.surfaces(hits, points);
    std::size_t instanced = 0, turned = 0;
    for (std::size_t i = 0; i < many; ++i) {
        ASSERT_EQ(parts(points[i]), parts(scene.surface(hits[i]))) << "hit " << i << " of shape " << hits[i].geometry;
        instanced += hits[i].instance != Query::no_instance;
        turned += dot(points[i].shading.z, points[i].normal) < 0.9f;
    }
    EXPECT_GT(instanced, 20u);
    EXPECT_GT(turned, 20u);
}

TEST(Many, DirectionsAreThoseOfOne) {
    const Scene scene(everything());
    const Surfaces at(scene);
    std::vector<Bsdf::Look> looks;
    for (std::size_t i = 0; i < many; ++i)
        looks.push_back({at.bsdfs[i], at.outgoing[i], at.lobes[i], at.choices[i], at.numbers[i]});
    std::vector<BsdfSample> samples(many);
    std::vector<std::uint8_t> found(many);
    Bsdf::sample(looks, samples, found);
    std::size_t diffuse = 0, absorbed = 0;
    for (std::size_t i = 0; i < many; ++i) {
        const auto one = at.bsdfs[i].sample(at.outgoing[i], at.choices[i], at.numbers[i], at.lobes[i]);
        ASSERT_EQ(found[i] != 0, one.has_value()) << "look " << i;
        if (one) {
            ASSERT_EQ(parts(samples[i]), parts(*one)) << "look " << i;
            diffuse += one->lobe == lobe::diffuse;
        } else {
            ++absorbed;
        }
    }
    EXPECT_GT(diffuse, 200u);
    EXPECT_GT(absorbed, 50u);
}

struct Lighting {
    const char* name;
    std::vector<std::variant<Mesh, Sphere>> lamps;
    bool two_sided = false;
    friend std::ostream& operator<<(std::ostream& out, const Lighting& lighting) { return out << lighting.name; }
};

class ManyLit : public testing::TestWithParam<Lighting> {};

TEST_P(ManyLit, RaysAreThoseOfOne) {
    SceneData data = everything();
    const auto black = diffuse(data, 0);
    for (const auto& lamp : GetParam().lamps)
        add(data, lamp, black).emission = AreaEmission{{3, 2, 1}, GetParam().two_sided};
    const Scene scene(data);
    const Surfaces at(scene);
    const Rgb absorption{0.1f, 0.2f, 0.3f};
    std::vector<LampLook> looks;
    for (std::size_t i = 0; i < many; ++i)
        looks.push_back({{at.points[i], at.bsdfs[i], at.outgoing[i], at.lobes[i], i % 11 ? nullptr : &absorption},
                         {at.choices[i], at.numbers[i]}});
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
        LampRays together;
        rays_to_lamps(scene, looks, heuristic, together);
        std::vector<bool> lit(many);
        for (std::size_t i = 0; i < together.who.size(); ++i) {
            const std::uint32_t who = together.who[i];
            ASSERT_FALSE(lit[who]) << "look " << who << " twice";
            lit[who] = true;
            const auto one = ray_to_lamp(scene, looks[who].at, looks[who].numbers, heuristic);
            ASSERT_TRUE(one) << "look " << who;
            ASSERT_EQ(parts(together.rays[i]), parts(one->ray)) << "look " << who;
            ASSERT_EQ(together.light[i], one->light) << "look " << who;
        }
        for (std::size_t i = 0; i < many; ++i) {
            if (lit[i]) continue;
            EXPECT_FALSE(ray_to_lamp(scene, looks[i].at, looks[i].numbers, heuristic)) << "look " << i;
        }
        EXPECT_GT(together.who.size(), 100u);
        EXPECT_LT(together.who.size(), many - 100);
    }
}

Mesh triangle_lamp() {
    Mesh mesh = quad({-1, -1, 4}, {0, 2, 0}, {2, 0, 0});
    mesh.triangles.pop_back();
    return mesh;
}

INSTANTIATE_TEST_SUITE_P(
    By, ManyLit,
    testing::Values(Lighting{"square", {quad({-1, -1, 4}, {0, 2, 0}, {2, 0, 0})}},
                    Lighting{"square_in_the_midst", {quad({-1, -1, 0.5f}, {0, 2, 0}, {2, 0, 1})}, true},
                    Lighting{"triangle", {triangle_lamp()}}, Lighting{"sphere", {ball({0, 0, 5}, 1)}},
                    Lighting{"two_lamps", {triangle_lamp(), ball({0, 4, 0}, 1)}}),
    [](const auto& lighting) { return std::string(lighting.param.name); });

}  // namespace
}  // namespace lightnet
