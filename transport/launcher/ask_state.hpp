// Asks daemons and launchers how they are.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "transport/keys/key.hpp"
#include "transport/lines/host_transport.hpp"
#include "transport/wire/machine.hpp"

namespace lightnet {

/// A host in words, as it (or the launcher that it serves) says.
struct HostAnswer {
    std::string asked;         // endpoint
    bool of_launcher = false;  // a launcher answers there, for a host of its run
    std::string name, state;
    std::string who;    // whose run it serves
    std::string nodes;  // that it holds
    Machine machine;
    std::uint64_t places = 0;
    std::uint64_t progress = 0;         // bundles and tiles answered in this run
    std::uint64_t bundles = 0;          // that came from other hosts in this run
    std::uint64_t broken_packets = 0;   // dropped
    std::uint64_t resident_memory = 0;  // of its process, now; bytes. 0: it doesn't say
    bool answers = true;                // else `state` says why not
    bool unknown = false;               // it's there, but it and we don't know each other's keys
    std::string advice{};               // what would be right
};

/// Somebody to ask, and by which keys; none: without.
struct AskedHost {
    std::string endpoint;
    std::optional<LineKeys> keys{};
};

/// What there is to say of a host that has not answered; `abandoned`: handshakes, in a row.
HostAnswer no_answer(const AskedHost& host, const HostLine& line, std::optional<Handshake> seen, int abandoned);

/// Asks all of them together, each once. One that does not answer within `patience` has a state that begins with "does
/// not answer", or says what is wrong with keys.
/// A launcher answers for all its hosts. Of a daemon that serves several runs, each at a port of its own, all are asked
/// when one is; they come last.
std::vector<HostAnswer> ask_state(const std::vector<AskedHost>& hosts, std::chrono::milliseconds patience);

}  // namespace lightnet
