// A hosts file: where nodes run, and how often. A plain value.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {

/// What a hosts file calls the launcher's own process, where an endpoint would stand. In plans it is "".
inline constexpr std::string_view own_process = "here";

/// `place "tcp://onyx1:7777" { direct = 1, caustics = 2, key = "…" }`. Each entry has places of its own, also where
/// several stand for this process.
struct HostEntry {
    std::string endpoint;                 // "tcp://host:port", the name of a host that joins, or own_process
    std::map<std::string, int> replicas;  // node name → how many places of this host hold it; empty: the whole network
    int places = 0;                       // 0: one per core that the host offers
    SourceLine where;
    std::string key{};  // its public key, as text; "": none is known

    bool is_here() const { return endpoint == own_process; }
    /// As plans call it.
    std::string host() const { return is_here() ? std::string() : endpoint; }
    friend bool operator==(const HostEntry&, const HostEntry&) = default;
};

/// `strategy = "affinity"`, or one entry of `strategy { bounce = "affinity" }`; the same for layouts.
struct ChoiceEntry {
    std::string node;  // "": all that have none of their own
    std::string name;  // of a Strategy or a Layout, as it stands there
    SourceLine where;
    friend bool operator==(const ChoiceEntry&, const ChoiceEntry&) = default;
};

/// All hosts of a run, in the order of the file.
struct Hosts {
    std::string file;
    std::vector<HostEntry> hosts;
    std::vector<ChoiceEntry> strategies{};  // in the order of the file; later ones win
    std::vector<ChoiceEntry> layouts{};     // likewise
    friend bool operator==(const Hosts&, const Hosts&) = default;
};

/// Canonical text of hosts, and back; limits and errors as for graphs.
std::string to_json(const Hosts& hosts);
Hosts hosts_from_json(std::string_view text);

}  // namespace lightnet
