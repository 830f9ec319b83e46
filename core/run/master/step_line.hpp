// The steps that were sent to places and are not answered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "core/run/master/epoch.hpp"
#include "core/run/master/node_copy.hpp"
#include "core/run/message/carrier.hpp"

namespace lightnet {

/// A step of a copy's prepare(), or of a place: then its node is 0.
struct SentStep {
    NodeCopy to;
    std::size_t position;  // see PrepareOrder
    Step step;
};

/// Sends steps of all kinds but shards, one at a time to each copy, and knows what the answers are to. The launcher's
/// thread's.
class StepLine {
public:
    /// That of no master, nor of shards.
    static constexpr std::uint32_t channel = Epoch::own(Epoch::most_channels - 1);

    /// Whoever is asked has heard of `in_force` before; it outlives the line.
    StepLine(std::uint64_t run, const Plan& in_force, Carrier& carrier)
        : run_(run), in_force_(in_force), carrier_(carrier) {}

    /// False: it can't be sent now. `data` goes along.
    bool send(const SentStep& sent, const Bytes& data = nullptr);
    /// What a message on the channel answers, once. None: nobody waits for it any more.
    std::optional<SentStep> answered(const Message& message);
    /// What was sent there is not answered any more.
    void lose(const std::set<PlaceAt>& gone);
    /// Nobody waits for steps of prepare() at these positions.
    template <class IsMeant>
    void forget(const IsMeant& is_meant) {
        std::erase_if(sent_, [&](const auto& sent) {
            return sent.second.step.kind < Step::Kind::attend && is_meant(sent.second.position);
        });
    }
    /// A host could not do its part, and is taken out. Throws Error when a second one can't do it either, or when it is
    /// the only one of those that hold the node, and nobody else may come.
    void failed(const SentStep& sent, const std::string& why, const std::vector<NodeCopy>& holders);

private:
    using Part = std::tuple<std::size_t, Step::Kind, std::uint32_t>;  // position, kind, call

    std::uint64_t run_;
    const Plan& in_force_;
    Carrier& carrier_;
    std::map<std::uint64_t, SentStep> sent_;
    std::uint64_t next_ = 1;
    std::map<Part, std::set<std::string>> failed_at_;  // hosts
};

}  // namespace lightnet
