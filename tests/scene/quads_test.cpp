// Triangles that go to Embree two by two.
#include "core/scene/geometry/quads.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/geometry/geometry.hpp"
#include "core/scene/surfaces/triangle.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::quads_test {
namespace {

using namespace test;

/// Hills, of cells cut along either diagonal, whose triangles begin with any of their corners.
Mesh hills(std::uint32_t side) {
    Mesh mesh;
    for (std::uint32_t row = 0; row <= side; ++row)
        for (std::uint32_t column = 0; column <= side; ++column) {
            const float x = float(column) / float(side) - 0.5f, z = float(row) / float(side) - 0.5f;
            mesh.positions.push_back({x, 0.1f * std::sin(9 * x) * std::cos(7 * z), z});
        }
    const auto add_turned = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t turn) {
        const std::array<std::uint32_t, 3> all{a, b, c};
        mesh.triangles.push_back({all[turn % 3], all[(turn + 1) % 3], all[(turn + 2) % 3]});
    };
    for (std::uint32_t cell = 0; cell < side * side; ++cell) {
        const std::uint32_t a = cell / side * (side + 1) + cell % side, b = a + 1, c = a + side + 1, d = c + 1;
        add_turned(a, c, cell % 2 ? d : b, cell);
        add_turned(b, cell % 2 ? a : c, d, cell / 3);
    }
    return mesh;
}

TEST(Quads, HoldEachTriangleOnce) {
    const Mesh mesh = hills(20);
    const Quads quads(mesh);
    EXPECT_EQ(quads.size() * 2, mesh.triangles.size());
    std::vector<int> times(mesh.triangles.size());
    for (std::uint32_t q = 0; q < quads.size(); ++q) quads.each_triangle(q, [&](std::uint32_t t) { ++times[t]; });
    EXPECT_EQ(times, std::vector<int>(mesh.triangles.size(), 1));
}

TEST(Quads, LeaveTrianglesAloneThatTouchNoOther) {
    Mesh mesh = hills(4);
    for (auto& triangle : mesh.triangles)  // corners of its own
        for (auto& corner : triangle) {
            mesh.positions.push_back(mesh.positions[corner]);
            corner = std::uint32_t(mesh.positions.size() - 1);
        }
    const Quads quads(mesh);
    ASSERT_EQ(quads.size(), mesh.triangles.size());
    for (std::uint32_t q = 0; q < quads.size(); ++q) {
        const TrianglePoint point = quads.point(q, {0.25f, 0.5f});
        EXPECT_EQ(point.triangle, q);
        EXPECT_EQ(point.at, (Vec2{0.25f, 0.5f}));
    }
}

// A quad's point lies on the plane through three of its corners: 0, 1 and 3 up to the diagonal, 2, 3 and 1 beyond.
TEST(Quads, NameThePointOfTheTriangleThatIsMet) {
    const Mesh mesh = hills(20);
    const Quads quads(mesh);
    for (std::uint32_t q = 0; q < quads.size(); ++q) {
        Samples samples(1, q);
        const Vec2 at = samples.next_2d();
        const auto& corner = quads.corners()[q];
        const auto position = [&](std::size_t i) { return mesh.positions[corner[i]]; };
        const Vec3 expected =
            at.x + at.y <= 1 ? position(0) * (1 - at.x - at.y) + position(1) * at.x + position(3) * at.y
                             : position(2) * (at.x + at.y - 1) + position(3) * (1 - at.x) + position(1) * (1 - at.y);
        const TrianglePoint point = quads.point(q, at);
        const Vec3 found = on_triangle(corners(mesh, point.triangle), point.at.x, point.at.y);
        ASSERT_LT(length(found - expected), 1e-6f) << "quad " << q;
    }
}

/// Hills, hills above them that let rays through, a ball, and hills that stand there twice besides.
SceneData landscape(float opacity) {
    SceneData data;
    const auto grey = diffuse(data, 0.5f);
    add(data, hills(40), grey);
    add(data, ball({0, 0.3f, 0}, 0.1f), grey);
    Mesh above = hills(15);
    for (auto& at : above.positions) at.y += 0.5f;
    add(data, above, diffuse(data, 0.3f));
    data.materials.back().opacity = colour(data, {opacity, opacity, opacity});
    add(data, hills(7), grey);
    data.objects.push_back({"part", {3}});
    for (const float shift : {-0.7f, 0.8f}) {
        Instance& instance = data.instances.emplace_back();
        instance.to_world.m[0][3] = shift;
        instance.to_world.m[1][0] = 0.3f;
    }
    return data;
}

struct World {
    explicit World(std::size_t quads_from, float opacity = 0.5f)
        : data(landscape(opacity)), geometry(data, shading, {.quads_from = quads_from}) {}
    Vec3 position(const Hit& hit) const {
        SurfacePoint point;
        shading.find(hit, point);
        return point.position;
    }
    SceneData data;
    Shading shading{data};
    Geometry geometry;
};

std::vector<Ray> rays_into(std::size_t count) {
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples samples(4, i);
        const Vec3 origin = sphere(samples.next_2d()) * 2;
        rays.push_back({origin, normalize(sphere(samples.next_2d()) * 0.5f - origin)});
    }
    return rays;
}

bool same_hit(const std::optional<Hit>& a, const std::optional<Hit>& b) {
    if (!a || !b) return !a == !b;
    return a->instance == b->instance && a->geometry == b->geometry && a->primitive == b->primitive && a->u == b->u &&
           a->v == b->v && a->distance == b->distance;
}

// Where rays meet an edge, either triangle may be the one; elsewhere, roundings differ. (Nothing here lets rays
// through: what does so goes by the last bits.)
TEST(Quads, AreMetWhereTheirTrianglesAre) {
    const World plain(1u << 30, 1), paired(0, 1);
    const auto rays = rays_into(40000);
    std::size_t there = 0, other = 0;
    for (const Ray& ray : rays) {
        const auto a = plain.geometry.intersect(ray), b = paired.geometry.intersect(ray);
        if (!a || !b) {
            other += a || b;
            continue;
        }
        ++there;
        if (a->geometry != b->geometry || a->primitive != b->primitive || a->instance != b->instance) {
            ++other;
            continue;
        }
        ASSERT_LT(length(plain.position(*a) - paired.position(*b)), 1e-5f);
        ASSERT_NEAR(a->distance, b->distance, 1e-4f);
    }
    EXPECT_GT(there, 20000u);
    EXPECT_LT(other, 40u);  // an edge, a rim
}

TEST(Quads, GiveTheSameHitsOneByOneAndManyAtOnce) {
    const World world(0);
    const auto rays = rays_into(5003);
    std::vector<std::optional<Hit>> together(rays.size());
    std::vector<std::uint8_t> hidden(rays.size());
    world.geometry.intersect(rays, together);
    world.geometry.occluded(rays, hidden);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same_hit(world.geometry.intersect(rays[i]), together[i])) << i;
        ASSERT_EQ(world.geometry.occluded(rays[i]), hidden[i] != 0);
        ASSERT_EQ(together[i].has_value(), hidden[i] != 0) << i;
    }
}

TEST(Quads, LeaveTheNearestSurfaceAsItIs) {
    const World plain(1u << 30), paired(0);
    std::size_t there = 0;
    for (std::uint32_t i = 0; i < 500; ++i) {
        Samples samples(6, i);
        const SurfaceWish wish{sphere(samples.next_2d()) * 0.6f, {}, 0.3f};
        const auto a = plain.geometry.nearest({plain.data, plain.shading}, wish);
        const auto b = paired.geometry.nearest({paired.data, paired.shading}, wish);
        ASSERT_TRUE(same_hit(a, b)) << i;
        there += a.has_value();
    }
    EXPECT_GT(there, 300u);
}

TEST(Quads, NeedLessMemoryThanTheirTriangles) {
    SceneData data, same;
    add(data, hills(300), diffuse(data, 0.5f));
    same = data;
    const Shading shading(data), same_shading(same);
    const Geometry plain(data, shading, {.quads_from = 1u << 30}), paired(same, same_shading, {.quads_from = 0});
    EXPECT_LT(double(paired.memory()), 0.9 * double(plain.memory()));
}

}  // namespace
}  // namespace lightnet::quads_test
