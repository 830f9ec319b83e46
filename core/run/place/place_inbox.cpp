#include "core/run/place/place_inbox.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <variant>

#include "core/run/place/full_bundle.hpp"

namespace lightnet {
namespace {

// Preparing, or a rehearsal.
bool is_learning(const Message& ask) {
    const auto* tiles = std::get_if<Questions<Tile>>(&ask.questions);
    return std::holds_alternative<Questions<Step>>(ask.questions) || (tiles && (*tiles)->front().rehearses());
}

}  // namespace

PlaceInbox::PlaceInbox(Lent lent)
    : at_(lent), nodes_(at_.network.graph.nodes.size()), by_rank_(at_.network.graph.nodes.size()) {
    const auto rank = ranks_of(at_.network.graph);
    std::iota(by_rank_.begin(), by_rank_.end(), 0);
    std::stable_sort(by_rank_.begin(), by_rank_.end(), [&](auto a, auto b) { return rank[a] < rank[b]; });
}

void PlaceInbox::take(Message ask) {
    if (!in_hand_.take(ask)) return;
    auto& inbox = nodes_[ask.node];
    inbox.questions += work_in(ask);
    at_.gauge.nodes[ask.node].waiting.set(inbox.questions);
    inbox.waiting.push_back(std::move(ask));
}

void PlaceInbox::cancel(const std::set<std::uint64_t>& lost) {
    if (lost.empty()) return;
    for (auto& inbox : nodes_) {
        at_.counters.cancelled += std::erase_if(inbox.waiting, [&](const Message& ask) {
            if (!lost.contains(ask.asker)) return false;
            in_hand_.let_go(AsksInHand::name_of(ask));
            return true;
        });
        inbox.questions = inbox.answering;
        for (const auto& ask : inbox.waiting) inbox.questions += work_in(ask);
    }
}

bool PlaceInbox::may_begin(std::size_t node) const {
    const auto& inbox = nodes_[node];
    return !inbox.waiting.empty() && (inbox.fibers == 0 || spare_in_use_ < at_.tuning.spare_fibers);
}

bool PlaceInbox::has_next(Role role) const {
    return std::ranges::any_of(by_rank_,
                               [&](auto node) { return may_begin(node) && at_.network.kind_of(node).role == role; });
}

// The first that waits, and small bundles behind it, from whomever, that make no more than a full one with it: a node
// that is called once for all has fewer, larger bundles to send itself, and answers don't depend on neighbours.
std::vector<Message> PlaceInbox::next(bool images) {
    const auto node = std::ranges::find_if(by_rank_, [&](auto candidate) {
        return may_begin(candidate) && (at_.network.kind_of(candidate).role == Role::image) == images;
    });
    std::vector<Message> asks;
    if (node == by_rank_.end()) return asks;
    auto& inbox = nodes_[*node];
    std::size_t questions = 0;
    const std::size_t most = full_bundle(at_.tuning.bundle, 1e-9 * inbox.question_ns);
    const auto fits = [&](const Message& ask) {
        return asks.empty() || (std::holds_alternative<Questions<Query>>(ask.questions) &&
                                std::holds_alternative<Questions<Query>>(asks.front().questions) &&
                                ask.width == asks.front().width && questions + work_in(ask) <= most);
    };
    while (!inbox.waiting.empty() && fits(inbox.waiting.front())) {
        questions += work_in(inbox.waiting.front());
        asks.push_back(std::move(inbox.waiting.front()));
        inbox.waiting.pop_front();
    }
    at_.counters.merged += asks.size() - 1;
    return asks;
}

PlaceInbox::Work PlaceInbox::begin(const std::vector<Message>& asks) {
    Work work{.node = asks.front().node, .questions = 0, .names = {}};
    auto& inbox = nodes_[work.node];
    work.spare = inbox.fibers++ > 0;
    work.shards = std::holds_alternative<Questions<Step>>(asks.front().questions);
    work.learning = is_learning(asks.front());
    for (const auto& ask : asks) {
        work.questions += work_in(ask);
        work.names.push_back(AsksInHand::name_of(ask));
    }
    spare_in_use_ += work.spare;
    inbox.answering += work.questions;
    return work;
}

Load PlaceInbox::end(const Work& work, std::uint64_t nanoseconds) {
    auto& inbox = nodes_[work.node];
    const double each = static_cast<double>(nanoseconds) / static_cast<double>(work.questions);
    inbox.figures.answered += work.questions;
    inbox.figures.busy_ns += nanoseconds;
    if (work.learning)  // what it tells of work of this kind, for those who plan later runs
        inbox.figures.shard_ns += nanoseconds;
    else
        inbox.figures.costs.add(each, work.questions);
    double& each_ns = work.shards ? inbox.shard_ns : inbox.question_ns;
    each_ns = each_ns > 0 ? 0.8 * each_ns + 0.2 * each : each;
    inbox.questions -= work.questions;
    inbox.answering -= work.questions;
    at_.gauge.nodes[work.node].waiting.set(inbox.questions);
    --inbox.fibers;
    spare_in_use_ -= work.spare;
    return {static_cast<std::uint32_t>(inbox.questions), static_cast<std::uint32_t>(std::clamp(each_ns, 1.0, 4e9))};
}

std::size_t PlaceInbox::waiting() const {
    std::size_t waiting = 0;
    for (const auto& inbox : nodes_) waiting += inbox.questions - inbox.answering;
    return waiting;
}

}  // namespace lightnet
