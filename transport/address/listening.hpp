// Ports of this machine.
#pragma once

#include <cstdint>
#include <string>
#include <system_error>
#include <vector>

#include "transport/address/resolver.hpp"

namespace lightnet {

/// A port that listens, not yet anybody's. Closed with this object, unless it was given away.
class ListeningPort {
public:
    /// `port` 0: one that the system chooses. "::" takes in callers of both families. Throws std::system_error.
    ListeningPort(const IpAddress& address, std::uint16_t port);
    ~ListeningPort();
    ListeningPort(ListeningPort&& other) noexcept;
    ListeningPort& operator=(ListeningPort&&) = delete;
    int descriptor() const { return descriptor_; }
    std::uint16_t port() const;
    /// Whose it is from now on.
    int give_away();

private:
    int descriptor_ = -1;
};

/// The addresses at which a host that is to listen at `host` does: a number, "*" (all, of both families, as far as the
/// system has them), the name of a network card, or a name whose addresses this machine has. Throws Error that says
/// which it is not.
std::vector<IpAddress> listening_addresses(const std::string& host, Resolver& names);

}  // namespace lightnet
