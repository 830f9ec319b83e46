#include "transport/launcher/threaded_run.hpp"

#include <cstdint>
#include <limits>
#include <utility>

#include "transport/places/place_threads.hpp"

namespace lightnet {

struct ThreadedRun::Parts {
    std::unique_ptr<PlaceTransport> transport;
    PlaceThreads places;
    std::unique_ptr<Carrier> carrier = transport->asking_carrier();
};

ThreadedRun::ThreadedRun(std::shared_ptr<const Network> network, std::uint64_t run, Plan plan, Tuning rules,
                         const MakePlaceTransport& make_transport) {
    const auto count = static_cast<std::uint32_t>(plan.places.size());
    plan.edition = std::numeric_limits<std::uint32_t>::max();  // they are told no other, so no ask may wait for one
    auto transport = make_transport(run, count);
    auto& its_transport = *transport;
    parts_.reset(
        new Parts{std::move(transport), {its_transport, std::move(network), run, "", count, std::move(plan), rules}});
    parts_->places.wait_until_ready();
}

ThreadedRun::~ThreadedRun() = default;

Carrier& ThreadedRun::carrier() { return *parts_->carrier; }

void ThreadedRun::check() { parts_->places.ready(); }

void ThreadedRun::watch() { parts_->places.watch(); }
HostFigures ThreadedRun::figures() const { return parts_->places.figures(); }

Counters ThreadedRun::stop() { return parts_->places.stop(); }

}  // namespace lightnet
