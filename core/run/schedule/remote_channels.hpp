// All channels of one asker to other places.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/run/schedule/multiplexer.hpp"
#include "core/run/schedule/remote_channel.hpp"

namespace lightnet {

/// Opens channels to the places that a plan names, closes those to lost ones, and gives replies to the one they name.
/// The master uses it for tiles, a place for questions.
template <class Question>
class RemoteChannels {
public:
    using Known = std::map<PlaceAt, std::uint32_t>;  // → channel
    /// The replicas of one node, as this asker knows them.
    struct Edge {
        std::uint32_t node = 0;
        Credit credit;
        Known known;
    };

    /// `asker`: name_of() the place; 0: the launcher. `counters` must outlive the channels.
    RemoteChannels(Carrier& carrier, std::uint64_t run, std::uint64_t asker, Counters& counters)
        : carrier_(carrier), run_(run), asker_(asker), counters_(counters) {}

    /// Makes the replicas behind `multiplexer` those of the plan. A place that is still there but does not hold the
    /// node any more is asked no more, and answers what it has.
    void connect(Edge& edge, Multiplexer<Question>& multiplexer, const Plan& plan) {
        Known known;
        std::vector<Channel<Question>*> replicas, draining;
        for (const auto place : plan.places_of[edge.node]) {
            const auto& at = plan.places[place];
            const auto before = edge.known.find(at);
            const auto number = before == edge.known.end() ? open(edge, at, plan.process_of(at.host)) : before->second;
            known.emplace(at, number);
            replicas.push_back(channels_[number].get());
        }
        for (const auto& at : plan.places) {
            const auto before = edge.known.find(at);
            if (before == edge.known.end() || !known.insert(*before).second) continue;
            draining.push_back(channels_[before->second].get());
            replicas.push_back(draining.back());
        }
        const auto before = std::exchange(edge.known, std::move(known));
        multiplexer.use(std::move(replicas), draining);
        for (const auto& [place, number] : before)
            if (!edge.known.contains(place)) channels_[number]->close();
    }

    /// A reply or a failure.
    void arrived(Message& message) {
        if (message.channel < channels_.size()) channels_[message.channel]->arrived(message);
    }

private:
    std::uint32_t open(const Edge& edge, const PlaceAt& at, std::uint64_t process) {
        const auto number = static_cast<std::uint32_t>(channels_.size());
        channels_.push_back(std::make_unique<RemoteChannel<Question>>(
            carrier_, typename RemoteChannel<Question>::Address{run_, number, edge.node, at, process, asker_},
            edge.credit, counters_));
        return number;
    }

    Carrier& carrier_;
    std::uint64_t run_;
    std::uint64_t asker_;
    Counters& counters_;
    std::vector<std::unique_ptr<RemoteChannel<Question>>> channels_;  // by number, lost ones too
};

}  // namespace lightnet
