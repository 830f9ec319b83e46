#include "tools/host_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lightnet {
namespace {

std::string shown_name(const HostAnswer& host) { return host.name.empty() ? "(the launcher)" : host.name; }

std::string facts(const HostAnswer& host) {
    const auto& machine = host.machine;
    if (machine.name.empty()) return {};
    constexpr double gib = 1 << 30;
    return fmt::format("{} places, {}: {} cores, {:.1f} GiB, {}, {}, {}", host.places, machine.name, machine.cores,
                       static_cast<double>(machine.memory) / gib, machine.cpu, machine.isa, machine.version);
}

}  // namespace

std::string host_table(const std::vector<HostAnswer>& hosts) {
    std::size_t widest = 0, longest = 0;
    for (const auto& host : hosts) {
        widest = std::max(widest, shown_name(host).size());
        longest = std::max(longest, host.state.size());
    }
    std::string text;
    for (const auto& host : hosts) {
        auto line = fmt::format("{:<{}}  {:<{}}  {}", shown_name(host), widest, host.state, longest, facts(host));
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
        if (!host.who.empty()) text += fmt::format("{:<{}}    run of {}\n", "", widest, host.who);
        if (!host.nodes.empty()) text += fmt::format("{:<{}}    holds {}\n", "", widest, host.nodes);
        if (host.progress || host.bundles || host.broken_packets)
            text += fmt::format("{:<{}}    {} answered, {} bundles from other hosts, {} broken packets\n", "", widest,
                                host.progress, host.bundles, host.broken_packets);
    }
    return text;
}

}  // namespace lightnet
