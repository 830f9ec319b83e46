// All channels of one asker to other places and hosts.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/run/schedule/multiplexer.hpp"
#include "core/run/schedule/remote_channel.hpp"

namespace lightnet {

/// Opens channels to the places that a plan names, closes those to lost ones, and gives replies to the one they name.
/// Places of the asker's own host have a channel each; those of another host share one, as only that host knows which
/// of them is free. The master uses it for tiles, a place for questions, a dispatcher for both.
// DECISIONS: a-host-is-one-replica
template <class Question>
class RemoteChannels {
public:
    using Known = std::map<PlaceAt, std::uint32_t>;  // place, or any of a host → channel
    /// The replicas of one node, as this asker knows them.
    struct Edge {
        std::uint32_t node = 0;
        Credit credit;
        Known known;
        std::optional<PlaceAt> reserve{};  // the asker, where it holds the node itself
    };

    /// Who asks.
    struct Asker {
        std::string host;
        std::uint64_t name = 0;   // name_of() the place; 0: the launcher
        std::uint32_t first = 0;  // number of the first channel: where others share the carrier
        /// Of bundles, on their way: who takes the place of one that was lost has others, as somebody may still be at
        /// what that had asked.
        std::uint64_t first_bundle = 0;
    };
    /// `counters` must outlive the channels.
    RemoteChannels(Carrier& carrier, std::uint64_t run, Asker asker, Counters& counters)
        : carrier_(carrier), run_(run), asker_(std::move(asker)), counters_(counters) {}

    /// Makes the replicas behind `multiplexer` those of the plan. A place that is still there but does not hold the
    /// node any more is asked no more, and answers what it has.
    void connect(Edge& edge, Multiplexer<Question>& multiplexer, const Plan& plan) {
        Known known;
        std::vector<Channel<Question>*> replicas, draining;
        for (const auto& [at, places] : answerers(plan, edge.node)) {
            const auto before = edge.known.find(at);
            const auto number = before == edge.known.end() ? open(edge, at, plan.process_of(at.host)) : before->second;
            known.emplace(at, number);
            channel(number).use(places);
            channel(number).go_by(plan.edition);
            replicas.push_back(&channel(number));
        }
        for (const auto& place : plan.places) {
            const auto before = edge.known.find(asked_as(place));
            if (before == edge.known.end() || !known.insert(*before).second) continue;
            draining.push_back(&channel(before->second));
            replicas.push_back(draining.back());
        }
        const auto before = std::exchange(edge.known, std::move(known));
        multiplexer.use(std::move(replicas), draining);
        for (const auto& [place, number] : before)
            if (!edge.known.contains(place)) channel(number).close();
    }

    /// A reply or a failure.
    void arrived(Message& message) {
        if (message.channel - asker_.first < channels_.size()) channel(message.channel).arrived(message);
    }

private:
    PlaceAt asked_as(const PlaceAt& place) const {
        return place.host == asker_.host ? place : PlaceAt{place.host, any_place};
    }

    // Whom to ask for a node, in the order of the plan, and the indices of the places behind each.
    std::vector<std::pair<PlaceAt, std::vector<std::uint32_t>>> answerers(const Plan& plan, std::uint32_t node) const {
        std::vector<std::pair<PlaceAt, std::vector<std::uint32_t>>> all;
        std::map<PlaceAt, std::size_t> position;
        for (const auto place : plan.places_of[node]) {
            const auto& at = plan.places[place];
            const auto [found, fresh] = position.emplace(asked_as(at), all.size());
            if (fresh) all.push_back({found->first, {}});
            all[found->second].second.push_back(at.index);
        }
        return all;
    }

    RemoteChannel<Question>& channel(std::uint32_t number) { return *channels_[number - asker_.first]; }

    std::uint32_t open(const Edge& edge, const PlaceAt& at, std::uint64_t process) {
        const auto number = asker_.first + static_cast<std::uint32_t>(channels_.size());
        channels_.push_back(std::make_unique<RemoteChannel<Question>>(
            carrier_,
            typename RemoteChannel<Question>::Address{run_, number, edge.node, at, process, asker_.name,
                                                      at == edge.reserve, at.host == asker_.host, asker_.first_bundle},
            edge.credit, counters_));
        return number;
    }

    Carrier& carrier_;
    std::uint64_t run_;
    Asker asker_;
    Counters& counters_;
    std::vector<std::unique_ptr<RemoteChannel<Question>>> channels_;  // by number, lost ones too
};

}  // namespace lightnet
