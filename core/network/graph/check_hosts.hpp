// Holds a hosts file against the graph that it spreads.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/hosts.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// Adds to `problems`: endpoints that are none or stand there twice, nodes that the graph doesn't have or that no
/// host can hold, counts out of range, strategies and layouts that are none, nodes that can't be sharded.
void check_hosts(const Hosts& hosts, const Graph& graph, const Registry& registry, std::vector<Problem>& problems);

/// Host and port of "tcp://host:port"; empty where it isn't one.
struct Address {
    std::string host;  // without brackets
    int port = 0;
};
std::optional<Address> address_of(std::string_view endpoint);
/// "onyx1": a host that is not called, but joins under that name. None is called like this process.
bool is_joining_name(std::string_view name);

}  // namespace lightnet
