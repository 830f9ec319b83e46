// The facts about Embree on which "the same bytes everywhere" rests.
#include <embree/rtcore.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet::embree_test {
namespace {

struct Found {
    unsigned geometry, primitive, instance;
    float distance, u, v;
    bool operator==(const Found&) const = default;
};

// A bumpy grid, some scattered triangles, and two instances of the grid.
class World {
public:
    explicit World(const char* threads) : device_(rtcNewDevice((std::string("isa=avx2,") + threads).c_str())) {
        RTCScene part = rtcNewScene(device_);
        attach(part, grid());
        rtcSetSceneFlags(part, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(part);
        scene_ = rtcNewScene(device_);
        attach(scene_, grid());
        attach(scene_, scattered());
        for (const float shift : {-1.5f, 1.5f}) {
            RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(instance, part);
            const std::array<float, 12> place{1, 0, 0, 0, 1, 0.2f, 0, -0.2f, 1, shift, 0.3f, 0};
            rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, place.data());
            rtcCommitGeometry(instance);
            rtcAttachGeometry(scene_, instance);
            rtcReleaseGeometry(instance);
        }
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_);
        rtcReleaseScene(part);
    }
    ~World() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    Found one(const Ray& ray) const {
        RTCRayHit query = fill(ray);
        rtcIntersect1(scene_, &query);
        return {query.hit.geomID, query.hit.primID, query.hit.instID[0], query.ray.tfar, query.hit.u, query.hit.v};
    }
    bool hidden(const Ray& ray) const {
        RTCRayHit query = fill(ray);
        rtcOccluded1(scene_, &query.ray);
        return query.ray.tfar < 0;
    }
    /// Only lanes whose bit is set.
    template <std::size_t Lanes>
    std::array<Found, Lanes> packet(const Ray* rays, unsigned active) const {
        using Packet = std::conditional_t<Lanes == 8, RTCRayHit8, RTCRayHit16>;
        alignas(64) Packet packet;
        std::memset(&packet, 0, sizeof packet);
        alignas(64) std::array<int, Lanes> valid{};
        for (std::size_t i = 0; i < Lanes; ++i) {
            valid[i] = active >> i & 1 ? -1 : 0;
            store(packet.ray, i, rays[i]);
            packet.hit.geomID[i] = packet.hit.primID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        if constexpr (Lanes == 8)
            rtcIntersect8(valid.data(), scene_, &packet);
        else
            rtcIntersect16(valid.data(), scene_, &packet);
        std::array<Found, Lanes> found;
        for (std::size_t i = 0; i < Lanes; ++i)
            found[i] = {packet.hit.geomID[i], packet.hit.primID[i], packet.hit.instID[0][i],
                        packet.ray.tfar[i],   packet.hit.u[i],      packet.hit.v[i]};
        return found;
    }
    std::array<bool, 16> hidden16(const Ray* rays) const {
        alignas(64) RTCRay16 packet;
        std::memset(&packet, 0, sizeof packet);
        alignas(64) std::array<int, 16> valid;
        valid.fill(-1);
        for (std::size_t i = 0; i < 16; ++i) store(packet, i, rays[i]);
        rtcOccluded16(valid.data(), scene_, &packet);
        std::array<bool, 16> result;
        for (std::size_t i = 0; i < 16; ++i) result[i] = packet.tfar[i] < 0;
        return result;
    }

private:
    struct Triangles {
        std::vector<Vec3> corners;
        std::vector<std::array<unsigned, 3>> triangles;
    };
    static Triangles grid() {
        constexpr unsigned n = 80;
        Triangles result;
        for (unsigned i = 0; i <= n; ++i)
            for (unsigned j = 0; j <= n; ++j)
                result.corners.push_back(
                    {-1 + 2.0f * float(i) / n, 0.1f * std::sin(float(i * j) * 0.1f), -1 + 2.0f * float(j) / n});
        for (unsigned i = 0; i < n; ++i)
            for (unsigned j = 0; j < n; ++j) {
                const unsigned a = i * (n + 1) + j, b = a + 1, c = a + n + 1, d = c + 1;
                result.triangles.push_back({a, b, c});
                result.triangles.push_back({b, d, c});
            }
        return result;
    }
    static Triangles scattered() {
        Triangles result;
        for (unsigned i = 0; i < 3000; ++i) {
            Samples samples(1, i);
            const Vec3 at = sphere(samples.next_2d()) * 1.5f;
            for (int k = 0; k < 3; ++k) result.corners.push_back(at + sphere(samples.next_2d()) * 0.1f);
            result.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        return result;
    }
    void attach(RTCScene scene, const Triangles& triangles) {
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                            triangles.corners.size()),
                    triangles.corners.data(), triangles.corners.size() * sizeof(Vec3));
        std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                            triangles.triangles.size()),
                    triangles.triangles.data(), triangles.triangles.size() * 12);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    static RTCRayHit fill(const Ray& ray) {
        RTCRayHit query{};
        query.ray = {ray.origin.x,
                     ray.origin.y,
                     ray.origin.z,
                     0,
                     ray.direction.x,
                     ray.direction.y,
                     ray.direction.z,
                     0,
                     ray.far,
                     ~0u,
                     0,
                     0};
        query.hit.geomID = query.hit.primID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        return query;
    }
    template <class Packet>
    static void store(Packet& packet, std::size_t i, const Ray& ray) {
        packet.org_x[i] = ray.origin.x;
        packet.org_y[i] = ray.origin.y;
        packet.org_z[i] = ray.origin.z;
        packet.dir_x[i] = ray.direction.x;
        packet.dir_y[i] = ray.direction.y;
        packet.dir_z[i] = ray.direction.z;
        packet.tfar[i] = ray.far;
        packet.mask[i] = ~0u;
    }

    RTCDevice device_;
    RTCScene scene_;
};

std::vector<Ray> rays() {
    std::vector<Ray> result;
    for (std::uint32_t i = 0; i < 16 * 1500; ++i) {
        Samples samples(3, i);
        const Vec3 origin = sphere(samples.next_2d()) * 2;
        result.push_back({origin, normalize(sphere(samples.next_2d()) - origin)});
    }
    return result;
}

class Embree : public testing::Test {
protected:
    const World world{"threads=1"};
    const std::vector<Ray> all = rays();
};

TEST_F(Embree, BuildsTheSameWithOneThreadAndWithTwo) {
    const World other("threads=2");
    std::size_t hits = 0;
    for (const auto& ray : all) {
        const Found found = world.one(ray);
        hits += found.geometry != RTC_INVALID_GEOMETRY_ID;
        ASSERT_EQ(found, other.one(ray));
        ASSERT_EQ(world.hidden(ray), other.hidden(ray));
    }
    EXPECT_GT(hits, all.size() / 4);
}

// Large enough for each step of a build to be shared out, and full of what could be decided either way: triangles in
// the same place, twice in one mesh and in other meshes; slivers; triangles without area; a flat wall of many; all
// corners on a coarse grid, so that rays meet several at the same distance.
class Crowd {
public:
    explicit Crowd(unsigned threads)
        : device_(rtcNewDevice(("isa=avx2,start_threads=0,threads=" + std::to_string(threads)).c_str())),
          scene_(rtcNewScene(device_)) {
        for (std::uint32_t mesh = 0; mesh < 40; ++mesh)
            attach(mesh % 8 == 7 ? 20000 : mesh % 3 == 0 ? 4000 : 30, mesh / 2);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_);
    }
    ~Crowd() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Crowd(const Crowd&) = delete;
    Crowd& operator=(const Crowd&) = delete;

    Found meet(const Ray& ray) const {
        RTCRayHit query{};
        query.ray = {ray.origin.x,
                     ray.origin.y,
                     ray.origin.z,
                     0,
                     ray.direction.x,
                     ray.direction.y,
                     ray.direction.z,
                     0,
                     ray.far,
                     ~0u,
                     0,
                     0};
        query.hit.geomID = query.hit.primID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &query);
        return {query.hit.geomID, query.hit.primID, query.hit.instID[0], query.ray.tfar, query.hit.u, query.hit.v};
    }

private:
    // Pairs of meshes have the same key, and so the same triangles.
    void attach(std::uint32_t count, Key key) {
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* corners = static_cast<Vec3*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), 3 * count));
        auto* triangles = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count));
        for (std::uint32_t i = 0; i < count; ++i) {
            Samples samples(key, i % 5 == 4 ? i - 1 : i);  // some twice
            const Vec3 at = sphere(samples.next_2d()) * (1 + samples.next());
            for (std::uint32_t k = 0; k < 3; ++k) {
                Vec3 p = at + sphere(samples.next_2d()) * (i % 7 == 0 ? 0.9f : 0.1f);
                for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * 32) / 32;
                if (i % 4 == 1) p.y = -1;  // the wall
                corners[3 * i + k] = p;
                triangles[3 * i + k] = 3 * i + (i % 11 == 0 ? 0 : k);  // no area
            }
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }

    RTCDevice device_;
    RTCScene scene_;
};

TEST_F(Embree, BuildsTheSameWithAnyNumberOfThreadsHoweverMuchIsUndecided) {
    const Crowd one(1);
    std::vector<Found> expected;
    std::size_t hits = 0;
    for (const auto& ray : all) {
        expected.push_back(one.meet(ray));
        hits += expected.back().geometry != RTC_INVALID_GEOMETRY_ID;
    }
    EXPECT_GT(hits, all.size() * 9 / 10);
    for (const unsigned threads : {2, 3, 8, 0}) {  // 0: one per core
        const Crowd many(threads);
        for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(many.meet(all[i]), expected[i]) << threads;
    }
}

TEST_F(Embree, FindsTheSameAloneAndInAPacketWhoeverIsInIt) {
    for (std::size_t first = 0; first < all.size(); first += 16) {
        const auto active = static_cast<unsigned>(mix(first));
        const auto by8 = world.packet<8>(&all[first], active);
        const auto by16 = world.packet<16>(&all[first], active);
        for (std::size_t i = 0; i < 16; ++i) {
            if (!(active >> i & 1)) continue;
            const Found alone = world.one(all[first + i]);
            ASSERT_EQ(alone, by16[i]);
            ASSERT_TRUE(i >= 8 || alone == by8[i]);
        }
    }
}

TEST_F(Embree, HidesTheSameAloneAndInAPacket) {
    for (std::size_t first = 0; first < all.size(); first += 16) {
        const auto together = world.hidden16(&all[first]);
        for (std::size_t i = 0; i < 16; ++i) ASSERT_EQ(world.hidden(all[first + i]), together[i]);
    }
}

TEST_F(Embree, SaysHiddenWhereItFindsAHit) {
    for (const auto& ray : all) ASSERT_EQ(world.hidden(ray), world.one(ray).geometry != RTC_INVALID_GEOMETRY_ID);
}

}  // namespace
}  // namespace lightnet::embree_test
