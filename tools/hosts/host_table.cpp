#include "tools/hosts/host_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "tools/hosts/doctor.hpp"

namespace lightnet {
namespace {

// Where it is: an endpoint, or the name under which it joined a launcher.
std::string place_of(const HostAnswer& host) {
    if (!host.of_launcher) return host.asked;
    return host.name.empty() ? host.asked + " (the launcher)" : host.name;
}

std::string state_of(const HostAnswer& host, const std::string& build) {
    return (host.who.empty() ? host.state : "is busy: " + host.state) +
           (is_other_build(host, build) ? ", ANOTHER BUILD" : "");
}

std::string places_of(const HostAnswer& host) {
    if (!host.places) return {};
    return fmt::format("{} place{}", host.places, host.places == 1 ? "" : "s");
}

std::string machine_of(const HostAnswer& host) {
    const auto& machine = host.machine;
    if (machine.name.empty()) return {};
    constexpr double gib = 1 << 30;
    return fmt::format("{}: {} cores, {:.1f} GiB, {}, {}, {}", machine.name, machine.cores,
                       static_cast<double>(machine.memory) / gib, machine.cpu, machine.isa, machine.version);
}

using Row = std::array<std::string, 4>;

Row row_of(const HostAnswer& host, const std::string& build) {
    return {place_of(host), state_of(host, build), places_of(host), machine_of(host)};
}

std::string line_of(const Row& row, const std::array<std::size_t, 4>& widths) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += row[i] + std::string(widths[i] + 2 - row[i].size(), ' ');
    return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
}

// What a host that serves a run is at, and why it could serve none.
std::string more_of(const HostAnswer& host, const std::string& build, const std::string& margin) {
    std::string text;
    if (is_other_build(host, build))
        text += margin + "would be refused: " + difference_of_builds(host.machine.version, build) + "\n";
    if (!host.who.empty()) text += margin + "run of " + host.who + "\n";
    if (!host.nodes.empty()) text += margin + "holds " + host.nodes + "\n";
    if (host.progress || host.bundles || host.broken_packets)
        text += margin + fmt::format("{} answered, {} bundles from other hosts, {} broken packets\n", host.progress,
                                     host.bundles, host.broken_packets);
    return text;
}

// What a host says itself is better than what a launcher says of it.
void leave_out_what_is_told_twice(std::vector<HostAnswer>& hosts) {
    std::set<std::string> told;
    for (const auto& host : hosts)
        if (!host.of_launcher) told.insert(host.asked);
    std::erase_if(hosts, [&](const auto& host) { return host.of_launcher && !told.insert(place_of(host)).second; });
}

}  // namespace

bool is_there(const HostAnswer& host) {
    return host.answers && !host.state.starts_with("does not answer") && !host.state.starts_with("is lost");
}

bool is_other_build(const HostAnswer& host, const std::string& build) {
    return !host.machine.version.empty() && host.machine.version != build;
}

std::string host_table(std::vector<HostAnswer> hosts, const std::string& build) {
    leave_out_what_is_told_twice(hosts);
    std::array<std::size_t, 4> widths{};
    for (const auto& host : hosts) {
        const Row row = row_of(host, build);
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const auto& host : hosts)
        text += line_of(row_of(host, build), widths) + more_of(host, build, std::string(widths[0] + 4, ' '));
    return text;
}

}  // namespace lightnet
