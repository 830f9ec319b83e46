// Addresses of the other hosts of a run, as its launcher says.
#pragma once

#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/ip_address.hpp"

namespace lightnet {

/// By the names that hosts have in plans. A value.
class PeerAddresses {
public:
    /// Takes in where the launcher has found hosts ("onyx1 10.0.0.11" a line), whose names may mean nothing here, and
    /// at which ports, where these are others than it called ("tcp://onyx1:7000 7001"). Numbers that mean another
    /// machine elsewhere are left out. True: ports are others than before.
    bool hear(const std::string& lines) {
        addresses_.clear();
        const auto before = std::exchange(ports_, {});
        std::istringstream in(lines);
        for (std::string name, number; in >> name >> number;)
            if (tcp_endpoint(name))
                ports_[name] = number;
            else if (const auto at = ip_address(number);
                     at && !at->is_loopback() && !at->is_unspecified() && !at->is_link_local())
                addresses_[name].push_back(*at);
        return ports_ != before;
    }
    /// Empty: nobody has said.
    std::vector<IpAddress> of(const std::string& host) const {
        const auto parts = tcp_endpoint(host);
        const auto found = addresses_.find(parts ? parts->host : host);
        return found == addresses_.end() ? std::vector<IpAddress>() : found->second;
    }
    /// To be called: a daemon that serves several runs has a port for each.
    std::string endpoint_of(const std::string& host) const {
        auto parts = tcp_endpoint(host);
        const auto port = ports_.find(host);
        if (!parts || port == ports_.end()) return host;
        parts->port = port->second;
        return parts->text();
    }

private:
    std::map<std::string, std::vector<IpAddress>> addresses_;  // by name
    std::map<std::string, std::string> ports_;                 // by host: where it serves this run
};

}  // namespace lightnet
