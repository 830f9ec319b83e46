// An address of this machine for this process alone.
#pragma once

#include <unistd.h>

#include <string>

namespace lightnet::test {

/// "tcp://127.x.y.z:*", where no other test listens. A port there stays free for who comes back to it; one of 127.0.0.1
/// may not, as all whom a machine calls take ports there.
inline std::string own_loopback() {
    const int process = ::getpid();
    return "tcp://127." + std::to_string(64 + process / 65536 % 64) + "." + std::to_string(process / 256 % 256) + "." +
           std::to_string(process % 256) + ":*";
}

}  // namespace lightnet::test
