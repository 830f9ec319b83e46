#include "core/run/place/bundle_port.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/base/error.hpp"
#include "core/run/place/full_bundle.hpp"

namespace lightnet {
namespace {

// Tickets and numbers of bundles: the slot + 1 below, how often it had been used before above.
constexpr std::uint64_t number_of(std::uint32_t slot, std::uint32_t uses) {
    return (std::uint64_t{uses} << 32) | (slot + 1);
}
constexpr std::uint32_t slot_of(std::uint64_t number) { return static_cast<std::uint32_t>(number) - 1; }
constexpr std::uint32_t uses_of(std::uint64_t number) { return static_cast<std::uint32_t>(number >> 32); }

}  // namespace

Port::Ticket BundlePort::begin(std::span<const Query> questions, std::span<Rgb> answers) {
    assert(answers.size() == questions.size() * width_ && "room for every answer is reserved by the asker");
    if (closed_.empty()) {
        closed_.push_back(static_cast<std::uint32_t>(asks_.size()));
        asks_.emplace_back();
    }
    const std::uint32_t slot = closed_.back();
    closed_.pop_back();
    auto& ask = asks_[slot];
    ask.open = true;
    ask.questions = questions, ask.answers = answers;
    ask.bundled = 0, ask.unanswered = questions.size();
    ask.edge = gauge_ ? gauge_->along : nullptr;
    const Ticket ticket = number_of(slot, ask.uses);
    const bool first = waiting_ == 0;
    unbundled_.push_back(ticket);
    waiting_ += questions.size();
    if (waiting_ >= rules_.questions) flush(Clock::now(), false);
    if (first && waiting_ > 0) company_.begin(Clock::now());
    return ticket;
}

BundlePort::Ask* BundlePort::find(Ticket ticket) {
    auto& ask = asks_[slot_of(ticket)];
    return ask.open && ask.uses == uses_of(ticket) ? &ask : nullptr;
}

void BundlePort::close(Ticket ticket) {
    auto& ask = asks_[slot_of(ticket)];
    ask.open = false;
    ask.waiting = nullptr;
    ask.failure.reset();
    ++ask.uses;
    closed_.push_back(slot_of(ticket));
}

void BundlePort::abandon(Ticket ticket) noexcept {
    if (auto* ask = find(ticket)) {
        waiting_ -= ask->questions.size() - ask->bundled;
        close(ticket);
    }
}

void BundlePort::finish(Ticket ticket) {
    auto& ask = *find(ticket);
    try {
        while (ask.unanswered > 0 && !ask.failure) {
            ask.waiting = fibers_.current();
            assert(ask.waiting && "only a fiber can wait for another place");
            fibers_.park();
        }
    } catch (...) {
        abandon(ticket);
        throw;
    }
    if (!ask.failure) return close(ticket);
    const Failure failure = std::move(*ask.failure);
    abandon(ticket);
    throw NodeError(failure.why, failure.host);
}

// By the work alone: what waits at replicas that are busy, or for others whom they ask, is no reason to send less at
// once.
// DECISIONS: little-for-strangers
std::size_t BundlePort::full() const {
    constexpr std::size_t for_strangers = 64;
    const double each = replicas_.scheduler().order().times().said();
    const std::size_t most = each > 0 || kept_back_ ? rules_.questions : std::min(rules_.questions, for_strangers);
    return full_bundle(most, each);
}

bool BundlePort::due(Clock::time_point now, bool idle) {
    if (waiting_ == 0 || kept_back_) return false;
    if (waiting_ >= full()) return true;
    if (company_.is_over(now)) return true;
    return idle && replicas_.bundles_outstanding() < rules_.eager * replicas_.places();
}

// A place that has something to do will ask more, and one that only waits for many answers, too. Where it waits for a
// few, work has run out: what is slow to come may be asked of idle replicas as well.
void BundlePort::foresee(bool idle) {
    const std::size_t more = waiting_ + (idle && replicas_.half_idle() ? 0 : 1);
    if (more != std::exchange(foreseen_, more)) replicas_.foresee(more);
}

bool BundlePort::flush(Clock::time_point now, bool idle) {
    foresee(idle);
    bool sent = (idle || replicas_.has_waiting()) && replicas_.tick();
    while ((!again_.empty() || due(now, idle)) && replicas_.has_credit()) {
        if (again_.empty()) again_.push_back(make_bundle(now, full(), true));
        if (!send_first()) break;
        sent = true;
    }
    return sent;
}

bool BundlePort::send_first() {
    const std::size_t asked = again_.front().questions->size();
    if (!replicas_.send(again_.front())) return false;
    if (count_) {
        count_->bundles.add(1);
        count_->questions.add(asked);
        count_->bytes.add(asked * sizeof(Query));
    }
    again_.pop_front();
    return true;
}

void BundlePort::share(std::size_t most) {
    again_.push_back(make_bundle(Clock::now(), most, true));
    send_first();
}

Bundle<Query> BundlePort::take_back(std::size_t most) { return make_bundle(Clock::now(), most, false); }

// A buffer comes back when nobody else holds it: the answerer lets go of it before it replies.
BundlePort::Buffer BundlePort::empty_buffer() {
    if (buffers_.empty()) {
        buffers_.push_back(std::make_shared<std::vector<Query>>());
        buffers_.back()->reserve(std::min(waiting_, rules_.questions));
    }
    auto buffer = std::move(buffers_.back());
    buffers_.pop_back();
    buffer->clear();
    return buffer;
}

std::uint64_t BundlePort::open_slices() {
    if (unused_.empty()) {
        unused_.push_back(static_cast<std::uint32_t>(slices_.size()));
        slices_.emplace_back();
    }
    const std::uint32_t slot = unused_.back();
    unused_.pop_back();
    slices_[slot].open = true;
    return number_of(slot, slices_[slot].uses);
}

// Null: the bundle has been answered already.
BundlePort::Slices* BundlePort::slices_of(const Bundle<Query>& bundle) {
    auto& slices = slices_[slot_of(bundle.number)];
    return slices.open && slices.uses == uses_of(bundle.number) ? &slices : nullptr;
}

Bundle<Query> BundlePort::make_bundle(Clock::time_point now, std::size_t most, bool away) {
    auto questions = empty_buffer();
    const std::uint64_t number = open_slices();
    slices_[slot_of(number)].sent = now;
    auto& slices = slices_[slot_of(number)].all;
    bundled_.clear();
    while (first_ < unbundled_.size() && questions->size() < most) {
        const Ticket ticket = unbundled_[first_];
        auto* const ask = find(ticket);
        if (!ask) {  // given up meanwhile
            ++first_;
            continue;
        }
        const std::size_t count = std::min(most - questions->size(), ask->questions.size() - ask->bundled);
        const auto slice = ask->questions.subspan(ask->bundled, count);
        if (away && ask->edge) count_at(*ask->edge, count);
        questions->insert(questions->end(), slice.begin(), slice.end());
        slices.push_back({ticket, ask->bundled, count});
        ask->bundled += count;
        waiting_ -= count;
        if (ask->bundled == ask->questions.size()) ++first_;
    }
    unbundled_.erase(unbundled_.begin(), unbundled_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
    if (waiting_ > 0) company_.begin(now);  // what is left came later than what goes
    return {std::move(questions), this, number, static_cast<std::uint32_t>(width_)};
}

// Questions of an edge that leave in the bundle that is being made.
void BundlePort::count_at(Gauge::Edge& edge, std::size_t questions) {
    edge.sent.add(questions);
    edge.bytes.add(questions * (sizeof(Query) + width_ * sizeof(Rgb)));
    if (std::find(bundled_.begin(), bundled_.end(), &edge) != bundled_.end()) return;
    bundled_.push_back(&edge);
    edge.bundles.add(1);
}

std::chrono::nanoseconds BundlePort::until_due(Clock::time_point now) const {
    const auto never = replicas_.until_due();
    if (!again_.empty()) return std::chrono::milliseconds(1);
    if (waiting_ == 0 || !replicas_.has_credit()) return never;
    return std::max<std::chrono::nanoseconds>(company_.left(now), std::chrono::microseconds(50));
}

void BundlePort::settle(Ask& ask) {
    if (auto* fiber = std::exchange(ask.waiting, nullptr)) wake_(fiber);
}

void BundlePort::close(Slices& slices, const Bundle<Query>& bundle) {
    slices.all.clear();
    slices.open = false;
    ++slices.uses;
    unused_.push_back(slot_of(bundle.number));
    if (bundle.questions.use_count() == 1)
        buffers_.push_back(std::const_pointer_cast<std::vector<Query>>(bundle.questions));
}

void BundlePort::answered(const Bundle<Query>& bundle, std::vector<Rgb> answers) {
    auto* const slices = slices_of(bundle);
    if (!slices) return;
    const auto took = std::chrono::nanoseconds(Clock::now() - slices->sent);
    if (count_) {
        count_->answered.add(1);
        count_->nanoseconds.add(static_cast<std::uint64_t>(took.count()));
        count_->bytes.add(answers.size() * sizeof(Rgb));
    }
    company_.answered(took);
    hand_out(*slices, bundle, answers);
}

void BundlePort::answered_here(const Bundle<Query>& bundle, std::span<const Rgb> answers) {
    if (auto* const slices = slices_of(bundle)) hand_out(*slices, bundle, answers);
}

void BundlePort::hand_out(Slices& slices, const Bundle<Query>& bundle, std::span<const Rgb> answers) {
    auto from = answers.begin();
    for (const auto& slice : slices.all) {
        const auto next = from + static_cast<std::ptrdiff_t>(slice.count * width_);
        if (auto* const ask = find(slice.ask)) {
            std::copy(from, next, ask->answers.begin() + static_cast<std::ptrdiff_t>(slice.first * width_));
            ask->unanswered -= slice.count;
            if (ask->unanswered == 0) settle(*ask);
        }
        from = next;
    }
    close(slices, bundle);
}

void BundlePort::failed(const Bundle<Query>& bundle, const Failure& failure) {
    auto* const slices = slices_of(bundle);
    if (!slices) return;
    for (const auto& slice : slices->all)
        if (auto* const ask = find(slice.ask)) {
            ask->failure = failure;
            settle(*ask);
        }
    close(*slices, bundle);
}

}  // namespace lightnet
