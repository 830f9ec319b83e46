// Objects that stand in a scene many times, and surfaces with holes.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/base/error.hpp"
#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::instances_test {
namespace {

using namespace test;

Matrix affine(Vec3 x, Vec3 y, Vec3 z, Vec3 origin) {
    Matrix m;
    for (std::size_t i = 0; i < 3; ++i) {
        m.m[i][0] = x[i];
        m.m[i][1] = y[i];
        m.m[i][2] = z[i];
        m.m[i][3] = origin[i];
    }
    return m;
}

// ScopedActivity, stretched, sheared and mirrored ones.
std::vector<Matrix> placements() {
    std::vector<Matrix> all;
    for (std::uint32_t i = 0; i < 12; ++i) {
        Samples samples(21, i);
        const Frame f = Frame::around(sphere(samples.next_2d()));
        const Vec3 at = sphere(samples.next_2d()) * 4;
        switch (i % 4) {
            case 0:
                all.push_back(affine(f.x, f.y, f.z, at));
                break;
            case 1:
                all.push_back(affine(f.x * 2, f.y * 0.3f, f.z, at));
                break;
            case 2:
                all.push_back(affine(f.x * -1, f.y * 0.7f, f.z * 0.7f, at));
                break;
            default:
                all.push_back(affine(f.x + f.y * 0.6f, f.y, f.z * 1.3f + f.x * 0.2f, at));
        }
    }
    return all;
}

Mesh bumpy() {
    Mesh mesh;
    constexpr std::uint32_t n = 12;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j) {
            const float x = float(i) / n, z = float(j) / n;
            mesh.positions.push_back({x - 0.5f, 0.15f * std::sin(9 * x + 5 * z), z - 0.5f});
            mesh.normals.push_back(normalize({-1.35f * std::cos(9 * x + 5 * z), 1, -0.75f * std::cos(9 * x + 5 * z)}));
            mesh.uvs.push_back({2 * x, 3 * z});
        }
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({b, d, c});
        }
    return mesh;
}

/// Shape 0 and sphere 2 stand in the scene; 1 and 3 are parts of an object with many instances.
SceneData instanced(bool with_holes) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    auto pattern = grey;
    if (with_holes) {
        const TextureId whole = colour(data, {1, 1, 1}), half = colour(data, {0.5f, 0.5f, 0.5f});
        data.textures.push_back({{1, 1, 1}, CheckerTexture{whole, half, {}}});
        const auto board = TextureId(data.textures.size() - 1);
        pattern = diffuse(data, 0.5f);
        data.materials[pattern].opacity = board;
    }
    add(data, bumpy(), grey);
    add(data, bumpy(), pattern);
    add(data, ball({0, 2, 0}, 0.5f), pattern);
    add(data, ball({0.1f, 0.3f, -0.2f}, 0.25f), pattern);
    data.objects.push_back({"thing", {3, 1}});
    data.objects.push_back({"nothing", {}});
    for (const auto& place : placements()) data.instances.push_back({0, place});
    data.instances.push_back({1, {}});
    return data;
}

/// The same with a mesh of its own for each instance, and none of the object's spheres.
SceneData flattened(const SceneData& data) {
    SceneData flat;
    flat.materials = data.materials;
    flat.textures = data.textures;
    flat.shapes = {data.shapes[0], data.shapes[2]};
    for (const auto& instance : data.instances) {
        if (data.objects[instance.object].shapes.empty()) continue;
        Shape shape = data.shapes[1];
        auto& mesh = std::get<Mesh>(shape.geometry);
        for (auto& p : mesh.positions) p = transform_point(instance.to_world, p);
        mesh.normals.clear();
        mesh.flip_normals = swaps_handedness(instance.to_world);
        flat.shapes.push_back(shape);
    }
    return flat;
}

SceneData without_its_sphere(SceneData data) {
    data.objects[0].shapes = {1};
    data.objects.push_back({"sphere", {3}});
    return data;
}

std::vector<Ray> rays(std::size_t count) {
    std::vector<Ray> result;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(4, i);
        const Vec3 origin = sphere(samples.next_2d()) * 7;
        result.push_back({origin, normalize(sphere(samples.next_2d()) * 4 - origin)});
    }
    return result;
}

TEST(Instances, AreMetLikeTheirCopies) {
    const SceneData data = without_its_sphere(instanced(false));
    const Scene scene(data), flat(flattened(data));
    std::size_t met = 0, elsewhere = 0;
    for (const Ray& ray : rays(20000)) {
        const auto a = scene.intersect(ray), b = flat.intersect(ray);
        if (!a != !b) {  // past an edge, by rounding
            ++elsewhere;
            continue;
        }
        if (!a) continue;
        const std::uint32_t copy = a->instance == Query::no_instance ? (a->geometry == 0 ? 0 : 1) : 2 + a->instance;
        if (copy != b->geometry || a->primitive != b->primitive) {
            ++elsewhere;
            continue;
        }
        met += a->instance != Query::no_instance;
        const SurfacePoint p = scene.surface(*a), q = flat.surface(*b);
        const float tolerance = 2e-5f / std::fabs(dot(p.normal, ray.direction));  // roundings along a grazing ray
        ASSERT_NEAR(a->distance, b->distance, tolerance);
        ASSERT_NEAR(length(p.position - q.position), 0, tolerance);
        ASSERT_NEAR(length(p.position - (ray.origin + ray.direction * a->distance)), 0, tolerance);
        if (a->instance != Query::no_instance) {
            // the copies have no shading normals, so their sides are those of their vertices
            ASSERT_NEAR(std::fabs(dot(p.normal, q.normal)), 1, 1e-4f);
        }
        ASSERT_NEAR(length(p.normal), 1, 1e-5f);
        ASSERT_GT(dot(p.normal, p.shading.z), 0);
        ASSERT_NEAR(dot(p.shading.x, p.shading.z), 0, 1e-5f);
        ASSERT_NEAR(length(cross(p.shading.z, p.shading.x) - p.shading.y), 0, 1e-5f);
    }
    EXPECT_GT(met, 2000u);
    EXPECT_LT(elsewhere, 3u);
}

// Bumps and brushed metals lie along the texture's axes, wherever the object stands.
TEST(Instances, CarryTheAxesOfTheirTextures) {
    SceneData data = without_its_sphere(instanced(false));
    data.textures.push_back({{1, 1, 1}, CheckerTexture{0, 0, {}}});
    data.materials[data.shapes[1].material].bump_map = TextureId(data.textures.size() - 1);
    const Scene scene(data);
    for (std::uint32_t i = 0; i < 12; ++i) {
        const auto at = [&](std::uint32_t instance) {
            return scene.surface(Query{.instance = instance, .geometry = 1, .primitive = 17, .u = 0.2f, .v = 0.5f});
        };
        const SurfacePoint in_object = at(Query::no_instance), in_world = at(i);
        const Matrix& to_world = data.instances[i].to_world;
        ASSERT_GT(length(in_object.along_u), 0);
        EXPECT_NEAR(length(in_world.along_u - transform_direction(to_world, in_object.along_u)), 0, 1e-6f);
        EXPECT_NEAR(length(in_world.along_v - transform_direction(to_world, in_object.along_v)), 0, 1e-6f);
        EXPECT_NEAR(dot(in_world.along_u, in_world.normal), 0, 1e-6f);
    }
}

// What a mirror does to an object, it does to its normals: up stays up.
TEST(Instances, KeepTheSidesOfTheirSurfaces) {
    const SceneData data = instanced(false);
    const Scene scene(data);
    for (std::uint32_t i = 0; i < 12; ++i)
        for (std::uint32_t t = 0; t < 20; ++t) {
            const Query there{.instance = i, .geometry = 1, .primitive = t, .u = 0.3f, .v = 0.3f};
            Query object = there;
            object.instance = Query::no_instance;
            const SurfacePoint in_object = scene.surface(object), in_world = scene.surface(there);
            const Vec3 off = transform_point(data.instances[i].to_world, in_object.position + in_object.normal * 0.01f);
            ASSERT_GT(dot(off - in_world.position, in_world.normal), 0);
        }
}

TEST(Instances, FindTheSameHitsOneByOneAndManyAtOnce) {
    for (const bool with_holes : {false, true}) {
        const Scene scene(instanced(with_holes));
        const auto all = rays(8003);
        std::vector<std::optional<Hit>> together(all.size());
        scene.intersect(all, together);
        std::map<std::uint32_t, std::size_t> met;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto alone = scene.intersect(all[i]);
            ASSERT_EQ(alone.has_value(), together[i].has_value());
            ASSERT_EQ(scene.occluded(all[i]), alone.has_value());
            if (!alone) continue;
            ++met[alone->geometry];
            ASSERT_EQ(alone->instance, together[i]->instance);
            ASSERT_EQ(alone->geometry, together[i]->geometry);
            ASSERT_EQ(alone->primitive, together[i]->primitive);
            ASSERT_EQ(alone->u, together[i]->u);
            ASSERT_EQ(alone->v, together[i]->v);
            ASSERT_EQ(alone->distance, together[i]->distance);
        }
        EXPECT_EQ(met.size(), 4u) << "each of the shapes is met";
    }
}

TEST(Instances, LetRaysLeaveThemCleanly) {
    SceneData data = instanced(false);
    const Frame f = Frame::around(normalize({1, 2, 3}));
    data.instances.push_back({0, affine(f.x * 50, f.y * 0.02f, f.z, {300, -200, 100})});
    data.instances.push_back({0, affine(f.x * 1e-3f, f.y * 1e-3f, f.z * 1e-3f, {5, 6, 7})});
    data.instances.push_back({0, affine(f.x + f.z * 20, f.y, f.z, {0, 0, 1000})});
    // one at a time: they may stand in each other's way
    const std::vector<Instance> all = data.instances;
    for (std::uint32_t k = 0; k < all.size(); ++k) {
        if (all[k].object != 0) continue;
        SceneData one = data;
        one.shapes[0] = one.shapes[1];
        one.objects[0].shapes = {3};  // a ball: what is curved never meets itself again outwards
        one.instances = {all[k]};
        one.objects.push_back({"rest", {0, 1, 2, 3}});
        const Scene scene(one);
        for (std::uint32_t i = 0; i < 4000; ++i) {
            Samples samples(1, i);
            const Vec2 name = samples.next_2d();
            const SurfacePoint at =
                scene.surface(Hit{.instance = 0, .geometry = 3, .u = name.x - 0.5f, .v = name.y - 0.5f});
            const Vec3 way = sphere(samples.next_2d()), out = dot(way, at.normal) > 0 ? way : -way;
            ASSERT_FALSE(scene.occluded({at.origin_towards(out), out})) << "instance " << k << " sample " << i;
            ASSERT_LT(at.offset, 0.05f) << "instance " << k;
        }
        one.objects[0].shapes = {1};
        for (auto& n : std::get<Mesh>(one.shapes[1].geometry).positions) n.y = 0;  // flat
        std::get<Mesh>(one.shapes[1].geometry).normals.clear();
        const Scene flat(one);
        for (std::uint32_t i = 0; i < 4000; ++i) {
            Samples samples(2, i);
            const Vec2 at = triangle(samples.next_2d());
            const SurfacePoint point =
                flat.surface(Hit{.instance = 0, .geometry = 1, .primitive = i % 288, .u = at.x, .v = at.y});
            const Vec3 way = sphere(samples.next_2d());
            ASSERT_FALSE(flat.occluded({point.origin_towards(way), way})) << "instance " << k << " sample " << i;
        }
    }
}

TEST(Instances, RefuseWhatIsNotThere) {
    const Scene scene(instanced(false));
    EXPECT_THROW(scene.surface(Query{.instance = 13, .geometry = 1}), Error);
    SceneData lost = instanced(false);
    lost.instances[3].object = 7;
    EXPECT_THROW(Scene{lost}, Error);
    lost = instanced(false);
    lost.objects[0].shapes[0] = 9;
    EXPECT_THROW(Scene{lost}, Error);
    lost = instanced(false);
    lost.instances[2].to_world.m[0] = {0, 0, 0, 0};
    EXPECT_THROW(Scene{lost}, Error);
    lost = instanced(false);
    lost.shapes[1].emission = AreaEmission{{1, 1, 1}};
    EXPECT_THROW(Scene{lost}, Error);
}

TEST(Instances, MayShareAShape) {
    SceneData data = instanced(false);
    data.objects.push_back({"again", {1}});
    data.instances.push_back({2, affine({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 20})});
    const auto hit = Scene(data).intersect({{0.01f, 5, 20.02f}, {0, -1, 0}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->geometry, 1u);
    EXPECT_EQ(hit->instance, 13u);
}

TEST(Instances, CountInTheSizeOfAScene) {
    const Scene scene(instanced(false));
    const SceneSize size = scene.size();
    EXPECT_EQ(size.triangles, 2 * 288u);
    EXPECT_EQ(size.instanced_triangles, 13 * 288u);
    EXPECT_GE(size.shape_bytes, 2 * (169 * (12 + 12 + 8) + 288 * 12u));
    EXPECT_GT(size.tree_bytes, 2 * 288 * 12u);
    EXPECT_LT(size.tree_bytes, 4u << 20);
}

// Squares of a board: every other one is a hole.
TEST(Holes, LetRaysThroughWhereTheyAre) {
    SceneData data;
    const TextureId there = colour(data, {1, 1, 1}), hole = colour(data, {0, 0, 0});
    data.textures.push_back({{1, 1, 1}, CheckerTexture{there, hole, {{8, 8}, {0, 0}, 0}}});
    const auto squares = TextureId(data.textures.size() - 1);
    const auto mask = diffuse(data, 0.5f);
    data.materials[mask].opacity = squares;
    Mesh board = quad({0, 0, 0}, {0, 0, 8}, {8, 0, 0});
    board.uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    add(data, board, mask);
    add(data, quad({-1, -1, -1}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 0.5f));
    const Scene scene(data);
    for (int x = 0; x < 8; ++x)
        for (int z = 0; z < 8; ++z) {
            const Ray ray{{float(x) + 0.4f, 3, float(z) + 0.6f}, {0, -1, 0}};
            const auto hit = scene.intersect(ray);
            ASSERT_TRUE(hit);
            EXPECT_EQ(hit->geometry, (x + z) % 2 == 0 ? 0u : 1u);
            EXPECT_EQ(scene.occluded({ray.origin, ray.direction, 3.5f}), (x + z) % 2 == 0);
        }
}

TEST(Holes, OfHalfOpacityLetHalfOfTheRaysThrough) {
    SceneData data;
    const auto veil = diffuse(data, 0.5f);
    data.materials[veil].opacity = colour(data, {0.3f, 0.3f, 0.3f});
    add(data, quad({0, 0, 0}, {0, 0, 8}, {8, 0, 0}), veil);
    add(data, ball({4, -5, 4}, 3), veil);
    const Scene scene(data);
    double veiled = 0, met = 0;
    constexpr std::uint32_t n = 1 << 15;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Vec2 u = Samples(1, i).next_2d();
        const Ray ray{{8 * u.x, 3, 8 * u.y}, {0, -1, 0}};
        const auto hit = scene.intersect(ray);
        ASSERT_EQ(hit.has_value(), scene.occluded(ray));
        veiled += hit && hit->geometry == 0;
        met += scene.occluded({{4 + 2 * (u.x - 0.5f), -1, 4 + 2 * (u.y - 0.5f)}, {0, -1, 0}});
    }
    EXPECT_NEAR(veiled / n, 0.3, 0.01);
    EXPECT_NEAR(met / n, 1 - 0.7 * 0.7, 0.01);  // both sides of the ball
}

TEST(Holes, ShapesOfNoMaterialAreNotThere) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f), nothing = material(data, NoMaterial{});
    add(data, quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), nothing).emission = AreaEmission{{1, 1, 1}, true};
    add(data, quad({0, -1, 0}, {0, 0, 1}, {1, 0, 0}), grey);
    const Scene scene(data);
    const auto hit = scene.intersect({{0.5f, 1, 0.4f}, {0, -1, 0}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->geometry, 1u);
    EXPECT_FALSE(scene.occluded({{0.5f, 1, 0.4f}, {0, -1, 0}, 1.5f}));
    EXPECT_TRUE(scene.lights().empty());
}

// A lamp with holes sends as much light by its points as by the rays that meet it.
TEST(Holes, OfALampShedNoLight) {
    SceneData data;
    const auto black = diffuse(data, 0);
    data.materials[black].opacity = colour(data, {0.25f, 0.25f, 0.25f});
    add(data, quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), black).emission = AreaEmission{{1, 1, 1}};
    const Scene scene(data);
    double by_points = 0, by_rays = 0;
    constexpr std::uint32_t n = 1 << 16;
    for (std::uint32_t i = 0; i < n; ++i) {
        Samples samples(1, i);
        if (const auto lamp = scene.lights().sample(LitPoint({0, 0, 0}), 0, samples.next_2d()))
            by_points += lamp->radiance.r / lamp->pdf / n;
        by_rays += scene.occluded({{0, 0, 0}, sphere(samples.next_2d())}) ? 4 * std::numbers::pi / n : 0;
    }
    EXPECT_NEAR(by_points / by_rays, 1, 0.03);
}

}  // namespace
}  // namespace lightnet::instances_test
