// The part of a proposed plan that a coordinator puts in force: what can be asked by now.
#include <algorithm>
#include <iterator>
#include <set>

#include "core/run/master/coordinator.hpp"

namespace lightnet {
namespace {

constexpr double at_most_held_back = 1;   // seconds
constexpr std::size_t worth_telling = 8;  // one more for so many that can be asked already

std::set<PlaceAt> places_of(const Plan& plan, std::size_t node) {
    std::set<PlaceAt> places;
    for (const auto place : plan.places_of[node]) places.insert(plan.places[place]);
    return places;
}

// The same, but for a few more places of nodes that have many.
bool is_hardly_more(const Plan& plan, const Plan& than) {
    for (std::size_t node = 0; node < plan.places_of.size(); ++node) {
        const auto now = places_of(plan, node), before = places_of(than, node);
        if (!std::includes(now.begin(), now.end(), before.begin(), before.end())) return false;
        if (now.size() * worth_telling > before.size() * (worth_telling + 1)) return false;
    }
    return plan.places == than.places;
}

}  // namespace

// Copies that are in force: in a rehearsal, or prepared for the pass before. Somebody may ask them who has not heard
// yet that it is over.
std::set<NodeCopy> Coordinator::copies_in_force(std::size_t position) const {
    std::set<NodeCopy> all;
    for (const auto node : nodes_at(position)) {
        const auto in_force = places_of(plans_.in_force, node);
        for (const auto place : plans_.proposed.places_of[node])
            if (in_force.contains(plans_.proposed.places[place])) all.insert({plans_.proposed.places[place], node});
    }
    return all;
}

// Nobody waits for the slowest: those who still build are asked when they are done.
// DECISIONS: not-for-the-slowest
bool Coordinator::can_be_asked(std::size_t position) const {
    const auto asked = copies_in_force(position);
    if (!std::all_of(asked.begin(), asked.end(), [&](const auto& copy) { return is_done(copy); })) return false;
    const auto nodes = nodes_at(position);
    return std::all_of(nodes.begin(), nodes.end(), [&](std::size_t node) {
        const auto& places = plans_.proposed.places_of[node];
        return std::any_of(places.begin(), places.end(), [&](auto place) {
            return is_done({plans_.proposed.places[place], node});
        });
    });
}

// Places that still do or lack what is prepared elsewhere, but for those that had it once.
std::set<PlaceAt> Coordinator::behind() const {
    std::set<PlaceAt> behind;
    for (std::size_t position = 0; position < done_; ++position)
        for (const auto& copy : copies(position))
            if (!known_prepared_.contains(copy.place) && !is_done(copy)) behind.insert(copy.place);
    if (rehearsal_)
        for (const auto& copy : copies(done_))
            if (!rehearsal_->copies().contains(copy)) behind.insert(copy.place);
    return behind;
}

// Who may be asked for what is prepared at this position. In a rehearsal, nodes are asked that prepare later, too.
std::set<NodeCopy> Coordinator::copies_to_ask(std::size_t position, const std::set<PlaceAt>& late) const {
    const auto all = copies(position);
    if (position < done_) {
        std::set<NodeCopy> done;
        std::copy_if(all.begin(), all.end(), std::inserter(done, done.end()),
                     [&](const auto& copy) { return is_done(copy); });
        return done;
    }
    auto asked = copies_in_force(position);
    if (!rehearsal_) return asked;
    if (position == done_) {
        asked.insert(rehearsal_->copies().begin(), rehearsal_->copies().end());
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
void Coordinator::keep_where_it_was(Plan& plan, std::size_t position) const {
    const auto all = copies(position);
    for (const auto node : nodes_at(position)) {
        const auto is_to_come = [&](const NodeCopy& copy) { return copy.node == node && !is_done(copy); };
        if (std::none_of(all.begin(), all.end(), is_to_come)) continue;
        const auto before = places_of(plans_.in_force, node), wanted = places_of(plans_.proposed, node);
        const auto stays = [&](std::uint32_t place) {
            const auto& all_nodes = plans_.proposed.places_of;
            return std::any_of(all_nodes.begin(), all_nodes.end(), [&](const auto& holders) {
                return std::find(holders.begin(), holders.end(), place) != holders.end();
            });
        };
        auto& places = plan.places_of[node];
        for (std::uint32_t place = 0; place < plan.places.size(); ++place) {
            const auto& at = plan.places[place];
            if (before.contains(at) && !wanted.contains(at) && is_done({at, node}) && stays(place))
                places.push_back(place);
        }
        std::sort(places.begin(), places.end());
    }
}

void Coordinator::note_who_left(const Plan& before) {
    const double now = steady_seconds();
    for (std::size_t node = 0; node < before.places_of.size(); ++node) {
        const auto there = places_of(plans_.proposed, node);
        for (const auto place : before.places_of[node])
            if (const auto known = followers_.find({before.places[place], node});
                known != followers_.end() && !there.contains(before.places[place]))
                known->second.left = now;
        for (const auto& place : there)
            if (const auto known = followers_.find({place, node}); known != followers_.end()) known->second.left = 0;
    }
}

// Memory comes back when nobody can ask any more: some time after all have heard of the plan.
void Coordinator::let_go_of_left() {
    const double now = steady_seconds();
    if (now - plans_.looked < std::min(1.0, options_.let_go_after)) return;
    plans_.looked = now;
    for (auto known = followers_.begin(); known != followers_.end();) {
        auto& [copy, follower] = *known++;
        if (follower.left == 0 || follower.state == Follower::State::asked) continue;
        const bool asked = places_of(plans_.in_force, copy.node).contains(copy.place);
        if (asked) follower.left = now;
        if (asked || now - follower.left < options_.let_go_after) continue;
        if (send({copy, 0, {.kind = Step::Kind::leave}})) followers_.erase(std::prev(known));
    }
}

// Nobody is asked for a node that is not prepared there, except in a rehearsal. So that a place that has not heard of
// the newest plan asks nobody falsely either, who is in force for a node stays so until all have it.
Plan Coordinator::restricted() {
    const auto late = behind();
    if (done_ == order_.size())
        for (const auto& place : plans_.proposed.places)
            if (!late.contains(place)) known_prepared_.insert(place);
    Plan plan = plans_.proposed;
    const auto keep = [&](std::size_t node, const auto& may_be_asked) {
        std::erase_if(plan.places_of[node], [&](auto place) { return !may_be_asked(plan.places[place]); });
    };
    for (std::size_t position = 0; position < order_.size(); ++position) {
        const auto asked = copies_to_ask(position, late);
        for (const auto node : nodes_at(position))
            keep(node, [&](const PlaceAt& place) { return asked.contains({place, node}); });
        if (position < done_) keep_where_it_was(plan, position);
    }
    const auto in_time = [&](const PlaceAt& place) { return !late.contains(place); };
    for (std::size_t node = 0; node < plan.places_of.size(); ++node) {
        const auto& places = plan.places_of[node];
        if (std::any_of(places.begin(), places.end(), [&](auto place) { return in_time(plan.places[place]); }))
            keep(node, in_time);
    }
    return plan;
}

void Coordinator::enforce() {
    auto plan = restricted();
    if (plan == plans_.in_force) return;
    // All places are told of each plan, so those of a crowd that come one by one are put in force some at a time.
    const bool lately = steady_seconds() - plans_.enforced < at_most_held_back;
    if (lately && plan != plans_.proposed && is_hardly_more(plan, plans_.in_force)) return;
    plans_.enforced = steady_seconds();
    plans_.in_force = std::move(plan);
    carrier_.adopt(plans_.in_force);
    Message message;
    message.type = Message::Type::plan;
    message.run = options_.run;
    message.plan = std::make_shared<const Plan>(plans_.in_force);
    arrived_.push_back(std::move(message));
}

}  // namespace lightnet
