#include "core/run/schedule/scheduler.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/run/schedule/choice.hpp"
#include "core/run/schedule/rescue.hpp"
#include "core/run/schedule/tail_doubling.hpp"

namespace lightnet {
namespace {

using Item = Backlog::Item;
using Terms = ScheduleTerms;

/// What becomes of the state by one event.
class Reaction {
public:
    Reaction(ScheduleState& state, Terms::Time now) : state_(state), now_(now) {}

    void operator()(const Terms::Added& event);
    void operator()(const Terms::Foreseen& event) { state_.backlog.foresee(event.questions); }
    void operator()(const Terms::Joined& event);
    void operator()(const Terms::HostsExpected& event) { state_.more_hosts = event.more; }
    void operator()(const Terms::Resized& event);
    void operator()(const Terms::Draining& event);
    void operator()(const Terms::Gone& event);
    void operator()(const Terms::Replied& event);
    void operator()(const Terms::Failed& event);
    void operator()(const Terms::Alive& event) { state_.book[event.replica].last_sign = now_; }
    void operator()(const Terms::Refused& event);
    void operator()(const Terms::Faded& event);
    void operator()(const Terms::Dropped& event);
    void operator()(const Terms::Forgotten& event);
    void operator()(const Terms::Tick& event);

private:
    void go(Terms::Replica replica, bool died, bool alone);
    void blame(Item& item, const Suspects::Loss& loss);
    Item* take_copy(Terms::CopyId copy, const InFlight::Closed& closed);
    void expect_again();
    void measure(Terms::Replica replica, const InFlight::Copy& copy, const Terms::Replied& reply);
    void hand_out();
    void act(const Terms::Action& action) { state_.actions->push_back(action); }

    ScheduleState& state_;
    Terms::Time now_;
};

// Copies that a host has.
std::size_t under_way(const ScheduleState& state, Terms::Host host) {
    std::size_t copies = 0;
    const auto& hosts = state.book.on_hosts();
    if (const auto found = hosts.find(host); found != hosts.end())
        for (const auto replica : found->second) copies += state.in_flight.of(replica).size();
    return copies;
}

// ---- work comes and goes ----

void Reaction::operator()(const Terms::Added& event) {
    state_.backlog.add(event);
    if (state_.order.note_size(event.questions)) state_.refresh_all();
}

void Reaction::operator()(const Terms::Dropped&) {
    auto& queues = state_.backlog.queues;
    for (const auto& queue : {std::exchange(queues.first, {}), std::exchange(queues.overdue, {}),
                              state_.suspects.drop(), std::exchange(queues.retries, {})})
        for (const auto work : queue)
            if (state_.backlog.find_waiting(work)) state_.finish(work);
    state_.backlog.foresee(0);
    state_.rules.double_tail = false;  // what is left is waited for, and not worth doing twice
}

void Reaction::operator()(const Terms::Forgotten& event) {
    if (state_.backlog.knows(event.work)) state_.finish(event.work);
}

// ---- replicas come and go ----

void Reaction::operator()(const Terms::Joined& event) {
    state_.book.join(event, state_.rules.patience);
    state_.order.times().forget(event.replica);
    for (const auto work : state_.suspects.came_back(event.host, event.process))
        if (state_.backlog.find_waiting(work)) state_.backlog.queues.first.push_front(work);
    state_.refresh(event.replica);
    if (state_.book.elsewhere() == 1 && !event.within_process)  // who may do twice what is within the process
        for (Terms::Replica other = 0; other < state_.book.end(); ++other) state_.refresh_due(other);
}

void Reaction::operator()(const Terms::Resized& event) {
    state_.book.resize(event);
    state_.refresh(event.replica);
}

void Reaction::operator()(const Terms::Draining& event) {
    state_.book.drain(event);
    state_.refresh(event.replica);
}

void Reaction::operator()(const Terms::Gone& event) {
    auto& book = state_.book;
    std::map<Terms::Host, std::size_t> had;  // when it died: its replicas go together
    for (const auto replica : event.replicas) had[book[replica].host] = under_way(state_, book[replica].host);
    for (const auto replica : event.replicas)
        if (book[replica].present) go(replica, event.died, had[book[replica].host] == 1);
}

void Reaction::go(Terms::Replica replica, bool died, bool alone) {
    const auto& state = state_.book[replica];
    const InFlight::Account had = state_.in_flight.close_all(replica);
    for (const auto& [copy, work] : had.written_off)
        if (auto* const item = state_.backlog.find(work)) std::erase(item->written_off, copy);
    const Suspects::Loss loss{state.host, state.process, alone};
    if (died) state_.suspects.lost(loss.host, loss.process);
    if (state_.book.leave(replica)) state_.suspects.release(loss.host);
    state_.refresh(replica);
    for (auto copy = had.copies.rbegin(); copy != had.copies.rend(); ++copy) {
        auto* const item = state_.backlog.find(copy->work);
        if (!item) continue;
        ++state_.counts.asked_again;
        std::erase(item->copies, copy->id);
        if (died)
            blame(*item, loss);
        else
            state_.ask_again(*item);
    }
}

void Reaction::blame(Item& item, const Suspects::Loss& loss) {
    const auto work = item.work.work;
    if (!state_.suspects.blame(work, loss)) return state_.ask_again(item);
    act(Terms::SetAside{work, state_.suspects.died_alone(work)});
    state_.finish(work);
}

// ---- copies come back ----

// What the copy was of, which does not count it any more; null: that is done.
Item* Reaction::take_copy(Terms::CopyId copy, const InFlight::Closed& closed) {
    auto* const item = state_.backlog.find(closed.work);
    if (item) std::erase(closed.copy ? item->copies : item->written_off, copy);
    return item;
}

void Reaction::operator()(const Terms::Replied& event) {
    const auto closed = state_.in_flight.close(event.copy);
    if (!closed) return act(Terms::Drop{event.copy});
    auto& replica = state_.book[closed->replica];
    if (closed->copy) measure(closed->replica, *closed->copy, event);
    const bool is_first = !state_.order.times().any();
    const auto& account = state_.in_flight.of(closed->replica);
    replica.others = event.fill > account.questions ? event.fill - account.questions : 0;
    replica.replied(now_);
    replica.patience = state_.rules.patience;
    const Item* const item = take_copy(event.copy, *closed);
    state_.refresh(closed->replica);
    if (is_first && state_.order.times().any()) expect_again();
    if (!item) return act(Terms::Drop{event.copy});
    act(Terms::Accept{event.copy, closed->work});
    state_.finish(closed->work);
}

// The first answer tells about how long what was sent before it will take.
void Reaction::expect_again() {
    for (Terms::Replica replica = 0; replica < state_.book.end(); ++replica) {
        if (state_.in_flight.of(replica).copies.empty()) continue;
        state_.in_flight.expect(replica, [&](InFlight::Copy& copy) {
            copy.expected = now_ + state_.order.completion_time(replica, 0);
            copy.late = copy.sent + state_.late_after(copy.expected - copy.sent);
        });
        state_.refresh_due(replica);
    }
}

// A replica that was never idle has spent on this copy what has passed since its last reply: so many places at once.
void Reaction::measure(Terms::Replica replica, const InFlight::Copy& copy, const Terms::Replied& reply) {
    const auto& state = state_.book[replica];
    const double seconds = std::max(now_ - std::max(copy.sent, state.last_reply), 0.0);
    const auto at_work = std::min<std::size_t>(state.places, state_.in_flight.of(replica).copies.size() + 1);
    state_.order.times().measure(replica, static_cast<double>(at_work) * seconds,
                                 reply.answered ? reply.answered : copy.questions, reply.service);
}

void Reaction::operator()(const Terms::Failed& event) {
    const auto closed = state_.in_flight.close(event.copy);
    if (!closed) return act(Terms::Drop{event.copy});
    Item* const item = take_copy(event.copy, *closed);
    auto& replica = state_.book[closed->replica];
    replica.replied(now_);
    state_.refresh(closed->replica);
    if (!item) return act(Terms::Drop{event.copy});
    item->failed_at.insert(replica.host);
    ++item->failures;
    Rescue(state_).fail(*item);
}

void Reaction::operator()(const Terms::Refused& event) {
    const auto closed = state_.in_flight.close(event.copy);
    if (!closed) return;
    auto& replica = state_.book[closed->replica];
    if (!replica.refused) state_.refused.push_back(closed->replica);
    replica.refused = true;
    state_.refresh(closed->replica);
    if (Item* const item = take_copy(event.copy, *closed)) state_.ask_again(*item);
}

// Who is not asked tells nothing of having become quicker, or of what others don't ask there any more.
void Reaction::operator()(const Terms::Faded& event) {
    for (Terms::Replica replica = 0; replica < state_.book.end(); ++replica) {
        auto& state = state_.book[replica];
        const bool idle = state.present && !state.reserve && state_.in_flight.of(replica).copies.empty();
        if (!idle || now_ - state.last_reply < event.after) continue;
        state_.order.times().fade(replica);
        state.others = 0;
        state_.refresh(replica);
    }
}

// ---- time to decide ----

void Reaction::operator()(const Terms::Tick& event) {
    if (!event.again)
        for (const auto replica : std::exchange(state_.refused, {})) {
            state_.book[replica].refused = false;
            state_.refresh(replica);
        }
    Rescue rescue(state_);
    rescue.write_off_overdue(now_);
    rescue.test_suspects(now_);
    rescue.retry(now_);
    rescue.ask_idle(now_);
    hand_out();
    TailDoubling(state_).double_tail(now_);
}

void Reaction::hand_out() {
    auto& waiting = state_.backlog.queues.first;
    while (!waiting.empty()) {
        const auto work = waiting.front();
        auto* const item = state_.backlog.find_waiting(work);
        if (!item) {
            waiting.pop_front();
        } else if (state_.suspects.is_suspect(work)) {
            state_.suspects.wait(work);
            waiting.pop_front();
        } else {
            const auto replica = choose(state_, *item);
            if (!replica) return;
            waiting.pop_front();
            state_.send(*item, *replica, now_);
        }
    }
}

}  // namespace

// DECISIONS: one-state-machine
void Scheduler::on(const Event& event, Time now, std::vector<Action>& actions) {
    state_->actions = &actions;
    std::visit(Reaction(*state_, now), event);
}

bool Scheduler::has_waiting() const {
    const auto& queues = backlog().queues;
    return !queues.first.empty() || !queues.overdue.empty() || !queues.retries.empty() || !state_->suspects.empty() ||
           refused();
}

Scheduler::Time Scheduler::next_tick() const {
    return std::min(state_->stragglers.next_overdue(), TailDoubling(*state_).next_tick());
}

bool Scheduler::half_idle() const {
    return 2 * (order().idle() + replicas().reserve().has_value()) >= replicas().present();
}

std::size_t Scheduler::questions_ahead() const {
    std::size_t questions = in_flight().questions() + backlog().questions().waiting;
    for (Replica replica = 0; replica < replicas().end(); ++replica)
        questions += replicas()[replica].present ? replicas()[replica].others : 0;
    return questions;
}

bool Scheduler::is_at(WorkId work, Replica replica) const {
    const auto* const item = backlog().find(work);
    return item &&
           std::ranges::any_of(item->copies, [&](CopyId copy) { return in_flight().replica_of(copy) == replica; });
}

}  // namespace lightnet
