#include "transport/wire/loopback.hpp"

#include "core/base/ip_address.hpp"

namespace lightnet {

bool stays_on_this_machine(std::string_view endpoint) {
    if (endpoint.starts_with("ipc://")) return true;
    const auto parts = tcp_endpoint(endpoint);
    if (!parts) return false;
    const auto address = ip_address(parts->host);
    return address ? address->is_loopback() : parts->host == own_machine;
}

std::string beyond_this_machine(const std::string& what, const std::string& with_keys) {
    return what + " goes beyond this machine: " + with_keys +
           ", or say --insecure if that network is yours alone, as packets are then neither encrypted nor signed";
}

}  // namespace lightnet
