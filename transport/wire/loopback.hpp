// Addresses that only this machine can reach.
#pragma once

#include <string>
#include <string_view>

namespace lightnet {

/// Only processes of this machine can connect to `endpoint`: it is a loopback address, and no name that looks like one.
bool stays_on_this_machine(std::string_view endpoint);

/// Why an endpoint is refused, in words for who wrote it. `what`: "--listen tcp://0.0.0.0:7000", say; `with_keys`: what
/// would make it safe.
std::string beyond_this_machine(const std::string& what, const std::string& with_keys);

}  // namespace lightnet
