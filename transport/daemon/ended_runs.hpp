// The runs of a host that have ended, and the one that still ends.
#pragma once

#include <cstdint>
#include <future>
#include <optional>
#include <string>

#include "core/run/message/counters.hpp"
#include "transport/places/place_threads.hpp"

namespace lightnet {

/// One thread.
class EndedRuns {
public:
    /// A run whose threads may take a while to end. `route`: who wants its counters; empty: nobody. `so_far`: until
    /// they are there.
    void begin(std::uint64_t id, std::string route, const PlaceThreads::SoFar& so_far, std::future<Counters> counters);
    /// One has not ended yet.
    bool ending() const { return ending_.has_value(); }
    /// Its counters are wanted at that route. False: it is another that ends, or none.
    bool wanted_by(const std::string& route, std::uint64_t id);

    struct Ended {
        std::uint64_t id = 0;
        std::string route;
        Counters counters;
    };
    /// The run that has ended meanwhile; once. `broken_packets`: what its host has counted, which becomes the run's.
    /// A launcher that had lost sight of this host may have begun a run anew: it is told of both. Throws what its end
    /// has thrown.
    std::optional<Ended> look(std::uint64_t& broken_packets);

    /// Of all that have ended. Their places come together, as there may be many runs.
    const Counters& sum() const { return sum_; }
    /// Of the one that ends.
    PlaceThreads::SoFar so_far() const { return ending_ ? ending_->so_far : PlaceThreads::SoFar{}; }

private:
    struct Ending {
        std::uint64_t id = 0;
        std::string route;
        PlaceThreads::SoFar so_far;
        std::future<Counters> counters;
    };
    void add(const Counters& counters);

    std::optional<Ending> ending_;
    std::uint64_t last_ = 0;
    Counters of_last_;
    Counters sum_;
};

}  // namespace lightnet
