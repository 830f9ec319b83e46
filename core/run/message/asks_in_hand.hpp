// Asks that have arrived and are not answered.
#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "core/run/message/message.hpp"

namespace lightnet {

/// Keeps the way back of each ask. An asker who hears nothing for long sends a packet again, as it may be lost: what is
/// there already is answered once, by the way of the last that came. One thread's.
class AsksInHand {
public:
    /// Who asks, by which channel and number.
    using Name = std::tuple<std::uint64_t, std::uint32_t, std::uint64_t>;
    static Name name_of(const Message& ask) { return {ask.asker, ask.channel, ask.bundle}; }

    /// Takes the route of an ask. False: it is in hand already.
    bool take(Message& ask) { return routes_.insert_or_assign(name_of(ask), std::move(ask.route)).second; }
    /// It is answered, or nobody waits for it any more.
    Route let_go(const Name& name) {
        const auto route = routes_.extract(name);
        return route ? std::move(route.mapped()) : Route{};
    }

private:
    std::map<Name, Route> routes_;
};

}  // namespace lightnet
