// Shards of calls, as a coordinator has them dealt out and takes in what comes of them.
#include <algorithm>

#include "core/run/master/coordinator.hpp"

namespace lightnet {

// What nobody else can be asked about waits for those who may come.
void Coordinator::deal(std::size_t position) {
    const auto all = copies(position);
    for (const auto& [number, call] : calls_.dealt_out(order_[position])) {
        const ShardWork::Call of{order_[position], number};
        const bool more = std::ranges::any_of(all, [&](const auto& copy) { return will_join(copy, of); });
        shards_.deal(of, all.size(), more || carrier_.expects_hosts());
    }
}

// With those of the proposal.
void Coordinator::keep_dealing() {
    for (std::size_t position = 0; position < led(); ++position) {
        const auto all = copies(position);
        shards_.keep(order_[position], plans_.proposed, {all.begin(), all.end()});
    }
}

void Coordinator::doubt_shards(std::size_t node, Failure lie) {
    if (!answers_alone(plans_.proposed, *options_.graph, node)) lie.host.clear();
    carrier_.doubt(lie);
}

// It does no shards of this call yet, but will; all copies make the same calls.
bool Coordinator::will_join(const NodeCopy& copy, const ShardWork::Call& call) const {
    const auto found = followers_.find(copy);
    if (found == followers_.end() || found->second.state == Follower::State::idle) return true;
    const bool past = found->second.state == Follower::State::done || found->second.at.call > call.second;
    return !past && !shards_.has(copy, call);
}

// Those whose shards are all there; true: there are some.
bool Coordinator::end_calls() {
    bool ended = false;
    for (std::size_t position = 0; position < led(); ++position)
        for (const auto& [number, call] : calls_.dealt_out(order_[position])) {
            if (call->missing() > 0) continue;
            shards_.end({order_[position], number});
            call->complete_from_shards();
            calls_.keep(order_[position], number);
            went_on_ = steady_seconds();
            ended = true;
        }
    return ended;
}

}  // namespace lightnet
