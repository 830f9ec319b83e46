// The places of one process, each a thread of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/run/prepare/assembly.hpp"
#include "core/run/runtime/place.hpp"

namespace zmq {
class context_t;
class socket_t;
}  // namespace zmq

namespace lightnet {

/// Starts a thread per place of `host`, and stops them. Used by one thread.
class PlaceThreads {
public:
    /// Throws Error when there are not enough threads or descriptors to be had; none is left behind then.
    PlaceThreads(zmq::context_t& context, std::shared_ptr<const Network> network, std::uint64_t run, std::string host,
                 std::uint32_t count, Plan plan, Tuning rules);
    /// Stops and joins.
    ~PlaceThreads();
    PlaceThreads(const PlaceThreads&) = delete;
    PlaceThreads& operator=(const PlaceThreads&) = delete;

    /// True when all places are assembled and serve. Throws Error when one could not be, or has died. Returns at once.
    bool ready();
    /// Waits for ready().
    void wait_until_ready();
    /// Tells every place who answers for which node from now on.
    void use(const Plan& plan);
    /// Tells all places to stop, and returns at once.
    void begin_to_stop();
    /// Stops all places and returns what they counted. After this nothing else may be called.
    Counters stop();

    std::uint32_t count() const;
    /// Bundles and tiles answered so far, by all.
    std::uint64_t progress() const;
    /// The socket that leads to a place; replies to what is sent there come back on it.
    zmq::socket_t& to(std::uint32_t place);
    /// Hosts that failed at what places of this process had asked them, since the last call.
    std::vector<Failure> failures();
    /// To be polled: readable when ready() or failures() may have changed since clear_news().
    int news() const;
    void clear_news();

private:
    struct Threads;
    std::unique_ptr<Threads> threads_;
};

}  // namespace lightnet
