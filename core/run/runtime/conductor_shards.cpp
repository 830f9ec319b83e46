// How a conductor deals out the shards of calls, and takes in what comes of them.
#include "core/base/error.hpp"
#include "core/run/runtime/conductor.hpp"

namespace lightnet {
namespace {

std::string describe(const ShardDealer::Convicted& convicted) {
    std::string hosts;
    for (const auto& host : convicted.hosts) hosts += (hosts.empty() ? "" : ", ") + host;
    return "shard " + std::to_string(convicted.shard) +
           " of what it prepares is set aside: hosts died of it, with nothing else to do: " + hosts;
}

}  // namespace

void Conductor::deal(std::size_t position) {
    for (const auto& [number, call] : calls_.dealt_out(order_[position]))
        for (const auto& [id, to, shards] : call->dealer().deal(copies(position).size(), steady_seconds())) {
            const Step step{Step::Kind::shards, number, shards.first, shards.count};
            if (!send({to, position, step, id})) call->dealer().refused(id, steady_seconds());
        }
}

// With those of the proposal.
void Conductor::keep_dealing() {
    for (std::size_t position = 0; position < led(); ++position)
        for (const auto& [number, call] : calls_.dealt_out(order_[position])) {
            const auto all = copies(position);
            auto& dealer = call->dealer();
            dealer.keep(proposal_, {all.begin(), all.end()}, steady_seconds());
            if (const auto& convicted = dealer.convicted()) throw Error(name_of(position), describe(*convicted));
        }
}

void Conductor::shards_done(const Sent& sent, const Bytes& data) {
    auto& call = calls_.of(order_[sent.position], sent.step.call);
    bool all_there = false;
    try {
        all_there = call.answer(sent.shards, data, steady_seconds());
    } catch (const Error& error) {
        return failed(sent, "'" + name_of(sent.position) + "' on " + sent.to.place.host + ": " + error.what());
    }
    all_there ? advance() : deal(sent.position);
}

// Those whose shards are all there. What is found to be false meanwhile is told at once.
void Conductor::end_calls() {
    for (std::size_t position = 0; position < led(); ++position)
        for (const auto& [number, call] : calls_.dealt_out(order_[position])) {
            const bool all_there = call->all_there();
            if (auto lie = call->lie()) {
                if (!answers_alone(proposal_, *options_.graph, order_[position])) lie->host.clear();
                carrier_.doubt(*lie);
            }
            if (!all_there) continue;
            call->complete_from_shards();
            calls_.keep(order_[position], number);
        }
}

}  // namespace lightnet
