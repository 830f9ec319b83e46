#include "tests/bench/machine.hpp"

#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>
#include <utility>

#include "core/base/math/frame.hpp"
#include "core/base/math/random.hpp"
#include "core/base/math/sampling.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/landscape.hpp"

namespace lightnet::bench {
namespace {

constexpr std::size_t threads = 2, at_once = 4096;
const double seconds_each = sized(0.2, 0.01);
constexpr std::uint32_t side = 1024, packet = 4;  // pixels; rays go in squares of so many

void* buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const void* data, std::size_t stride,
             std::size_t count) {
    void* const to = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
    std::memcpy(to, data, stride * count);
    return to;
}

template <class R>
void set(R& ray, Vec3 origin, Vec3 direction) {
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tnear = ray.time = 0;
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
    ray.flags = ray.id = 0;
}

}  // namespace

Machine::Machine() : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    const Mesh mesh = landscape();
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions.data(), sizeof(Vec3),
           mesh.positions.size());
    buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles.data(), 3 * sizeof(std::uint32_t),
           mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    flights_[0] = from_camera();
    flights_[1] = bounced(flights_[0]);
    flights_[2] = bounced(flights_[1]);
}

Machine::~Machine() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

Machine::Flights Machine::from_camera() const {
    const Vec3 eye{7.5f, 5.5f, -7.5f}, towards{0, 1.8f, 0};
    const Vec3 ahead = normalize(towards - eye), right = normalize(cross(ahead, {0, 1, 0})), up = cross(right, ahead);
    const float half = std::tan(22.5f * pi / 180);
    Flights flights;
    for (std::uint32_t y = 0; y < side; y += packet)
        for (std::uint32_t x = 0; x < side; x += packet)
            for (std::uint32_t k = 0; k < packet * packet; ++k) {
                const float across = (float(x + k % packet) + 0.5f) / side * 2 - 1;
                const float down = (float(y + k / packet) + 0.5f) / side * 2 - 1;
                flights.push_back({eye, normalize(ahead + right * (across * half) + up * (-down * half))});
            }
    return flights;
}

Machine::Flights Machine::bounced(const Flights& arriving) const {
    Flights flights;
    for (std::size_t i = 0; i < arriving.size(); ++i) {
        RTCRayHit query;
        set(query.ray, arriving[i].origin, arriving[i].direction);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
        Vec3 normal = normalize({query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
        if (dot(normal, arriving[i].direction) > 0) normal = -normal;
        const Vec2 u{float(mix(2 * i) >> 40) * 0x1p-24f, float(mix(2 * i + 1) >> 40) * 0x1p-24f};
        const Vec3 origin = arriving[i].origin + arriving[i].direction * query.ray.tfar + normal * 1e-3f;
        flights.push_back({origin, Frame::around(normal).to_world(cosine_hemisphere(u))});
    }
    return flights;
}

#if LIGHTNET_EMBREE >= 4
auto tracers(bool coherent) {
    const auto flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    RTCIntersectArguments meeting;
    rtcInitIntersectArguments(&meeting);
    RTCOccludedArguments hiding;
    rtcInitOccludedArguments(&hiding);
    meeting.flags = hiding.flags = flags;
    return std::pair{[meeting](RTCScene scene, RTCRayHit& ray) mutable { rtcIntersect1(scene, &ray, &meeting); },
                     [hiding](RTCScene scene, RTCRay& ray) mutable { rtcOccluded1(scene, &ray, &hiding); }};
}
#else
auto tracers(bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return std::pair{[context](RTCScene scene, RTCRayHit& ray) mutable { rtcIntersect1(scene, &context, &ray); },
                     [context](RTCScene scene, RTCRay& ray) mutable { rtcOccluded1(scene, &context, &ray); }};
}
#endif

// M rays/s of all threads together.
double Machine::rate(const Flights& flights, bool shadows, bool coherent) const {
    std::array<std::size_t, threads> traced{};
    const auto begun = std::chrono::steady_clock::now();
    const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(); };
    const auto trace = [&](std::size_t thread) {
        _mm_setcsr(_mm_getcsr() | 0x8040);  // no denormals, as Embree recommends
        auto [meet, hide] = tracers(coherent);
        for (std::size_t i = thread * flights.size() / threads; passed() < seconds_each; traced[thread] += at_once)
            for (std::size_t k = 0; k < at_once; ++k, i = i + 1 < flights.size() ? i + 1 : 0) {
                RTCRayHit query;
                set(query.ray, flights[i].origin, flights[i].direction);
                if (shadows) {
                    hide(scene_, query.ray);
                } else {
                    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
                    meet(scene_, query);
                }
            }
    };
    {
        std::vector<std::jthread> all;
        for (std::size_t i = 0; i < threads; ++i) all.emplace_back(trace, i);
    }
    std::size_t sum = 0;
    for (const auto count : traced) sum += count;
    return double(sum) / passed() * 1e-6;
}

double Machine::speed() const {
    const auto best = [this](const Flights& flights, bool shadows, bool coherent) {
        double most = 0;
        for (int round = 0; round < 3; ++round) most = std::max(most, rate(flights, shadows, coherent));
        return most;
    };
    const std::array<double, 4> rates{best(flights_[0], false, true), best(flights_[1], false, false),
                                      best(flights_[2], false, false), best(flights_[1], true, false)};
    double product = 1;
    for (std::size_t i = 0; i < rates.size(); ++i) product *= rates[i] / goals_hold_at[i];
    return std::pow(product, 0.25);
}

}  // namespace lightnet::bench
