// Shards of calls, as a coordinator deals them out and takes in what comes of them.
#include <algorithm>

#include "core/base/error.hpp"
#include "core/run/master/coordinator.hpp"

namespace lightnet {
namespace {

std::string describe(const ShardDealer::Convicted& convicted) {
    std::string hosts;
    for (const auto& host : convicted.hosts) hosts += (hosts.empty() ? "" : ", ") + host;
    return "shard " + std::to_string(convicted.shard) +
           " of what it prepares is set aside: hosts died of it, with nothing else to do: " + hosts;
}

}  // namespace

void Coordinator::deal(std::size_t position) {
    const auto pulse = [this](const std::string& host) { return carrier_.pulse(host); };
    for (const auto& [number, call] : calls_.dealt_out(order_[position])) {
        call->dealer().feel_pulses(pulse, steady_seconds());
        for (const auto& [id, to, shards] : call->dealer().deal(copies(position).size(), steady_seconds())) {
            const Step step{Step::Kind::shards, number, shards.first, shards.count};
            if (!send({to, position, step, id})) call->dealer().refused(id, steady_seconds());
        }
    }
}

// With those of the proposal.
void Coordinator::keep_dealing() {
    for (std::size_t position = 0; position < led(); ++position)
        for (const auto& [number, call] : calls_.dealt_out(order_[position])) {
            const auto all = copies(position);
            auto& dealer = call->dealer();
            dealer.keep(plans_.proposed, {all.begin(), all.end()}, steady_seconds());
            if (const auto& convicted = dealer.convicted()) throw Error(name_of(position), describe(*convicted));
        }
}

void Coordinator::shards_done(const Sent& sent, const Bytes& data) {
    auto& call = calls_.of(order_[sent.position], sent.step.call);
    bool none_missing = false;
    try {
        none_missing = call.answer(sent.shards, data, steady_seconds());
    } catch (const Error& error) {
        return failed(sent, "'" + name_of(sent.position) + "' on " + sent.to.place.host + ": " + error.what());
    }
    none_missing ? advance() : deal(sent.position);
}

// It does no shards of this call yet, but will; all copies make the same calls.
bool Coordinator::will_join(const NodeCopy& copy, std::uint32_t number, ServiceCall& call) const {
    const auto found = followers_.find(copy);
    if (found == followers_.end() || found->second.state == Follower::State::idle) return true;
    const bool past = found->second.state == Follower::State::done || found->second.at.call > number;
    return !past && !call.dealer().has(copy);
}

// Those whose shards are all there; true: there are some. What is found to be false meanwhile is told at once.
bool Coordinator::end_calls() {
    bool ended = false;
    for (std::size_t position = 0; position < led(); ++position)
        for (const auto& [number, call] : calls_.dealt_out(order_[position])) {
            const auto all = copies(position);
            const bool more_to_come = std::any_of(
                all.begin(), all.end(),
                [&, number = number, call = call](const auto& copy) { return will_join(copy, number, *call); });
            const bool all_there = call->all_there(more_to_come);
            if (auto lie = call->lie()) {
                if (!answers_alone(plans_.proposed, *options_.graph, order_[position])) lie->host.clear();
                carrier_.doubt(*lie);
            }
            if (!all_there) continue;
            call->complete_from_shards();
            calls_.keep(order_[position], number);
            went_on_ = steady_seconds();
            ended = true;
        }
    return ended;
}

}  // namespace lightnet
