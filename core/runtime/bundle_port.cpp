#include "core/runtime/bundle_port.hpp"

#include <algorithm>
#include <cassert>
#include <memory>
#include <utility>

#include "core/error.hpp"

namespace lightnet {

Port::Ticket BundlePort::begin(std::span<const Query> questions, std::span<Rgb> answers) {
    assert(answers.size() == questions.size() * width_ && "room for every answer is reserved by the asker");
    const Ticket ticket = next_ticket_++;
    const auto now = Clock::now();
    asks_[ticket] = {questions, answers, 0, questions.size(), now, nullptr, {}};
    unbundled_.push_back(ticket);
    waiting_ += questions.size();
    flush(now, false);
    return ticket;
}

void BundlePort::finish(Ticket ticket) {
    auto& ask = asks_.at(ticket);  // stays in place: the map does not move its elements
    try {
        while (ask.unanswered > 0 && ask.error.empty()) {
            ask.waiting = fibers_.current();
            assert(ask.waiting && "only a fiber can wait for another place");
            fibers_.park();
        }
    } catch (...) {
        asks_.erase(ticket);
        throw;
    }
    const std::string error = std::move(ask.error);
    asks_.erase(ticket);
    if (!error.empty()) throw NodeError(error);
}

bool BundlePort::due(Clock::time_point now, bool idle) {
    while (!unbundled_.empty() && !asks_.contains(unbundled_.front())) unbundled_.pop_front();  // given up meanwhile
    if (unbundled_.empty()) {
        waiting_ = 0;
        return false;
    }
    if (waiting_ >= rules_.questions) return true;
    if (now - asks_.at(unbundled_.front()).begun >= rules_.oldest) return true;
    return idle && replicas_.bundles_outstanding() < rules_.eager * replicas_.size();
}

bool BundlePort::flush(Clock::time_point now, bool idle) {
    bool sent = (idle || replicas_.has_waiting()) && replicas_.tick();
    while (replicas_.has_credit() && (!again_.empty() || due(now, idle))) {
        if (again_.empty()) again_.push_back(make_bundle());
        if (!replicas_.send(again_.front())) break;
        again_.pop_front();
        sent = true;
    }
    return sent;
}

Bundle<Query> BundlePort::make_bundle() {
    auto questions = std::make_shared<std::vector<Query>>();
    questions->reserve(std::min(waiting_, rules_.questions));
    const std::uint64_t number = next_bundle_++;
    auto& pieces = pieces_[number];
    while (!unbundled_.empty() && questions->size() < rules_.questions) {
        const Ticket ticket = unbundled_.front();
        const auto found = asks_.find(ticket);
        if (found == asks_.end()) {
            unbundled_.pop_front();
            continue;
        }
        auto& ask = found->second;
        const std::size_t count = std::min(rules_.questions - questions->size(), ask.questions.size() - ask.bundled);
        const auto piece = ask.questions.subspan(ask.bundled, count);
        questions->insert(questions->end(), piece.begin(), piece.end());
        pieces.push_back({ticket, ask.bundled, count});
        ask.bundled += count;
        waiting_ -= std::min(waiting_, count);
        if (ask.bundled == ask.questions.size()) unbundled_.pop_front();
    }
    return {std::move(questions), this, number, static_cast<std::uint32_t>(width_)};
}

std::chrono::nanoseconds BundlePort::until_due(Clock::time_point now) const {
    const auto never = replicas_.until_due();
    if (!again_.empty()) return std::chrono::milliseconds(1);
    if (unbundled_.empty() || !replicas_.has_credit()) return never;
    const auto found = asks_.find(unbundled_.front());
    if (found == asks_.end()) return never;
    return std::max<std::chrono::nanoseconds>(found->second.begun + rules_.oldest - now, std::chrono::microseconds(50));
}

void BundlePort::settle(Ask& ask) {
    if (auto* fiber = std::exchange(ask.waiting, nullptr)) wake_(fiber);
}

void BundlePort::answered(const Bundle<Query>& bundle, std::vector<Rgb> answers) {
    const auto pieces = pieces_.extract(bundle.number);
    auto from = answers.begin();
    for (const auto& piece : pieces.mapped()) {
        const auto next = from + static_cast<std::ptrdiff_t>(piece.count * width_);
        if (const auto found = asks_.find(piece.ask); found != asks_.end()) {
            auto& ask = found->second;
            std::copy(from, next, ask.answers.begin() + static_cast<std::ptrdiff_t>(piece.first * width_));
            ask.unanswered -= piece.count;
            if (ask.unanswered == 0) settle(ask);
        }
        from = next;
    }
}

void BundlePort::failed(const Bundle<Query>& bundle, const std::string& why) {
    const auto pieces = pieces_.extract(bundle.number);
    for (const auto& piece : pieces.mapped())
        if (const auto found = asks_.find(piece.ask); found != asks_.end()) {
            found->second.error = why;
            settle(found->second);
        }
}

}  // namespace lightnet
