// How much of a rendering is tracing rays: a whole serial render by PathTracing beside a bare loop over Embree that
// traces the same packets of rays, in the same order. The linker puts the functions of this file in the place of
// Embree's (--wrap), so that they can record what the renderer asks for, packet by packet.
//
// The bare loop does nothing else: its packets are ready, as Embree wants them, where the processor's cache holds them.
// For that the recording is played in blocks of 256 KiB, each copied to one place before the clock starts, and traced
// there. What a program needs to make rays and to use hits costs the bare loop nothing.
// Arguments: samples per pixel (4).
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <variant>
#include <vector>

#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/runtime/fingerprint.hpp"
#include "core/run/runtime/job.hpp"
#include "core/run/runtime/serial.hpp"
#include "core/scene/scene.hpp"
#include "lua/load_graph.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/references.hpp"

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

constexpr std::uint32_t side = 128, tile_size = 32;
constexpr int rounds = 7;

std::shared_ptr<const Network> network_of(const std::string& scene, const Registry& registry,
                                          const std::string& samples) {
    LuaOptions constants{{{"width", std::to_string(side)}, {"height", std::to_string(side)}, {"samples", samples}}};
    if (!scene.empty()) constants.constants["file"] = scene;
    Job job;
    job.graph = check(load_graph(LIGHTNET_SOURCE_DIR "/graphs/path_all.lua", constants), registry);
    job.scene = scene_file(job.graph, registry);
    job.isa = usual_isa();
    job.width = job.height = side;
    DiskFiles disk;
    return build_network(job, registry, disk);
}

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

void measure(const char* name, const std::string& scene, const Registry& registry, std::uint32_t samples) {
    const auto network = network_of(scene, registry, std::to_string(samples));
    const auto tiles = tiles_of(side, side, tile_size, samples);
    const auto render = [&] {
        SerialRun run(*network);
        for (const auto& tile : tiles) run.render(tile);
    };
    std::vector<Recorded> recorded;
    recording = &recorded;
    const auto before = Scene::rays_of_this_thread();
    render();
    const double rays = double(Scene::rays_of_this_thread() - before);
    recording = nullptr;
    expect_all(recorded, rays);
    std::vector<double> ratios, whole_rates, bare_rates, single_rates;
    for (int round = 0; round < rounds; ++round) {
        const double bare = replay<TracePacket>(recorded);
        const double begun = thread_seconds();
        render();
        const double whole = thread_seconds() - begun;
        const double singly = replay<TraceSingly>(recorded);
        single_rates.push_back(rays / singly * 1e-6);
        ratios.push_back(bare / whole);
        whole_rates.push_back(rays / whole * 1e-6);
        bare_rates.push_back(rays / bare * 1e-6);
    }
    std::printf("  %s: %.2f M rays/s of work in a whole render, %.2f M rays/s in the bare loop, %.2f M ray by ray\n",
                name, median(whole_rates), median(bare_rates), median(single_rates));
    figure(name, ratios, 0.6, true);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    return lightnet::bench::run("embree", [&] {
        const auto samples = static_cast<std::uint32_t>(argc > 1 ? std::max(1, std::atoi(argv[1])) : 4);
        const lightnet::Registry registry{lightnet::standard_nodes()};
        lightnet::bench::measure("embree.cornell", "", registry, samples);
        if (const auto terrain = lightnet::bench::reference_file("terrain.pbrt"))
            lightnet::bench::measure("embree.terrain", terrain->string(), registry, samples);
        else
            lightnet::bench::not_run("embree.terrain", lightnet::bench::is_not_here("reference/terrain.pbrt"));
    });
}
