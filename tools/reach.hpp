// Who can reach a port.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace lightnet {

/// Only processes of this machine can connect to `endpoint`.
inline bool stays_on_this_machine(std::string_view endpoint) {
    constexpr std::array own{"tcp://127.", "tcp://localhost:", "tcp://[::1]:"};
    return std::any_of(own.begin(), own.end(), [&](auto prefix) { return endpoint.starts_with(prefix); });
}

/// Why `option` is refused.
inline std::string beyond_this_machine(const std::string& option) {
    return option + " can be reached from other machines, and packets are neither encrypted nor signed; say --insecure "
                    "if that network is yours alone";
}

}  // namespace lightnet
