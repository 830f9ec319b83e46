#include "transport/threaded_run.hpp"

#include <zmq.hpp>

#include "transport/place_threads.hpp"
#include "transport/sockets.hpp"
#include "transport/zmq_carrier.hpp"

namespace lightnet {

struct ThreadedRun::Parts {
    std::unique_ptr<zmq::context_t> its_context = make_context(0);  // inproc needs no thread of ZeroMQ's own
    zmq::context_t& context = *its_context;
    PlaceThreads places;
    ZmqCarrier carrier;

    Parts(std::shared_ptr<const Network> network, std::uint64_t run, Plan plan, Tuning rules)
        : places(context, std::move(network), run, "", static_cast<std::uint32_t>(plan.places.size()), plan, rules),
          carrier(context, {run, "", false, 0}) {
        places.wait_until_ready();
    }
};

ThreadedRun::ThreadedRun(std::shared_ptr<const Network> network, std::uint64_t run, Plan plan, Tuning rules)
    : parts_(std::make_unique<Parts>(std::move(network), run, std::move(plan), rules)) {}

ThreadedRun::~ThreadedRun() = default;

Carrier& ThreadedRun::carrier() { return parts_->carrier; }

void ThreadedRun::check() { parts_->places.ready(); }

Counters ThreadedRun::stop() { return parts_->places.stop(); }

}  // namespace lightnet
