// The name service: addresses of machines that have names.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/ip_address.hpp"

namespace lightnet {

/// What is known of a name. A value.
struct Whereabout {
    enum class State {
        asked,   // nothing so far
        found,   // all its addresses
        gone,    // nobody is called so
        unknown  // nobody could say
    };
    State state = State::asked;
    std::vector<IpAddress> addresses{};  // of both families, in turns; what was known last, when nobody can say now
    std::string why{};                   // it isn't found, in words that name it
    friend bool operator==(const Whereabout&, const Whereabout&) = default;
};

/// Any thread.
class NameService {
public:
    virtual ~NameService() = default;
    /// Takes as long as it takes: half a minute, where a name server is silent.
    virtual Whereabout look_up(const std::string& name) const = 0;
};

/// Whatever this system asks: files, name servers, others.
std::shared_ptr<const NameService> system_names();

/// The families in turns, beginning with that of the first: who has but one of them loses no time with the other.
std::vector<IpAddress> in_turns(const std::vector<IpAddress>& addresses);

/// The addresses of a network card of this machine, in turns; empty: there is no such card. `why`: cards can't be
/// looked at, as in a service that is allowed no AF_NETLINK.
std::vector<IpAddress> addresses_of_card(const std::string& card, std::string& why);

/// Why an address can't be reached from here, whoever has it: it names a network card that isn't there. "": nothing.
std::string missing_card(const IpAddress& address);

}  // namespace lightnet
