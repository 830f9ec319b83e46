#include "core/run/master/prepare_lead.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

bool has_locks(const Graph& graph, const Registry& registry) {
    return std::ranges::any_of(graph.nodes, [&](const Node& node) { return registry.find(node.kind)->run.locks; });
}

}  // namespace

PrepareLead::PrepareLead(PrepareOptions options, Carrier& carrier, Carrier& masters, Epoch& epoch)
    : masters_(masters),
      state_(*options.graph, *options.registry),
      calls_(*options.graph, options.made_from, options.cache, renewed_nodes(*options.graph, *options.registry)),
      steps_(options.run, state_.in_force, carrier),
      shards_({options.run, options.verify, state_, calls_, carrier}),
      rehearsals_({options.run, options.width, *options.registry, state_, calls_, steps_, masters, epoch}),
      departed_(state_, steps_, shards_, options.let_go_after),
      said_(options.say) {
    if (has_locks(*options.graph, *options.registry))
        locks_.emplace([this](const PlaceAt& place, const Step& step) { return steps_.send({{place, 0}, 0, step}); });
}

// What was asked of those who are gone is asked of others; what a rehearsal had noted there is lost.
void PrepareLead::propose(const Plan& plan) {
    std::set<PlaceAt> gone(state_.proposed.places.begin(), state_.proposed.places.end());
    for (const auto& place : plan.places) gone.erase(place);
    state_.propose(plan);
    steps_.lose(gone);
    std::erase_if(state_.followers, [&](const auto& follower) { return gone.contains(follower.first.place); });
    for (const auto& place : gone) {
        plan_.lose(place);
        if (locks_) locks_->lose(place);
    }
    if (!gone.empty()) rehearsals_.break_off();
    shards_.keep();
    rehearsals_.keep();
    advance();
}

void PrepareLead::begin_pass(std::uint32_t pass) {
    if (std::exchange(pass_, pass) == pass) return;
    const auto& order = state_.order;
    std::size_t first = 0;
    while (first < order.size() && !order.is_renewed(first)) ++first;
    if (first == order.size()) return;
    // What was asked of places that are still behind is not waited for: they are asked for the new pass as well.
    steps_.forget([&](std::size_t position) { return order.is_renewed(position); });
    for (auto& [copy, follower] : state_.followers)
        if (calls_.is_renewed(copy.node)) follower.state = Follower::State::idle, follower.at = {};
    for (std::size_t position = first; position < order.size(); ++position)
        if (order.is_renewed(position)) shards_.forget(position), calls_.forget(order.node(position));
    plan_.begin_pass();
    rehearsals_.end();  // late replies to the master before are no answers to the next
    state_.done = std::min(state_.done, first);
    if (!state_.proposed.places.empty()) advance();
}

// ---- leading --------------------------------------------------------------------------------------------------------

void PrepareLead::advance() {
    shards_.end_calls();
    for (bool more = true; more;) {
        for (std::size_t position = 0; position < state_.led(); ++position)
            for (const auto& copy : state_.copies(position)) lead(copy, position);
        more = shards_.end_calls();  // that waited for nothing but somebody to join
        if (!state_.all_done() && state_.can_be_asked(state_.done)) {
            ++state_.done;
            state_.goes_on();
            more = true;
        }
    }
    for (std::size_t position = 0; position < state_.led(); ++position) shards_.deal(position);
    if (rehearsals_.advance()) {
        enforce();  // who could not be asked because of the rehearsal before can be now
        rehearsals_.use(state_.in_force);
    }
    enforce();
    if (locks_) locks_->attend(state_.proposed.places);
}

void PrepareLead::lead(const NodeCopy& copy, std::size_t position) {
    auto& follower = state_.followers[copy];
    if (follower.state == Follower::State::idle) {
        if (!state_.may_begin(copy, position)) return;
        const auto first = first_call_of(state_.order.is_renewed(position) ? pass_ : 0);
        if (steps_.send({copy, position, {.kind = Step::Kind::prepare, .call = first}}))
            follower.state = Follower::State::asked;
    } else if (follower.state == Follower::State::waiting) {
        auto& call = calls_.reported(copy.node, follower.at);
        const auto result = calls_.result(copy.node, follower.at.call);
        if (!result) {
            if (call.shared_out()) shards_.join(copy, position, call);
            return;
        }
        const Hash& name = call.name(calls_.part_of(copy.node, call));
        if (masters_.bring(copy.place, name, result) &&
            steps_.send({copy, position, {.kind = Step::Kind::go_on, .call = follower.at.call, .data = name}}, result))
            follower.state = Follower::State::asked;
    }
}

void PrepareLead::enforce() {
    if (plan_.enforce(rehearsals_.copies())) masters_.adopt(state_.in_force);
}

void PrepareLead::tick() {
    if (!state_.followers.empty() && state_.in_force != state_.proposed) advance();  // someone is catching up
    if (locks_) locks_->attend(state_.proposed.places);
    departed_.let_go();
}

// ---- answers --------------------------------------------------------------------------------------------------------

void PrepareLead::take(Message message) {
    if (message.channel != StepLine::channel) {
        if (shards_.arrived(message)) advance();
        return;
    }
    const auto sent = steps_.answered(message);
    if (!sent || sent->step.kind == Step::Kind::leave) return;
    if (message.type == Message::Type::failure)
        return steps_.failed(*sent, message.trouble.why, state_.copies(sent->position));
    if (sent->step.kind == Step::Kind::grant) return;
    if (sent->step.kind == Step::Kind::attend) {
        if (!locks_) return;
        locks_->hear(sent->to.place, message.data);
        locks_->attend(state_.proposed.places);
    } else if (sent->step.kind == Step::Kind::collect) {
        if (rehearsals_.noted(*sent, message.data)) advance();
    } else {
        reported(*sent, message.data);
    }
}

void PrepareLead::reported(const SentStep& sent, const Bytes& data) {
    StepReport report;
    if (data && data->size() >= sizeof report) std::memcpy(&report, data->data(), sizeof report);
    if (!data || data->size() < sizeof report || report.kind > StepReport::Kind::last)
        return steps_.failed(sent,
                             "'" + state_.order.name(sent.position) + "' on " + sent.to.place.host +
                                 ": a report of preparing is damaged",
                             state_.copies(sent.position));
    said_.say(state_.graph.nodes[sent.to.node].name,
              {reinterpret_cast<const char*>(data->data()) + sizeof report, data->size() - sizeof report});
    auto& follower = state_.followers[sent.to];
    follower.at = report;
    follower.state = report.kind == StepReport::Kind::done ? Follower::State::done : Follower::State::waiting;
    // A copy has got past the calls before this one; others may be behind.
    if (!is_first_call(report.call) && state_.all_past(sent.position, report.call))
        calls_.all_have(state_.order.node(sent.position), report.call - 1);
    advance();
}

PrepareProgress PrepareLead::progress() const {
    PrepareProgress progress;
    if (state_.all_done()) return progress;
    progress.node = state_.order.name(state_.done);
    progress.position = state_.done + 1, progress.nodes = state_.order.size();
    const auto* call = calls_.unfinished(state_.order.node(state_.done));
    if (!call) return progress;
    if (call->shared_out())
        progress.done = call->what().count - call->missing(), progress.total = call->what().count;
    else
        rehearsals_.tell(progress);
    return progress;
}

}  // namespace lightnet
