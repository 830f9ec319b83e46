// What is worked out for many points at once is, to the bit, what is worked out for each of them alone.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/estimate/path_vertices.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "tests/scene/many_surfaces.hpp"

namespace lightnet::many_test {
namespace {

using namespace test;

auto parts(const Frame& f) { return std::tuple(f.x, f.y, f.z); }
auto parts(const Ray& r) { return std::tuple(r.origin, r.direction, r.far); }

// Plain points among many hits, who looks at them, and the same points one by one.
struct Plain {
    LambertianSurfaces together;
    std::vector<SurfacePoint> points;
    std::vector<Bsdf> bsdfs;
    std::vector<Vec3> outgoing;
    std::vector<Vec2> numbers;
};

// Calls `with` for all plain points, as many as go together at once. Returns how many there were.
template <class With>
std::size_t each_plain(const Scene& scene, With&& with) {
    const auto hits = some_hits(scene);
    std::size_t count = 0;
    Plain plain;
    const auto hand_over = [&] {
        plain.together.find_points();
        with(plain);
        count += plain.points.size();
        plain = {};
    };
    for (std::uint32_t i = 0; i < many; ++i) {
        const ColumnShape& shape = scene.column_shapes()[hits[i].geometry];
        if (shape.kind != ColumnShape::Kind::lambertian || hits[i].instance != Query::no_instance) continue;
        Samples samples(8, i);
        plain.points.push_back(scene.surface(hits[i]));
        plain.bsdfs.push_back(scene.bsdf(plain.points.back()));
        plain.outgoing.push_back(sphere(samples.next_2d()));
        plain.numbers.push_back(samples.next_2d());
        plain.together.add(i, shape, hits[i], plain.outgoing.back());
        if (plain.together.full()) hand_over();
    }
    hand_over();
    return count;
}

TEST(Many, PointsAreThoseOfOne) {
    const Scene scene(everything());
    std::size_t turned = 0, black_behind = 0;
    const std::size_t count = each_plain(scene, [&](const Plain& plain) {
        for (std::size_t i = 0; i < plain.points.size(); ++i) {
            const SurfacePoint &one = plain.points[i], it = plain.together.point(i);
            const Bsdf &bsdf = plain.bsdfs[i], its = plain.together.bsdf(i);
            ASSERT_EQ(std::tuple(it.position, it.normal, parts(it.shading), it.offset),
                      std::tuple(one.position, one.normal, parts(one.shading), one.offset));
            ASSERT_EQ(std::tuple(plain.together.position(i), plain.together.normal(i), plain.together.outgoing(i)),
                      std::tuple(one.position, one.normal, plain.outgoing[i]));
            ASSERT_EQ(std::tuple(*its.diffuse_albedo(), its.one_sided(), parts(its.shading())),
                      std::tuple(*bsdf.diffuse_albedo(), bsdf.one_sided(), parts(bsdf.shading())));
            turned += dot(one.shading.z, one.normal) < 0.9f;
            black_behind += bsdf.one_sided();
        }
    });
    EXPECT_GT(count, 200u);
    EXPECT_LT(count, many - 200);
    EXPECT_GT(turned, 20u);
    EXPECT_GT(black_behind, 20u);
}

TEST(Many, ShapesAreSortedByWhatTheyAre) {
    using Kind = ColumnShape::Kind;
    std::vector<Kind> kinds;
    const Scene scene(everything());
    for (const ColumnShape& shape : scene.column_shapes()) kinds.push_back(shape.kind);
    kinds.resize(flake + 1);
    EXPECT_EQ(kinds,
              (std::vector{Kind::coated, Kind::coated, Kind::coated, Kind::coated_beckmann, Kind::metal, Kind::metal,
                           Kind::none, Kind::lambertian, Kind::lambertian, Kind::lambertian, Kind::lambertian}));
}

// Whatever is more than an ideal diffuse mesh is not taken for one; bumps are no more.
TEST(Many, WhatIsNotPlainIsLeftOut) {
    const auto is_lambertian = [](auto&& change) {
        SceneData data;
        const auto grey = diffuse(data, 0.5f);
        add(data, waves(), grey);
        change(data);
        return Scene(std::move(data)).column_shapes()[0].kind == ColumnShape::Kind::lambertian;
    };
    EXPECT_TRUE(is_lambertian([](SceneData&) {}));
    EXPECT_TRUE(is_lambertian([](SceneData& d) { d.materials[0].one_sided = true; }));
    EXPECT_TRUE(is_lambertian([](SceneData& d) { d.shapes[0].emission = AreaEmission{{1, 1, 1}}; }));
    EXPECT_FALSE(is_lambertian([](SceneData& d) { d.shapes[0].geometry = ball({}, 1); }));
    EXPECT_FALSE(is_lambertian([](SceneData& d) { d.materials[0].model = DielectricMaterial{}; }));
    EXPECT_FALSE(is_lambertian([](SceneData& d) { std::get<DiffuseMaterial>(d.materials[0].model).sigma = 0.3f; }));
    EXPECT_FALSE(is_lambertian([](SceneData& d) {
        std::get<DiffuseMaterial>(d.materials[0].model).transmittance = colour(d, {0.1f, 0.1f, 0.1f});
    }));
    EXPECT_TRUE(is_lambertian([](SceneData& d) { d.materials[0].bump_map = colour(d, {0.1f, 0.1f, 0.1f}); }));
}

// As far as one formula serves them all.
TEST(Many, PrincipledOnesAreOpaqueAndWithoutClothOrGrooves) {
    using Kind = ColumnShape::Kind;
    const auto kind = [](auto&& change) {
        SceneData data;
        PrincipledMaterial model;
        model.base_colour = colour(data, {0.5f, 0.5f, 0.5f});
        change(model);
        add(data, waves(), material(data, model));
        return Scene(std::move(data)).column_shapes()[0].kind;
    };
    EXPECT_EQ(kind([](PrincipledMaterial&) {}), Kind::principled);
    EXPECT_EQ(kind([](PrincipledMaterial& m) { m.clearcoat = 1; }), Kind::principled);
    EXPECT_EQ(kind([](PrincipledMaterial& m) { m.roughness = {0, 0}; }), Kind::principled);
    EXPECT_EQ(kind([](PrincipledMaterial& m) { m.roughness = {0, 0}, m.metallic = 1; }), Kind::none);  // a mirror
    EXPECT_EQ(kind([](PrincipledMaterial& m) { m.roughness.u = 0.1f; }), Kind::none);
    EXPECT_EQ(kind([](PrincipledMaterial& m) { m.transmission = 0.5f; }), Kind::none);
    EXPECT_EQ(kind([](PrincipledMaterial& m) { m.sheen = 0.5f; }), Kind::none);
}

TEST(Many, DirectionsAreThoseOfOne) {
    const Scene scene(everything());
    std::size_t found = 0, absorbed = 0;
    each_plain(scene, [&](Plain& plain) {
        for (std::size_t i = 0; i < plain.points.size(); ++i) plain.together.set_numbers(i, plain.numbers[i]);
        const auto& steps = plain.together.sample();
        for (std::size_t i = 0; i < plain.points.size(); ++i) {
            const auto one = plain.bsdfs[i].sample(plain.outgoing[i], 0, plain.numbers[i], lobe::all);
            ASSERT_EQ(steps.pdf[i] != 0, one.has_value());
            absorbed += !one;
            if (!one) continue;
            ++found;
            ASSERT_EQ(std::tuple(steps.incoming[i], steps.pdf[i], plain.together.albedo(i)),
                      std::tuple(one->incoming, one->pdf, one->weight));
            ASSERT_EQ(parts(plain.together.ray_from(i, one->incoming)),
                      parts(Ray{plain.points[i].origin_towards(one->incoming), one->incoming}));
        }
    });
    EXPECT_GT(found, 200u);
    EXPECT_GT(absorbed, 20u);
}

struct Lighting {
    const char* name;
    Mesh lamp;
    bool two_sided = false;
    friend std::ostream& operator<<(std::ostream& out, const Lighting& lighting) { return out << lighting.name; }
};

class ManyLit : public testing::TestWithParam<Lighting> {};

TEST_P(ManyLit, RaysAreThoseOfOne) {
    SceneData data = everything();
    add(data, GetParam().lamp, diffuse(data, 0)).emission = AreaEmission{{3, 2, 1}, GetParam().two_sided};
    const Scene scene(data);
    ASSERT_TRUE(scene.lights().only_flat_lamp());
    for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power, Heuristic::automatic}) {
        std::size_t lit = 0;
        const std::size_t count = each_plain(scene, [&](Plain& plain) {
            for (std::size_t i = 0; i < plain.points.size(); ++i) plain.together.set_numbers(i, plain.numbers[i]);
            const auto& rays = plain.together.look_at(*scene.lights().only_flat_lamp(), heuristic);
            for (std::size_t i = 0; i < plain.points.size(); ++i) {
                const Gathering at{plain.points[i], plain.bsdfs[i], plain.outgoing[i], lobe::all};
                const auto one = ray_to_lamp(scene, at, {0, plain.numbers[i]}, heuristic);
                ASSERT_EQ(rays.found[i] != 0, one.has_value());
                if (!one) continue;
                ++lit;
                ASSERT_EQ(std::tuple(rays.origin[i], rays.direction[i], rays.far[i]), parts(one->ray));
                ASSERT_EQ(rays.light[i], (Vec3{one->light.r, one->light.g, one->light.b}));
            }
        });
        EXPECT_GT(lit, 50u);
        EXPECT_LT(lit, count - 50);
    }
}

// Walks come to surfaces of all kinds, each to some twice, and are told what each alone would be told.
TEST(Many, StopsTellEachWalkWhatOneIsTold) {
    const auto lit_by = [](std::size_t count, bool sky) {
        SceneData data = everything();
        if (sky) data.environments.push_back({{1, 1, 1}, squares_of_sky()});
        for (std::size_t i = 0; i < count; ++i)
            add(data, quad({-1, -1, 4 + float(i)}, {0, 2, 0}, {2, 0, 0}), diffuse(data, 0)).emission =
                AreaEmission{{3, 2, 1}};
        return data;
    };
    for (const auto& [lamps, sky] :
         {std::pair(1, false), std::pair(2, false), std::pair(0, true), std::pair(2, true)}) {
        const Scene scene(lit_by(std::size_t(lamps), sky));
        const auto hits = some_hits(scene);
        const Rgb absorption{0.1f, 0.2f, 0.3f};
        struct Walk {
            Hit hit;
            Vec3 outgoing;
            std::uint8_t lobes;
            const Rgb* inside;
            float choice;
        };
        std::vector<Walk> walks;
        std::vector<Vec2> numbers;
        PathVertices vertices(scene);
        std::size_t told = 0, found = 0, went_on = 0;
        const auto compare = [&] {
            std::vector<float> choices;
            for (const Walk& walk : walks) choices.push_back(walk.choice);
            const auto alone = [&](std::uint32_t i, auto&& with) {
                const SurfacePoint point = scene.surface(walks[i].hit);
                const Bsdf bsdf = scene.bsdf(point);
                with(Gathering{point, bsdf, walks[i].outgoing, walks[i].lobes, walks[i].inside});
            };
            vertices.find_points();
            vertices.find_bsdfs();
            std::vector<int> seen(walks.size());
            vertices.each([&](std::uint32_t i, const Gathering& at) {
                ++seen[i];
                alone(i, [&](const Gathering& one) {
                    EXPECT_EQ(std::tuple(at.point.position, at.point.normal, at.outgoing, at.inside),
                              std::tuple(one.point.position, one.point.normal, one.outgoing, one.inside));
                    EXPECT_EQ(at.bsdf.lobes(), one.bsdf.lobes());
                });
            });
            EXPECT_EQ(seen, std::vector<int>(walks.size(), 1));
            ShadowRays rays;
            vertices.sample_lamps(
                {choices, numbers}, Heuristic::automatic, rays, [](auto) { return 2.0f; }, [](auto i) { return i; });
            std::vector<int> lit(walks.size(), -1);
            for (std::size_t k = 0; k < rays.sums.size(); ++k) lit[rays.sums[k]] = int(k);
            std::vector<int> goes(walks.size());
            std::uint32_t last = 0;
            const auto choice = [&](std::uint32_t i) { return choices[i]; };
            vertices.scatter(numbers, choice, [&](std::uint32_t i, const PathVertices::Step& step) {
                EXPECT_GE(i, last);
                last = i;
                goes[i] = 1;
                alone(i, [&](const Gathering& one) {
                    const auto sample = one.bsdf.sample(one.outgoing, choices[i], numbers[i], one.lobes);
                    ASSERT_TRUE(sample);
                    EXPECT_EQ(std::tuple(step.sample.incoming, step.sample.weight, step.sample.pdf, step.sample.eta),
                              std::tuple(sample->incoming, sample->weight, sample->pdf, sample->eta));
                    EXPECT_EQ(parts(step.ray),
                              parts(Ray{one.point.origin_towards(sample->incoming), sample->incoming}));
                    EXPECT_EQ(step.from.position, one.point.position);
                    if (!scene.lights().only_flat_lamp()) {  // else nothing is chosen
                        EXPECT_EQ(step.from, lit_point(one));
                    }
                    EXPECT_EQ(step.inside, filling(one.bsdf, one.point, one.outgoing, sample->incoming, one.inside));
                });
            });
            for (std::uint32_t i = 0; i < walks.size(); ++i)
                alone(i, [&](const Gathering& one) {
                    const auto ray = ray_to_lamp(scene, one, {choices[i], numbers[i]}, Heuristic::automatic);
                    ASSERT_EQ(lit[i] >= 0, ray.has_value());
                    if (ray) {
                        EXPECT_EQ(parts(rays.rays[std::size_t(lit[i])]), parts(ray->ray));
                        EXPECT_EQ(rays.light[std::size_t(lit[i])], 2.0f * ray->light);
                    }
                    found += ray.has_value();
                    const bool on = one.bsdf.sample(one.outgoing, choices[i], numbers[i], one.lobes).has_value();
                    EXPECT_EQ(goes[i] != 0, on);
                    went_on += on;
                });
            told += walks.size();
            walks.clear();
            numbers.clear();
            vertices.clear();
        };
        for (std::uint32_t i = 0; i < many; ++i) {
            Samples samples(9, i);
            Walk walk{hits[i], sphere(samples.next_2d()),
                      i % 7 == 0    ? lobe::specular
                      : i % 5 == 0  ? lobe::rough
                      : i % 13 == 0 ? lobe::diffuse
                      : i % 17 == 0 ? lobe::glossy
                                    : lobe::all,
                      i % 11 ? nullptr : &absorption, samples.next()};
            vertices.add(std::uint32_t(walks.size()), walk.hit, walk.outgoing, walk.lobes, walk.inside);
            walks.push_back(walk);
            numbers.push_back(samples.next_2d());
            if (i % 3 == 0 && !vertices.full()) {
                vertices.add_again(std::uint32_t(walks.size()), walk.hit, walk.outgoing, walk.lobes);
                walks.push_back(walk);
                numbers.push_back(samples.next_2d());
            }
            if (vertices.full()) compare();
        }
        compare();
        EXPECT_GT(told, many);
        EXPECT_GT(found, 100u);
        EXPECT_GT(went_on, 500u);
    }
}

Mesh triangle_lamp() {
    Mesh mesh = quad({-1, -1, 4}, {0, 2, 0}, {2, 0, 0});
    mesh.triangles.pop_back();
    return mesh;
}

INSTANTIATE_TEST_SUITE_P(By, ManyLit,
                         testing::Values(Lighting{"square", quad({-1, -1, 4}, {0, 2, 0}, {2, 0, 0})},
                                         Lighting{"square_in_the_midst", quad({-1, -1, 0.5f}, {0, 2, 0}, {2, 0, 1}),
                                                  true},
                                         Lighting{"triangle", triangle_lamp()}),
                         [](const auto& lighting) { return std::string(lighting.param.name); });

}  // namespace
}  // namespace lightnet::many_test
