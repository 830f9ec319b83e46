#include "transport/daemon/ended_runs.hpp"

#include <chrono>
#include <utility>

namespace lightnet {

void EndedRuns::begin(std::uint64_t id, std::string route, const PlaceThreads::SoFar& so_far,
                      std::future<Counters> counters) {
    ending_ = Ending{id, std::move(route), so_far, std::move(counters)};
}

bool EndedRuns::wanted_by(const std::string& route, std::uint64_t id) {
    if (!ending_ || ending_->id != id) return false;
    ending_->route = route;
    return true;
}

std::optional<EndedRuns::Ended> EndedRuns::look(std::uint64_t& broken_packets) {
    if (!ending_ || ending_->counters.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    auto over = std::move(*ending_);
    ending_.reset();
    auto counters = over.counters.get();
    counters.broken_packets += std::exchange(broken_packets, 0);
    add(counters);
    if (last_ == over.id) counters += of_last_;
    last_ = over.id;
    of_last_ = counters;
    of_last_.places.clear(), of_last_.traces.clear();
    return Ended{over.id, std::move(over.route), std::move(counters)};
}

void EndedRuns::add(const Counters& counters) {
    for (const auto& [name, count] : Counters::all) sum_.*count += counters.*count;
    if (sum_.places.empty()) sum_.places.emplace_back();
    for (const auto& place : counters.places) {
        sum_.places[0].lived_ns += place.lived_ns;
        sum_.places[0].waited_ns += place.waited_ns;
        sum_.places[0].idle_ns += place.idle_ns;
    }
}

}  // namespace lightnet
