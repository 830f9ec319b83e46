#include "tools/session/noise_of_run.hpp"

#include <algorithm>
#include <exception>
#include <thread>
#include <utility>

#include "core/base/spare_threads.hpp"
#include "core/base/unwanted.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/single_lights.hpp"
#include "core/readers/statistics.hpp"
#include "tools/explain/error_by_paths.hpp"
#include "tools/session/rendering.hpp"

namespace lightnet {
namespace {

constexpr double looked_at = 0.002;  // of the samples; at more places fewer, as they are looked at by one machine
constexpr std::size_t most_looking = 16;

// Before anybody renders.
bool looks_again(const Assignment& what) {
    const Graph& graph = what.job.graph;
    return preparing_nodes(graph, what.registry).empty() && shards_in(graph).empty() && !leaves_out(graph) &&
           !what.look_alone && !what.request.shown && what.request.looks.value_or(looked_at) > 0;
}

std::uint64_t samples_asked(const FilmFormat& format) {
    const Window all = format.crop.value_or(Window{0, 0, format.width, format.height});
    return std::uint64_t{all.width} * all.height * format.samples;
}

unsigned threads_that_look(const Assignment& what, std::size_t places) {
    if (what.request.mode == Mode::serial) return 1;
    if (what.request.threads > 0) return what.request.threads;
    return unsigned(std::min<std::size_t>(places, std::max(1u, std::thread::hardware_concurrency())));
}

}  // namespace

NetworkBeside::NetworkBeside(const Job& job, const Registry& registry, LoadedScene scene) {
    const auto given = std::make_shared<LoadedScene>(std::move(scene));
    building_ = in_background([&, given]() -> std::shared_ptr<const Network> {
        const LookingAt looking(&unwanted_);
        try {
            return build_network(job, registry, std::move(*given));
        } catch (const std::exception&) {  // those who render have what they need
            return nullptr;
        } catch (const Cancelled&) {
            return nullptr;
        }
    });
}

NetworkBeside::~NetworkBeside() { unwanted_ = true; }

std::shared_ptr<const Network> NetworkBeside::get() {
    if (building_.valid()) built_ = building_.get();
    return built_;
}

// DECISIONS: noise-by-paths
bool pays_to_build(std::uint64_t triangles, std::uint64_t samples) {
    constexpr std::uint64_t samples_of_triangle = 10;  // the trees of one take a tenth of a sample's time
    return triangles <= samples / samples_of_triangle;
}

std::shared_ptr<NetworkBeside> network_beside(const Assignment& what, LoadedScene scene) {
    if (looks_again(what) &&
        (scene.built || pays_to_build(statistics_of(scene.data).triangles, samples_asked(what.format))))
        return std::make_shared<NetworkBeside>(what.job, what.registry, std::move(scene));
    if (what.handover) what.handover->hold(std::move(scene.data));
    return nullptr;
}

void note_noise(RunRecorder& book, const Assignment& what) {
    if (!looks_again(what) || !book.steps().finished() || !book.steps().picture().complete()) return;
    const auto network = what.beside ? what.beside->get() : what.network;
    if (!network) return;
    if (what.beside && what.handover) what.handover->hold(network->scene);
    const PixelRecount::Source source{network, what.format, what.made_from, book.files().scale()};
    const std::size_t places = std::max<std::size_t>(1, book.account().report().places.size());
    const double part = looked_at * double(std::min(most_looking, places)) / double(places);
    const auto found = error_by_paths(book.files().now(), source, what.request.looks.value_or(part),
                                      {nullptr, threads_that_look(what, places), [] {}});
    if (!found) return;
    NoiseReport noise{found->error, found->pixels, {}};
    for (std::size_t kind = 0; kind < path_kinds; ++kind)
        noise.paths.emplace_back(word_of(static_cast<PathKind>(kind)), found->shares[kind]);
    book.account().report().noise = std::move(noise);
}

}  // namespace lightnet
