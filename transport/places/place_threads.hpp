// The places of one process, each a thread of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/message/figures.hpp"
#include "core/run/place/place.hpp"
#include "transport/places/place_transport.hpp"

namespace lightnet {

/// Starts a thread per place of `host`, and stops them. Where other hosts ask, one more is their Dispatcher. Used by
/// one thread.
class PlaceThreads {
public:
    /// Who asks the places: those of this process alone, or other hosts, too.
    enum class AskedFrom { here, other_hosts };
    /// `transport` outlives it; `plan`: that places make their nodes by. Where other hosts ask, it may name places that
    /// are not prepared, so nobody is asked by it: see use(). Throws Error when there are not enough threads
    /// to be had; none is left behind then.
    PlaceThreads(PlaceTransport& transport, std::shared_ptr<const Network> network, std::uint64_t run, std::string host,
                 std::uint32_t count, Plan plan, Tuning rules, AskedFrom askers = AskedFrom::here);
    /// Stops and joins.
    ~PlaceThreads();
    PlaceThreads(const PlaceThreads&) = delete;
    PlaceThreads& operator=(const PlaceThreads&) = delete;

    /// True when all places are assembled and serve. Throws Error when one could not be, or has died. Returns at once.
    bool ready();
    /// Waits for ready().
    void wait_until_ready();
    /// Tells every place who answers for which node from now on. Only when they are ready.
    void use(const Plan& plan);
    /// Tells all places to stop, and returns at once.
    void begin_to_stop();
    /// All threads are done with their work.
    bool over() const;
    /// Stops all places and returns what they counted. After this nothing else may be called.
    Counters stop();

    std::uint32_t count() const;
    /// Bundles and tiles answered so far, by all.
    std::uint64_t progress() const;
    /// See Gauge::pulse; of all places together.
    std::uint64_t pulse() const;
    /// What they have done so far, all together, as each last told: a few moments ago.
    struct SoFar {
        std::uint64_t rays = 0, lived_ns = 0, waited_ns = 0, idle_ns = 0;
    };
    SoFar so_far() const;
    /// From now on, looks at what they are at.
    void watch();
    /// What was seen since then.
    HostFigures figures() const;
    /// What their nodes say that they do while they prepare.
    Doings doing() const;
    /// Hosts that failed at what places of this process had asked them, since the last call.
    std::vector<Failure> failures();
    /// To be polled: readable when ready(), over() or failures() may have changed since clear_news().
    int news() const;
    void clear_news();

private:
    struct Threads;
    std::unique_ptr<Threads> threads_;
};

}  // namespace lightnet
