#include "transport/hosted_run.hpp"

#include <algorithm>
#include <chrono>
#include <zmq.hpp>

#include "core/error.hpp"
#include "core/graph/check.hpp"

namespace lightnet {

HostedRun::HostedRun(zmq::context_t& context, BlobCache& cache, const Registry& registry, Given given)
    : context_(context), cache_(cache), registry_(registry), given_(std::move(given)) {
    check(given_.job.graph, registry_);  // it comes from outside, like the plan
    use(given_.plan);
    for (const auto& file : given_.job.files)
        if (!cache_.has(file.hash)) missing_.insert(file.hash);
}

HostedRun::~HostedRun() = default;

std::uint64_t HostedRun::size_of(const Hash& hash) const {
    for (const auto& file : given_.job.files)
        if (file.hash == hash) return file.size;
    return 0;
}

bool HostedRun::take_blob(const Hash& hash, std::uint64_t offset, std::uint64_t total, std::string_view bytes) {
    if (!missing_.contains(hash) || total != size_of(hash)) return false;
    auto& blob = partial_[hash];
    if (offset != blob.size() || bytes.size() > total - offset) return false;  // pieces come in order
    const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
    blob.insert(blob.end(), data, data + bytes.size());
    if (blob.size() < total) return true;
    if (content_hash(blob) != hash) throw Error("a file of the scene arrived damaged");
    cache_.keep(hash, blob);
    partial_.erase(hash);
    missing_.erase(hash);
    return true;
}

bool HostedRun::advance() {
    if (serving_) {
        places_->ready();  // throws what a place has died of
        return false;
    }
    if (!missing_.empty()) return false;
    if (!places_ && !building_.valid()) {
        building_ = std::async(std::launch::async, [this] {
            BlobFiles files(cache_, given_.job.files);
            return build_network(given_.job, registry_, files);
        });
    }
    if (building_.valid()) {
        if (building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
        places_ = std::make_unique<PlaceThreads>(context_, building_.get(), given_.id, given_.me, given_.places,
                                                 given_.plan, given_.job.rules);
    }
    serving_ = places_->ready();
    if (serving_) places_->use(given_.plan);  // it may have changed meanwhile
    return serving_;
}

void HostedRun::use(const Plan& plan) {
    if (!fits(plan, given_.job.graph)) throw Error("the plan does not fit the graph");
    given_.plan = plan;
    if (serving_) places_->use(plan);
}

Counters HostedRun::stop() {
    if (!places_) return {};
    auto counters = places_->stop();
    places_.reset();
    serving_ = false;
    return counters;
}

}  // namespace lightnet
