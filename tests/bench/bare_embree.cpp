#include "tests/bench/bare_embree.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <variant>

#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/serial/serial.hpp"
#include "core/scene/scene.hpp"
#include "lua/load_graph.hpp"
#include "tests/bench/figure.hpp"

// The linker puts the functions of this file in the place of Embree's (--wrap), so that they can record what the
// renderer asks for, packet by packet.
namespace {

struct Recorded {
    RTCScene scene;
    RTCIntersectContextFlags flags;
    std::variant<RTCRayHit, RTCRay, RTCRayHit8, RTCRay8> rays;
    alignas(32) std::array<int, 8> valid{};
};

std::vector<Recorded>* recording = nullptr;

template <class Rays>
void record(RTCScene scene, const RTCIntersectContext* context, const Rays& rays, const int* valid = nullptr) {
    if (!recording) return;
    recording->push_back({scene, context->flags, rays, {}});
    if (valid) std::copy(valid, valid + 8, recording->back().valid.begin());
}

}  // namespace

extern "C" {
void __real_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
void __real_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);
void __real_rtcIntersect8(const int*, RTCScene, RTCIntersectContext*, RTCRayHit8*);
void __real_rtcOccluded8(const int*, RTCScene, RTCIntersectContext*, RTCRay8*);

void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* rays) {
    record(scene, context, *rays);
    __real_rtcIntersect1(scene, context, rays);
}
void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* rays) {
    record(scene, context, *rays);
    __real_rtcOccluded1(scene, context, rays);
}
void __wrap_rtcIntersect8(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHit8* rays) {
    record(scene, context, *rays, valid);
    __real_rtcIntersect8(valid, scene, context, rays);
}
void __wrap_rtcOccluded8(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay8* rays) {
    record(scene, context, *rays, valid);
    __real_rtcOccluded8(valid, scene, context, rays);
}
}

namespace lightnet::bench {
namespace {

/// Traces a packet where it lies.
struct TracePacket {
    Recorded& packet;
    RTCIntersectContext& context;
    void operator()(RTCRayHit& rays) const { __real_rtcIntersect1(packet.scene, &context, &rays); }
    void operator()(RTCRay& rays) const { __real_rtcOccluded1(packet.scene, &context, &rays); }
    void operator()(RTCRayHit8& rays) const {
        __real_rtcIntersect8(packet.valid.data(), packet.scene, &context, &rays);
    }
    void operator()(RTCRay8& rays) const { __real_rtcOccluded8(packet.valid.data(), packet.scene, &context, &rays); }
};

/// The same rays one by one, as a loop over Embree would be written at first.
struct TraceSingly {
    Recorded& packet;
    RTCIntersectContext& context;
    void operator()(RTCRayHit& ray) const { __real_rtcIntersect1(packet.scene, &context, &ray); }
    void operator()(RTCRay& ray) const { __real_rtcOccluded1(packet.scene, &context, &ray); }
    void operator()(RTCRayHit8& rays) const {
        each([&](unsigned i) {
            RTCRayHit one = rtcGetRayHitFromRayHitN(reinterpret_cast<RTCRayHitN*>(&rays), 8, i);
            (*this)(one);
        });
    }
    void operator()(RTCRay8& rays) const {
        each([&](unsigned i) {
            RTCRay one = rtcGetRayFromRayN(reinterpret_cast<RTCRayN*>(&rays), 8, i);
            (*this)(one);
        });
    }
    template <class Lane>
    void each(const Lane& lane) const {
        for (unsigned i = 0; i < packet.valid.size(); ++i)
            if (packet.valid[i]) lane(i);
    }
};

/// Seconds that tracing takes; those of bringing each block into the cache don't count.
template <class Trace>
double replay(const std::vector<Recorded>& recorded) {
    constexpr std::size_t in_block = (256 << 10) / sizeof(Recorded);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    std::vector<Recorded> block;
    double seconds = 0;
    for (std::size_t first = 0; first < recorded.size(); first += in_block) {
        const auto begin = recorded.begin() + static_cast<std::ptrdiff_t>(first);
        block.assign(begin, begin + static_cast<std::ptrdiff_t>(std::min(in_block, recorded.size() - first)));
        const double begun = thread_seconds();
        for (Recorded& packet : block) {
            context.flags = packet.flags;
            std::visit(Trace{packet, context}, packet.rays);
        }
        seconds += thread_seconds() - begun;
    }
    return seconds;
}

/// Throws where the renderer asked Embree in other ways than are recorded: the bare loop would have less to do.
void expect_all(const std::vector<Recorded>& recorded, double rays) {
    double sum = 0;
    for (const Recorded& each : recorded)
        sum += each.rays.index() < 2 ? 1 : double(std::count_if(each.valid.begin(), each.valid.end(), std::identity()));
    if (sum != rays) throw std::runtime_error("not all rays were recorded");
}

constexpr std::uint32_t tile_size = 32;  // as the launcher cuts them

Job job_of(const Registry& registry, const std::string& graph, const std::map<std::string, std::string>& constants) {
    Job job;
    job.graph = check(load_graph(LIGHTNET_SOURCE_DIR "/graphs/" + graph, LuaOptions{constants}), registry);
    job.scene = scene_file(job.graph, registry);
    job.isa = usual_isa();
    const GraphFilm film = film_of(job.graph, registry);
    job.width = film.width;
    job.height = film.height;
    return job;
}

}  // namespace

std::optional<BesideEmbree> beside_bare_embree(const Registry& registry, const std::string& graph,
                                               const std::map<std::string, std::string>& constants,
                                               std::size_t rounds) {
    const Job job = job_of(registry, graph, constants);
    DiskFiles disk;
    const auto network = build_network(job, registry, disk);
    const auto samples = std::get<double>(job.graph.nodes[renderer_of(job.graph, registry)].params.at("samples").data);
    const auto tiles = tiles_of(job.width, job.height, tile_size, static_cast<std::uint32_t>(samples));
    const auto render = [&] {
        SerialRun run(*network);
        run.prepare(made_from(job));
        for (const auto& tile : tiles) run.render(tile);
    };
    std::vector<Recorded> recorded;
    recording = &recorded;
    const auto before = Scene::rays_of_this_thread();
    render();
    BesideEmbree found;
    found.rays = double(Scene::rays_of_this_thread() - before);
    recording = nullptr;
    expect_all(recorded, found.rays);
    for (std::size_t round = 0; round < rounds; ++round) {
        const double bare = replay<TracePacket>(recorded);
        const double begun = thread_seconds();
        render();
        const double whole = thread_seconds() - begun;
        const double singly = replay<TraceSingly>(recorded);
        found.shares.push_back(bare / whole);
        found.whole_rates.push_back(found.rays / whole * 1e-6);
        found.bare_rates.push_back(found.rays / bare * 1e-6);
        found.single_rates.push_back(found.rays / singly * 1e-6);
    }
    return found;
}

}  // namespace lightnet::bench
