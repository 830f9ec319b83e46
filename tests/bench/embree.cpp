// How much of a rendering is tracing rays: a whole serial render by PathTracing beside a bare loop over Embree that
// traces the same rays. The linker puts the functions of this file in the place of Embree's (--wrap), so that they can
// record what the renderer asks for, packet by packet. Arguments: samples per pixel (4).
#include <embree3/rtcore.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
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

namespace {

struct Recorded {
    RTCScene scene;
    std::variant<RTCRayHit, RTCRay, RTCRayHit8, RTCRay8> rays;
    std::array<int, 8> valid{};
};

std::vector<Recorded>* recording = nullptr;

}  // namespace

extern "C" {
void __real_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
void __real_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);
void __real_rtcIntersect8(const int*, RTCScene, RTCIntersectContext*, RTCRayHit8*);
void __real_rtcOccluded8(const int*, RTCScene, RTCIntersectContext*, RTCRay8*);

void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* rays) {
    if (recording) recording->push_back({scene, *rays, {}});
    __real_rtcIntersect1(scene, context, rays);
}
void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* rays) {
    if (recording) recording->push_back({scene, *rays, {}});
    __real_rtcOccluded1(scene, context, rays);
}
void __wrap_rtcIntersect8(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHit8* rays) {
    if (recording) {
        recording->push_back({scene, *rays, {}});
        std::copy(valid, valid + 8, recording->back().valid.begin());
    }
    __real_rtcIntersect8(valid, scene, context, rays);
}
void __wrap_rtcOccluded8(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay8* rays) {
    if (recording) {
        recording->push_back({scene, *rays, {}});
        std::copy(valid, valid + 8, recording->back().valid.begin());
    }
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

void replay(const std::vector<Recorded>& recorded) {
    for (const Recorded& each : recorded) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        alignas(64) std::array<int, 8> valid = each.valid;
        alignas(64) auto rays = each.rays;
        if (auto* one = std::get_if<RTCRayHit>(&rays)) __real_rtcIntersect1(each.scene, &context, one);
        if (auto* one = std::get_if<RTCRay>(&rays)) __real_rtcOccluded1(each.scene, &context, one);
        if (auto* many = std::get_if<RTCRayHit8>(&rays)) __real_rtcIntersect8(valid.data(), each.scene, &context, many);
        if (auto* many = std::get_if<RTCRay8>(&rays)) __real_rtcOccluded8(valid.data(), each.scene, &context, many);
    }
}

/// The same rays one by one, as a loop over Embree would be written at first.
void replay_singly(const std::vector<Recorded>& recorded) {
    const auto one_by_one = [](auto& many, const auto& valid, auto&& lane) {
        for (std::size_t i = 0; i < valid.size(); ++i)
            if (valid[i]) lane(many, static_cast<unsigned>(i));
    };
    for (const Recorded& each : recorded) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        alignas(64) auto rays = each.rays;
        if (auto* one = std::get_if<RTCRayHit>(&rays)) __real_rtcIntersect1(each.scene, &context, one);
        if (auto* one = std::get_if<RTCRay>(&rays)) __real_rtcOccluded1(each.scene, &context, one);
        if (auto* many = std::get_if<RTCRayHit8>(&rays))
            one_by_one(*many, each.valid, [&](auto& from, unsigned i) {
                RTCRayHit one = rtcGetRayHitFromRayHitN(reinterpret_cast<RTCRayHitN*>(&from), 8, i);
                __real_rtcIntersect1(each.scene, &context, &one);
            });
        if (auto* many = std::get_if<RTCRay8>(&rays))
            one_by_one(*many, each.valid, [&](auto& from, unsigned i) {
                RTCRay one = rtcGetRayFromRayN(reinterpret_cast<RTCRayN*>(&from), 8, i);
                __real_rtcOccluded1(each.scene, &context, &one);
            });
    }
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
    std::vector<double> ratios, whole_rates, bare_rates, single_rates;
    for (int round = 0; round < rounds; ++round) {
        const double begun = thread_seconds();
        replay(recorded);
        const double middle = thread_seconds();
        render();
        const double end = thread_seconds();
        replay_singly(recorded);
        const double bare = middle - begun, whole = end - middle, singly = thread_seconds() - end;
        single_rates.push_back(rays / singly * 1e-6);
        ratios.push_back(bare / whole);
        whole_rates.push_back(rays / whole * 1e-6);
        bare_rates.push_back(rays / bare * 1e-6);
    }
    std::printf("  %s: %.2f M rays/s of work in a whole render, %.2f M rays/s in the bare loop, %.2f M ray by ray\n",
                name, median(whole_rates), median(bare_rates), median(single_rates));
    show("part of the bare rate", ratios);
    figure(name, median(ratios), 0.6, true);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    return lightnet::bench::run("embree", [&] {
        const auto samples = static_cast<std::uint32_t>(argc > 1 ? std::max(1, std::atoi(argv[1])) : 4);
        const lightnet::Registry registry{lightnet::standard_nodes()};
        lightnet::bench::measure("embree.cornell", "", registry, samples);
        if (const char* shared = std::getenv("LIGHTNET_SHARED"))
            lightnet::bench::measure("embree.terrain", std::string(shared) + "/reference/terrain.pbrt", registry,
                                     samples);
    });
}
