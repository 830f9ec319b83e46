#include "transport/daemon/hosted_run.hpp"

#include <algorithm>
#include <chrono>

#include "core/base/error.hpp"
#include "core/base/unwanted.hpp"

namespace lightnet {
namespace {

// Sizes come from the network.
std::uint64_t plus(std::uint64_t a, std::uint64_t b) { return a + std::min(b, ~std::uint64_t{0} - a); }

std::string in_words(std::uint64_t bytes) {
    if (bytes < 1 << 20) return std::to_string(bytes) + " bytes";
    return std::to_string(bytes >> 20) + " MiB";
}

}  // namespace

HostedRun::HostedRun(std::shared_ptr<const SocketContext> context, BlobCache& cache, const Registry& registry,
                     LastScene& last_scene, Assignment assignment, ShortWays ways)
    : context_(std::move(context)),
      ways_(std::move(ways)),
      cache_(cache),
      registry_(registry),
      last_scene_(last_scene),
      assignment_(std::move(assignment)),
      claim_(cache.claim()) {
    claim_files();
    expect(assignment_.plan);
    // DECISIONS: last-scene-stays
    last_ = last_scene_.take(scene_source(assignment_.job, registry_), [this](const Scene& built, bool other_parts) {
        return other_parts ? edited(assignment_.job, registry_, built) : seen_by(assignment_.job, registry_, built);
    });
    if (goes_on_from_kept(assignment_.job.graph, registry_)) last_.reset();
    has_last_scene_ = last_ != nullptr;
    looking_ = background_.start([this, room = room_] {
        std::set<Hash> missing;
        if (has_last_scene_) return missing;
        for (const auto& file : assignment_.job.files)
            if (!cache_.has(file.hash)) missing.insert(file.hash);
        cache_.make_room(room);
        return missing;
    });
}

// DECISIONS: caches-are-claimed
void HostedRun::claim_files() {
    std::set<Hash> all;
    for (const auto& file : assignment_.job.files) {
        auto& size = sizes_[file.hash];
        needed_ = plus(needed_, file.size - std::min(file.size, size));
        size = std::max(size, file.size);
        all.insert(file.hash);
    }
    if (needed_ > cache_.most_bytes())
        throw Error("the files of this run have " + in_words(needed_) + ", and the cache of this host may hold " +
                    in_words(cache_.most_bytes()) + " (lightnetd --cache-size)");
    room_ = needed_;
    claim_.add(all);
}

// Room is made in steps, as there may be many results.
void HostedRun::claim_result(const Hash& hash, std::uint64_t size) {
    constexpr std::size_t most_blobs = 1 << 20;
    if (!sizes_.emplace(hash, size).second) return;
    needed_ = plus(needed_, size);
    if (needed_ > cache_.most_bytes() || sizes_.size() > most_blobs)
        throw Error("the files of this run and what its nodes have prepared have " + in_words(needed_) +
                    ", and the cache of this host may hold " + in_words(cache_.most_bytes()) +
                    " (lightnetd --cache-size)");
    claim_.add({hash});
    if (needed_ <= room_) return;
    room_ = std::min(cache_.most_bytes(), std::max(needed_, 2 * room_));
    making_room_.push_back(background_.start([this, room = room_] { cache_.make_room(room); }));
}

void HostedRun::expect(const Hash& hash, std::uint64_t size, std::vector<std::string> holders) {
    if (!run_results_.in_memory(hash)) claim_result(hash, size);
    run_results_.expect(hash, size, std::move(holders));
}

bool HostedRun::take_blob(const packet::Piece& piece) {
    const auto& [hash, offset, bytes] = piece;
    if (run_results_.take(piece)) return true;
    if (state_ == State::looking) return false;
    if (!missing_.contains(hash)) return true;
    auto found = incoming_.find(hash);
    // a second one for the same file would take its first pieces away
    if (found == incoming_.end()) found = incoming_.emplace(hash, cache_.receive(hash, sizes_.at(hash))).first;
    auto& blob = found->second;
    if (!blob.take(offset, bytes)) return offset <= blob.here();  // else one before it is missing
    incoming_.erase(hash);
    missing_.erase(hash);
    return true;
}

bool HostedRun::advance() {
    const auto before = state_;
    constexpr auto now = std::chrono::seconds(0);
    if (state_ == State::looking && looking_.wait_for(now) == std::future_status::ready) {
        missing_ = looking_.get();
        state_ = State::fetching;
    } else if (state_ == State::fetching && missing_.empty()) {
        begin_to_build();
        state_ = State::building;
    } else if (state_ == State::building && building_.wait_for(now) == std::future_status::ready) {
        auto network = building_.get();
        last_scene_.hold(scene_source(assignment_.job, registry_), network->scene);
        const auto& [id, me, places, plan, job] = assignment_;
        transport_ = std::make_unique<ZmqPlaceTransport>(context_, id, me, places, ways_);
        places_ = std::make_unique<PlaceThreads>(*transport_, std::move(network), id, me, places, plan, job.tuning,
                                                 PlaceThreads::AskedFrom::other_hosts);
        state_ = State::starting;
    } else if (places_ && places_->ready() && state_ == State::starting) {  // throws what a place has died of
        state_ = State::serving;
    }
    return state_ != before;
}

void HostedRun::begin_to_build() {
    building_ = background_.start([this, last = std::move(last_)] {
        const LookingAt looking(&unwanted_);
        const auto find = [results = results_](const Hash& hash) { return results->find(hash); };
        if (last) return build_network(assignment_.job, registry_, last, find);
        BlobFiles files(cache_, assignment_.job.files);
        return build_network(assignment_.job, registry_, files, find);
    });
}

void HostedRun::use(const Plan& plan) {
    take_plan(plan);
    if (serving()) places_->use(plan);
}

void HostedRun::expect(const Plan& plan) { take_plan(plan); }

void HostedRun::take_plan(const Plan& plan) {
    if (!fits(plan, assignment_.job.graph)) throw Error("the plan does not fit the graph");
    assignment_.plan = plan;
}

void HostedRun::begin_to_stop() {
    unwanted_ = true;
    if (places_) places_->begin_to_stop();
}

Counters HostedRun::stop() {
    if (!places_) return {};
    auto counters = places_->stop();
    places_.reset();
    transport_.reset();
    state_ = State::fetching;
    return counters;
}

const char* HostedRun::words() const {
    switch (state_) {
        case State::looking:
            return "looks for files";
        case State::fetching:
            return "takes in files";
        case State::building:
            return "builds";
        case State::starting:
            return "starts its places";
        case State::serving:
            return "serves";
    }
    return "";
}

std::string HostedRun::nodes() const {
    std::string names;
    for (std::size_t node = 0; node < assignment_.plan.places_of.size(); ++node) {
        const auto& holders = assignment_.plan.places_of[node];
        const auto here = std::count_if(holders.begin(), holders.end(), [&](auto place) {
            return assignment_.plan.places[place].host == assignment_.me;
        });
        if (here > 0) names += (names.empty() ? "" : " ") + assignment_.job.graph.nodes[node].name;
        if (here > 1) names += "×" + std::to_string(here);
    }
    return names;
}

}  // namespace lightnet
