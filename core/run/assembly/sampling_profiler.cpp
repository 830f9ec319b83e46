#include "core/run/assembly/sampling_profiler.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/base/own_process.hpp"
#include "core/base/this_machine.hpp"

namespace lightnet {
namespace {

// Not in step with what repeats every ten milliseconds.
constexpr std::chrono::microseconds look_pause{9'700};

}  // namespace

struct SamplingProfiler::Tally {
    std::vector<const Gauge*> gauges;
    mutable std::mutex looks_mutex;
    std::vector<PlaceFigures> places;
    std::vector<std::uint64_t> nodes;  // looks
    std::jthread thread;

    void look(const Gauge& gauge, PlaceFigures& place);
    void watch(const std::stop_token& stop);
};

void SamplingProfiler::Tally::look(const Gauge& gauge, PlaceFigures& place) {
    switch (const auto doing = gauge.doing()) {
        case Gauge::idle:
            ++place.idle;
            return;
        case Gauge::waiting:
            ++place.waiting;
            return;
        case Gauge::asking:
            ++place.asking;
            return;
        default:
            ++place.busy;
            ++nodes[doing - Gauge::first_node];
    }
}

void SamplingProfiler::Tally::watch(const std::stop_token& stop) {
    std::condition_variable_any ended;
    std::mutex ended_mutex;
    std::unique_lock lock(ended_mutex);
    while (!ended.wait_for(lock, stop, look_pause, [&stop] { return stop.stop_requested(); })) {
        const std::lock_guard looks_lock(looks_mutex);
        for (std::size_t i = 0; i < gauges.size(); ++i) look(*gauges[i], places[i]);
    }
}

SamplingProfiler::SamplingProfiler(std::vector<const Gauge*> gauges) : tally_(std::make_unique<Tally>()) {
    tally_->places.resize(gauges.size());
    if (!gauges.empty()) tally_->nodes.resize(gauges.front()->nodes.size());
    tally_->gauges = std::move(gauges);
    tally_->thread = std::jthread([tally = tally_.get()](const std::stop_token& stop) { tally->watch(stop); });
}

SamplingProfiler::~SamplingProfiler() = default;

HostFigures SamplingProfiler::figures() const {
    HostFigures figures;
    std::vector<std::uint64_t> looks;
    {
        const std::lock_guard lock(tally_->looks_mutex);
        figures.places = tally_->places;
        looks = tally_->nodes;
    }
    figures.nodes.resize(looks.size());
    for (std::size_t node = 0; node < looks.size(); ++node) figures.nodes[node].looks = looks[node];
    for (const Gauge* gauge : tally_->gauges) {
        figures.edges.resize(gauge->edges.size());
        for (std::size_t edge = 0; edge < gauge->edges.size(); ++edge) {
            const auto& counts = gauge->edges[edge];
            figures.edges[edge] +=
                {counts.questions.get(), counts.bundles.get(), counts.sent.get(), counts.bytes.get()};
        }
        for (std::size_t node = 0; node < gauge->nodes.size(); ++node) {
            const auto& counts = gauge->nodes[node];
            figures.nodes[node] += {0,
                                    counts.waiting.get(),
                                    counts.bundles.get(),
                                    counts.questions.get(),
                                    counts.bytes.get(),
                                    counts.nanoseconds.get(),
                                    counts.answered.get()};
        }
    }
    figures.clock_ns = steady_nanoseconds();
    figures.processor_ns = static_cast<std::uint64_t>(processor_seconds() * 1e9);
    return figures;
}

}  // namespace lightnet
