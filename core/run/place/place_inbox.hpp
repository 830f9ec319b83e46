// The asks that wait at a place, by node, and which of them comes next.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <set>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/assembly/gauge.hpp"
#include "core/run/message/asks_in_hand.hpp"
#include "core/run/message/asks_of_later_plans.hpp"
#include "core/run/message/counters.hpp"
#include "core/run/message/message.hpp"
#include "core/run/message/tuning.hpp"

namespace lightnet {

/// A bundle whose node has no fiber running is always given one; those of the lowest rank (the longest way down to a
/// node that asks nobody) go first. One place's.
class PlaceInbox {
public:
    /// The place's, which outlive it.
    struct Lent {
        const Network& network;
        const Tuning& tuning;
        Gauge& gauge;
        Counters& counters;
    };
    explicit PlaceInbox(Lent lent);

    /// Twice the same counts once.
    void take(Message ask);
    /// Those that wait for their plan, before they are taken.
    AsksOfLaterPlans& later() { return later_; }
    /// Nobody waits any more for answers to places of these names, see name_of().
    void cancel(const std::set<std::uint64_t>& lost);
    /// Asks of one node, of renderers or of others, which belong together; empty: there are none that may be begun.
    std::vector<Message> next(bool images);
    bool has_next(Role role) const;

    /// A fiber works on them.
    struct Work {
        std::size_t node, questions;
        bool spare = false, shards = false, learning = false;
        std::vector<AsksInHand::Name> names;
    };
    Work begin(const std::vector<Message>& asks);
    /// It has taken so long; what is to be said of the node's load.
    Load end(const Work& work, std::uint64_t nanoseconds);
    /// A question of this place's own nodes, which others could have answered, has taken so long.
    void answered_here(std::size_t node, std::chrono::nanoseconds took) {
        nodes_[node].figures.busy_ns += static_cast<std::uint64_t>(took.count());
    }
    /// Where the reply to one of them goes.
    Route let_go(const AsksInHand::Name& name) { return in_hand_.let_go(name); }

    bool knows(std::size_t node) const { return node < nodes_.size(); }
    /// Was it asked something that is not answered yet?
    bool owes_answers(std::size_t node) const { return nodes_[node].questions > 0; }
    /// Questions that no fiber works on.
    std::size_t waiting() const;
    /// What was answered, by node.
    const NodeRecord& figures(std::size_t node) const { return nodes_[node].figures; }

private:
    struct OfNode {
        std::deque<Message> waiting;
        std::size_t questions = 0;  // in `waiting`, and in answering
        std::size_t answering = 0;  // that fibers answer now
        std::size_t fibers = 0;     // that answer for this node now
        double question_ns = 0;     // per question about light or block of a tile, smoothed
        double shard_ns = 0;        // per shard, smoothed: one may take as long as ten thousand questions
        NodeRecord figures;
    };
    bool may_begin(std::size_t node) const;

    Lent at_;
    AsksOfLaterPlans later_;
    AsksInHand in_hand_;
    std::vector<OfNode> nodes_;
    std::vector<std::size_t> by_rank_;  // nodes, lowest rank first
    std::size_t spare_in_use_ = 0;
};

}  // namespace lightnet
