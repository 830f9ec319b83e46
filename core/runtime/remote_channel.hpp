// The channel to one node at one other place.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/runtime/carrier.hpp"
#include "core/runtime/channel.hpp"

namespace lightnet {

/// How much may be under way to one place at a time.
struct Credit {
    std::size_t bundles = 8;
    std::size_t questions = 8192;
    friend bool operator==(const Credit&, const Credit&) = default;
};

/// Sends bundles through a carrier, keeps each until its reply is there, and gives all back when the place is lost.
template <class Question>
class RemoteChannel final : public Channel<Question> {
public:
    struct Ends {
        std::uint64_t run = 0;
        std::uint32_t channel = 0;  // number among the channels of this place
        std::uint32_t node = 0;     // who is asked
        PlaceAt place;              // where
    };
    RemoteChannel(Carrier& carrier, Ends ends, Credit credit, Counters& counters)
        : carrier_(carrier), ends_(std::move(ends)), credit_(credit), counters_(counters) {}

    const PlaceAt& place() const { return ends_.place; }

    bool has_credit() const override {
        return !closed_ && sent_.size() < credit_.bundles && (outstanding_ < credit_.questions || sent_.empty());
    }

    bool send(const Bundle<Question>& bundle) override {
        Message message;
        message.type = Message::Type::ask;
        message.run = ends_.run;
        message.channel = ends_.channel;
        message.bundle = next_;
        message.node = ends_.node;
        message.width = bundle.width;
        message.questions = bundle.questions;
        if (!carrier_.ask(ends_.place, message)) return false;
        sent_.emplace(next_++, bundle);
        outstanding_ += bundle.questions->size();
        counters_.bundles += 1;
        counters_.questions += bundle.questions->size();
        return true;
    }

    double completion_time(std::size_t more) const override {
        constexpr double unknown_service = 1e-6;
        const double service = load_.service_ns ? load_.service_ns * 1e-9 : unknown_service;
        // What the answerer reported as waiting may be ours; what others have there is the rest.
        const std::size_t others = load_.fill > outstanding_ ? load_.fill - outstanding_ : 0;
        return static_cast<double>(outstanding_ + others + more) * service;
    }
    std::size_t outstanding() const override { return outstanding_; }
    std::size_t bundles_outstanding() const override { return sent_.size(); }

    /// A reply or a failure that names this channel. A late one, of a bundle that is answered already, is dropped.
    void arrived(Message& message) {
        const auto found = sent_.find(message.bundle);
        if (found == sent_.end()) {
            ++counters_.late_replies;
            return;
        }
        const Bundle<Question> bundle = std::move(found->second);
        sent_.erase(found);
        outstanding_ -= bundle.questions->size();
        if (message.type == Message::Type::failure) {
            bundle.owner->failed(bundle, message.text);
        } else if (message.answers.size() != answers_to(*bundle.questions, bundle.width)) {
            bundle.owner->failed(bundle, "the answer of " + ends_.place.host + " has a wrong size");
        } else {
            load_ = message.load;
            bundle.owner->answered(bundle, std::move(message.answers));
        }
    }

    bool closed() const { return closed_; }
    /// The place is gone: nothing more is sent, and what was not answered goes back to its owners, in order.
    void close() {
        closed_ = true;
        carrier_.give_up(ends_.channel);
        carrier_.forget(ends_.place);
        std::vector<std::pair<std::uint64_t, Bundle<Question>>> lost(sent_.begin(), sent_.end());
        sent_.clear();
        outstanding_ = 0;
        std::sort(lost.begin(), lost.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        counters_.asked_again += lost.size();
        for (auto& [number, bundle] : lost) bundle.owner->returned(std::move(bundle));
    }

private:
    Carrier& carrier_;
    Ends ends_;
    Credit credit_;
    Counters& counters_;
    Load load_;
    std::unordered_map<std::uint64_t, Bundle<Question>> sent_;
    std::size_t outstanding_ = 0;
    std::uint64_t next_ = 1;
    bool closed_ = false;
};

/// Closes the channels to places that are not in the plan any more. A place that is there but holds the node no longer
/// gets no new bundles, and answers those that it has: so a host that was told to stop loses no work.
template <class Question>
void close_absent(const std::vector<std::unique_ptr<RemoteChannel<Question>>>& channels, const Plan& plan) {
    for (const auto& channel : channels)
        if (!channel->closed() &&
            std::find(plan.places.begin(), plan.places.end(), channel->place()) == plan.places.end())
            channel->close();
}

}  // namespace lightnet
