#include "core/run/master/plan_in_force.hpp"

#include <algorithm>
#include <iterator>

namespace lightnet {
namespace {

constexpr double at_most_held_back = 1;   // seconds
constexpr std::size_t worth_telling = 8;  // one more for so many that can be asked already

// Is all of it there, and only a few more places of nodes that have many?
bool is_hardly_more(const Plan& plan, const Plan& than) {
    for (std::size_t node = 0; node < plan.places_of.size(); ++node) {
        const auto now = places_of(plan, node), before = places_of(than, node);
        if (!std::includes(now.begin(), now.end(), before.begin(), before.end())) return false;
        if (now.size() * worth_telling > before.size() * (worth_telling + 1)) return false;
    }
    return plan.places == than.places;
}

}  // namespace

// Places that still do or lack what is prepared elsewhere, but for those that had it once.
std::set<PlaceAt> PlanInForce::behind() const {
    std::set<PlaceAt> behind;
    for (std::size_t position = 0; position < state_.done; ++position)
        for (const auto& copy : state_.copies(position))
            if (!known_prepared_.contains(copy.place) && !state_.is_done(copy)) behind.insert(copy.place);
    if (rehearsing_)
        for (const auto& copy : state_.copies(state_.done))
            if (!rehearsing_->contains(copy)) behind.insert(copy.place);
    return behind;
}

// Who may be asked for what is prepared at this position. In a rehearsal, nodes are asked that prepare later, too.
std::set<NodeCopy> PlanInForce::copies_to_ask(std::size_t position, const std::set<PlaceAt>& late) const {
    const auto all = state_.copies(position);
    if (position < state_.done) {
        std::set<NodeCopy> done;
        std::copy_if(all.begin(), all.end(), std::inserter(done, done.end()),
                     [&](const auto& copy) { return state_.is_done(copy); });
        return done;
    }
    auto asked = state_.copies_in_force(position);
    if (!rehearsing_) return asked;
    if (position == state_.done) {
        asked.insert(rehearsing_->begin(), rehearsing_->end());
        return asked;
    }
    std::set<std::size_t> have_others;  // nodes
    for (const auto& copy : all)
        if (!late.contains(copy.place)) have_others.insert(copy.node);
    std::copy_if(all.begin(), all.end(), std::inserter(asked, asked.end()),
                 [&](const auto& copy) { return !late.contains(copy.place) || !have_others.contains(copy.node); });
    return asked;
}

// A node that moves is asked where it was until it is prepared wherever it is to be: nobody waits for it. But a place
// that is to hold nothing at all is about to leave, and gets no more work.
// DECISIONS: moves-are-plans
void PlanInForce::keep_where_it_was(Plan& plan, std::size_t position) const {
    const auto all = state_.copies(position);
    for (const auto node : state_.order.nodes_at(position)) {
        const auto is_to_come = [&](const NodeCopy& copy) { return copy.node == node && !state_.is_done(copy); };
        if (std::none_of(all.begin(), all.end(), is_to_come)) continue;
        const auto before = places_of(state_.in_force, node), wanted = places_of(state_.proposed, node);
        const auto stays = [&](std::uint32_t place) {
            const auto& all_nodes = state_.proposed.places_of;
            return std::any_of(all_nodes.begin(), all_nodes.end(), [&](const auto& holders) {
                return std::find(holders.begin(), holders.end(), place) != holders.end();
            });
        };
        auto& places = plan.places_of[node];
        for (std::uint32_t place = 0; place < plan.places.size(); ++place) {
            const auto& at = plan.places[place];
            if (before.contains(at) && !wanted.contains(at) && state_.is_done({at, node}) && stays(place))
                places.push_back(place);
        }
        std::sort(places.begin(), places.end());
    }
}

Plan PlanInForce::restricted() {
    const auto late = behind();
    if (state_.done == state_.order.size())
        for (const auto& place : state_.proposed.places)
            if (!late.contains(place)) known_prepared_.insert(place);
    Plan plan = state_.proposed;
    const auto keep = [&](std::size_t node, const auto& may_be_asked) {
        std::erase_if(plan.places_of[node], [&](auto place) { return !may_be_asked(plan.places[place]); });
    };
    for (std::size_t position = 0; position < state_.order.size(); ++position) {
        const auto asked = copies_to_ask(position, late);
        for (const auto node : state_.order.nodes_at(position))
            keep(node, [&](const PlaceAt& place) { return asked.contains({place, node}); });
        if (position < state_.done) keep_where_it_was(plan, position);
    }
    const auto in_time = [&](const PlaceAt& place) { return !late.contains(place); };
    for (std::size_t node = 0; node < plan.places_of.size(); ++node) {
        const auto& places = plan.places_of[node];
        if (std::any_of(places.begin(), places.end(), [&](auto place) { return in_time(plan.places[place]); }))
            keep(node, in_time);
    }
    return plan;
}

bool PlanInForce::enforce(const std::set<NodeCopy>* rehearsing) {
    rehearsing_ = rehearsing;
    auto plan = restricted();
    if (plan == state_.in_force) return false;
    // All places are told of each plan, so those of a crowd that come one by one are put in force some at a time.
    const bool lately = steady_seconds() - enforced_ < at_most_held_back;
    if (lately && plan != state_.proposed && is_hardly_more(plan, state_.in_force)) return false;
    enforced_ = steady_seconds();
    plan.edition = state_.in_force.edition + 1;
    state_.in_force = std::move(plan);
    return true;
}

}  // namespace lightnet
