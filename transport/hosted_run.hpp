// One run, as a host sees it: from the job's arrival to its end.
#pragma once

#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/runtime/job.hpp"
#include "transport/blob_cache.hpp"
#include "transport/packet.hpp"
#include "transport/place_threads.hpp"

namespace lightnet {

/// Collects the files of a job, builds its network beside the caller's thread, and starts the places. Used by one
/// thread, and never blocks it before stop().
class HostedRun {
public:
    struct Given {
        std::uint64_t id = 0;
        std::string me;  // this host, as the plan calls it
        std::uint32_t places = 1;
        Plan plan;
        Job job;
    };
    HostedRun(zmq::context_t& context, BlobCache& cache, const Registry& registry, Given given);
    ~HostedRun();

    std::uint64_t id() const { return given_.id; }
    /// Files that the cache does not have.
    const std::set<Hash>& missing() const { return missing_; }
    /// Takes a piece of a file. True: it was wanted and fits. Throws Error when a whole file is not what it was named.
    bool take_blob(const Hash& hash, std::uint64_t offset, std::uint64_t total, std::string_view bytes);
    /// Goes on with what can go on. True when this made the places ready. Throws Error when they can't be.
    bool advance();
    bool serving() const { return serving_; }
    /// Null until the places have been started.
    PlaceThreads* places() { return places_.get(); }
    void use(const Plan& plan);
    Counters stop();

private:
    std::uint64_t size_of(const Hash& hash) const;

    zmq::context_t& context_;
    BlobCache& cache_;
    const Registry& registry_;
    Given given_;
    std::set<Hash> missing_;
    std::map<Hash, std::vector<std::byte>> partial_;
    std::future<std::shared_ptr<const Network>> building_;
    std::unique_ptr<PlaceThreads> places_;
    bool serving_ = false;
};

}  // namespace lightnet
