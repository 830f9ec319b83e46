// Passes of the picture, as a coordinator goes from one to the next.
#include <algorithm>
#include <utility>

#include "core/run/master/coordinator.hpp"

namespace lightnet {

void Coordinator::begin_pass(std::uint32_t pass) {
    if (std::exchange(pass_, pass) == pass) return;
    std::size_t first = 0;
    while (first < order_.size() && !is_renewed(first)) ++first;
    if (first == order_.size()) return;
    // What was asked of places that are still behind is not waited for: they are asked for the new pass as well.
    std::erase_if(sent_, [this](const auto& sent) {
        return sent.second.step.kind < Step::Kind::attend && is_renewed(sent.second.position);
    });
    for (auto& [copy, follower] : followers_)
        if (calls_.is_renewed(copy.node)) follower.state = Follower::State::idle, follower.at = {};
    for (std::size_t position = first; position < order_.size(); ++position)
        if (is_renewed(position)) shards_.end_all(order_[position]), calls_.forget(order_[position]);
    known_prepared_.clear();
    end_rehearsal();  // late replies to the master before are no answers to the next
    done_ = std::min(done_, first);
    if (!plans_.proposed.places.empty()) advance();
}

}  // namespace lightnet
