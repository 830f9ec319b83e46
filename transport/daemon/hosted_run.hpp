// One run, as a host sees it: from the job's arrival to its end.
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/run/assembly/job.hpp"
#include "core/run/assembly/last_scene.hpp"
#include "transport/daemon/background_work.hpp"
#include "transport/daemon/run_results.hpp"
#include "transport/places/place_threads.hpp"
#include "transport/store/blob_cache.hpp"
#include "transport/store/cache_claim.hpp"
#include "transport/store/results.hpp"
#include "transport/wire/packet.hpp"
#include "transport/zmq/zmq_place_transport.hpp"

namespace lightnet {

/// Looks for the files of a job in the cache, takes in those that are missing, builds the network, and starts the
/// places. If it has the scene of the run before, and that is its own, no file is needed. Used by one thread, which
/// must stay free for heartbeats: what takes time happens in the background. What it puts into the cache is no more
/// than that may hold.
class HostedRun {
public:
    struct Assignment {
        std::uint64_t id = 0;
        std::string me;  // this host, as the plan calls it
        std::uint32_t places = 1;
        Plan plan;
        Job job;
    };
    HostedRun(std::shared_ptr<const SocketContext> context, BlobCache& cache, const Registry& registry,
              LastScene& last_scene, Assignment assignment, ShortWays ways = {});

    enum class State { looking, fetching, building, starting, serving };

    std::uint64_t id() const { return assignment_.id; }
    State state() const { return state_; }
    bool serving() const { return state_ == State::serving; }
    /// Files that are needed, and that the cache does not have; known when it no longer looks.
    const std::set<Hash>& missing() const { return missing_; }
    /// The files will be sent from their beginnings.
    void expect_files_anew() { incoming_.clear(); }
    /// Takes a piece of a file. True: it is here now. Throws Error when a whole file is not what it was named.
    bool take_blob(const packet::Piece& piece);
    /// Bytes that a step will name are to come, unless the cache has them; hosts that have them. Throws Error when they
    /// are too many.
    void expect(const Hash& hash, std::uint64_t size, std::vector<std::string> holders);
    RunResults& results() { return run_results_; }
    /// To be polled: readable when advance() or results() may have news.
    int news() const { return background_.handle(); }
    void clear_news() {
        background_.clear();
        if (places_) places_->clear_news();
    }
    /// Hosts that failed at what places of this run had asked them, since the last call.
    std::vector<Failure> failures() { return places_ ? places_->failures() : std::vector<Failure>{}; }
    /// Goes on with what can go on. True when the state has changed. Throws Error when it can't go on, or a place has
    /// died.
    bool advance();
    /// Null until the places have been started.
    PlaceThreads* places() { return places_.get(); }
    /// The way to them; null as long.
    ZmqPlaceTransport* transport() { return transport_.get(); }
    /// The plan that is in force from now on.
    void use(const Plan& plan);
    /// The plan that is going to be, as far as is known.
    void expect(const Plan& plan);
    /// Its threads end when they have done what they are at.
    void begin_to_stop();
    /// Waits until they have. The only thing that another thread may do, and then nothing else.
    Counters stop();
    /// Did it find the scene of the run before to be its own?
    bool has_last_scene() const { return has_last_scene_; }
    /// What it is at, and the nodes that this host holds now, by name, for display.
    const char* words() const;
    std::string nodes() const;

private:
    void take_plan(const Plan& plan);
    void begin_to_build();
    void claim_files();
    void claim_result(const Hash& hash, std::uint64_t size);

    std::shared_ptr<const SocketContext> context_;
    ShortWays ways_;  // of its places
    BlobCache& cache_;
    const Registry& registry_;
    LastScene& last_scene_;
    Assignment assignment_;
    State state_ = State::looking;
    std::shared_ptr<const Scene> last_;  // of the run before, until it is built on
    bool has_last_scene_ = false;
    std::future<std::set<Hash>> looking_;
    std::set<Hash> missing_;
    CacheClaim claim_;
    std::map<Hash, std::uint64_t> sizes_;  // of all that the run needs
    std::uint64_t needed_ = 0, room_ = 0;  // bytes: of these; that room was made for
    std::vector<std::future<void>> making_room_;
    std::map<Hash, BlobCache::Incoming> incoming_;
    std::future<std::shared_ptr<const Network>> building_;
    std::shared_ptr<Results> results_ = std::make_shared<Results>(cache_);  // of preparing; places read them
    RunResults run_results_{results_, background_};
    std::unique_ptr<ZmqPlaceTransport> transport_;
    std::unique_ptr<PlaceThreads> places_;
    std::atomic<bool> unwanted_{false};  // what is built
    BackgroundWork background_;          // last: what it does looks at the rest
};

}  // namespace lightnet
