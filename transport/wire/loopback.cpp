#include "transport/wire/loopback.hpp"

#include <arpa/inet.h>

#include <cstdint>

namespace lightnet {

bool stays_on_this_machine(std::string_view endpoint) {
    constexpr std::string_view scheme = "tcp://";
    if (endpoint.starts_with("ipc://")) return true;
    if (!endpoint.starts_with(scheme)) return false;
    endpoint.remove_prefix(scheme.size());
    const std::string host(endpoint.substr(0, endpoint.rfind(':')));
    in_addr address{};
    constexpr std::uint32_t loopback = 127;
    if (inet_pton(AF_INET, host.c_str(), &address) == 1) return ntohl(address.s_addr) >> 24 == loopback;
    return host == "localhost" || host == "[::1]";
}

std::string beyond_this_machine(const std::string& what, const std::string& with_keys) {
    return what + " goes beyond this machine: " + with_keys +
           ", or say --insecure if that network is yours alone, as packets are then neither encrypted nor signed";
}

}  // namespace lightnet
