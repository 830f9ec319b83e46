// Rays that meet closed meshes where triangles share edges: why trees are robust ones.
#include <embree/rtcore.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/shapes/ray.hpp"

namespace lightnet::edges_test {
namespace {

// A closed box of squares in a turned place, or the ball that they make when their corners lie on one.
class Closed {
public:
    Closed(unsigned squares, bool round, RTCSceneFlags flags)
        : device_(rtcNewDevice("isa=avx2,threads=1")), scene_(rtcNewScene(device_)) {
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {-1.0f, 1.0f})
                for (unsigned i = 0; i < squares; ++i)
                    for (unsigned j = 0; j < squares; ++j) add_square(axis, side, squares, i, j);
        for (Vec3& p : corners_) {
            if (round) p = normalize(p);
            p = middle + Vec3{dot(p, {0.8f, 0.36f, 0.48f}), dot(p, {-0.6f, 0.48f, 0.64f}), dot(p, {0, -0.8f, 0.6f})};
        }
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto count = corners_.size();
        std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, count),
                    corners_.data(), count * 12);
        auto* indices = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count / 3));
        for (unsigned i = 0; i < count; ++i) indices[i] = i;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcSetSceneFlags(scene_, flags);
        rtcCommitScene(scene_);
    }
    ~Closed() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Closed(const Closed&) = delete;
    Closed& operator=(const Closed&) = delete;

    /// From inside, towards points of edges, a quarter of them corners.
    std::vector<Ray> to_edges(std::uint32_t count) const {
        std::vector<Ray> rays;
        for (std::uint32_t i = 0; i < count; ++i) {
            Samples samples(4, i);
            const auto first = std::size_t(samples.next() * float(corners_.size()));
            const Vec3 a = corners_[first], b = corners_[first / 3 * 3 + (first + 1) % 3];
            const float part = i % 4 == 0 ? 0 : samples.next();
            const Vec3 origin = middle + sphere(samples.next_2d()) * 0.3f;
            rays.push_back({origin, normalize(a + (b - a) * part - origin)});
        }
        return rays;
    }
    RTCScene scene() const { return scene_; }

private:
    void add_square(int axis, float side, unsigned squares, unsigned i, unsigned j) {
        const auto corner = [&](unsigned a, unsigned b) {
            Vec3 p;
            p[axis] = side;
            p[(axis + 1) % 3] = -1 + 2 * float(a) / float(squares);
            p[(axis + 2) % 3] = -1 + 2 * float(b) / float(squares);
            return p;
        };
        const Vec3 a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
        corners_.insert(corners_.end(), {a, b, c, a, c, d});
    }

    static constexpr Vec3 middle{37.3f, -31, 22.75f};
    RTCDevice device_;
    RTCScene scene_;
    std::vector<Vec3> corners_;  // three a triangle; those of neighbours are alike to the bit
};

void store(auto& packet, std::size_t i, const Ray& ray) {
    packet.org_x[i] = ray.origin.x, packet.org_y[i] = ray.origin.y, packet.org_z[i] = ray.origin.z;
    packet.dir_x[i] = ray.direction.x, packet.dir_y[i] = ray.direction.y, packet.dir_z[i] = ray.direction.z;
    packet.tfar[i] = ray.far;
    packet.mask[i] = ~0u;
}

/// Rays that leave a closed mesh, when asked for what they meet, and whether they meet anything.
struct Lost {
    std::size_t meeting = 0, looking = 0;
    bool operator==(const Lost&) const = default;
};

Lost alone(RTCScene scene, const std::vector<Ray>& rays) {
    Lost lost;
    for (const Ray& ray : rays) {
        const auto [o, d, far, time] = ray;
        RTCRayHit query{};
        query.ray = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, far, ~0u, 0, 0};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCRay shadow = query.ray;
        rtcIntersect1(scene, &query);
        rtcOccluded1(scene, &shadow);
        lost.meeting += query.hit.geomID == RTC_INVALID_GEOMETRY_ID;
        lost.looking += !(shadow.tfar < 0);
    }
    return lost;
}

template <class Packet, class Shadows>
Lost together(RTCScene scene, const std::vector<Ray>& rays, const auto& intersect, const auto& occluded) {
    constexpr std::size_t lanes = sizeof(Shadows::tfar) / sizeof(float);
    Lost lost;
    for (std::size_t first = 0; first + lanes <= rays.size(); first += lanes) {
        alignas(64) Packet packet;
        alignas(64) Shadows shadows;
        alignas(64) std::array<int, lanes> valid;
        std::memset(&packet, 0, sizeof packet);
        std::memset(&shadows, 0, sizeof shadows);
        valid.fill(-1);
        for (std::size_t i = 0; i < lanes; ++i) {
            store(packet.ray, i, rays[first + i]);
            store(shadows, i, rays[first + i]);
            packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        intersect(valid.data(), scene, &packet);
        occluded(valid.data(), scene, &shadows);
        for (std::size_t i = 0; i < lanes; ++i) {
            lost.meeting += packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID;
            lost.looking += !(shadows.tfar[i] < 0);
        }
    }
    return lost;
}

// DECISIONS: robust-trees
constexpr std::uint32_t count = 16384;

Lost lost_through(RTCSceneFlags flags, bool& alike) {
    Lost all;
    alike = true;
    for (const auto& [squares, round] : {std::pair{1u, false}, {6u, false}, {12u, true}, {40u, true}}) {
        const Closed mesh(squares, round, flags);
        const auto rays = mesh.to_edges(count);
        const Lost one = alone(mesh.scene(), rays);
        alike &= one ==
                 together<RTCRayHit4, RTCRay4>(
                     mesh.scene(), rays, [](auto... a) { rtcIntersect4(a...); }, [](auto... a) { rtcOccluded4(a...); });
        alike &= one ==
                 together<RTCRayHit8, RTCRay8>(
                     mesh.scene(), rays, [](auto... a) { rtcIntersect8(a...); }, [](auto... a) { rtcOccluded8(a...); });
        alike &= one == together<RTCRayHit16, RTCRay16>(
                            mesh.scene(), rays, [](auto... a) { rtcIntersect16(a...); },
                            [](auto... a) { rtcOccluded16(a...); });
        all.meeting += one.meeting;
        all.looking += one.looking;
    }
    return all;
}

// But for one in a thousand, of those that go straight for an edge.
TEST(Edges, HoldAlmostEveryRayOfRobustTreesAloneAndInPackets) {
    bool alike = false;
    const Lost lost = lost_through(RTC_SCENE_FLAG_ROBUST, alike);
    EXPECT_TRUE(alike);
    EXPECT_LE(lost.meeting, 4 * count / 1024);
    EXPECT_LE(lost.looking, 4 * count / 1024);
}

// If this fails Embree has changed: then the flag may be dropped, and rays cost less.
TEST(Edges, AreOpenToOneRayInFiftyInPlainTrees) {
    bool alike = true;
    const Lost lost = lost_through(RTC_SCENE_FLAG_NONE, alike);
    EXPECT_FALSE(alike) << "packets find what rays find alone: bytes would not depend on who goes together";
    EXPECT_GT(lost.meeting, 4 * count / 50);
}

}  // namespace
}  // namespace lightnet::edges_test
