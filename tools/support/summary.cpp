#include "tools/support/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "core/base/joined.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_names = 8;  // in a line

// The first of them, and how many more there are.
std::string joined_names(std::vector<std::string> names) {
    const auto more = names.size() > most_names ? names.size() - most_names : 0;
    names.resize(names.size() - more);
    return joined(names) + (more ? fmt::format(" and {} more", more) : "");
}

std::string counted(std::size_t count, const std::string& thing) {
    return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string setting(const RunReport& report, const std::string& name) {
    const auto found = report.settings.find(name);
    return found == report.settings.end() ? "" : found->second;
}

std::string what(const Ending& ending) {
    const auto& report = ending.report;
    auto size = setting(report, "size");
    if (const auto crop = setting(report, "crop"); !crop.empty()) size += " (crop " + crop + ")";
    const auto mean = setting(report, "mean_samples"), most = setting(report, "samples");
    const auto samples =
        mean.empty() ? most + (most == "1" ? " sample" : " samples") : mean + " of " + most + " samples";
    return fmt::format("wrote {}\n      {}, {} per pixel{}, layers: {}", joined(report.outputs), size, samples,
                       mean.empty() ? "" : " on average", joined(ending.layers));
}

std::string how_long(const RunReport& report) {
    double all = 0;
    std::vector<std::string> parts;
    for (const auto& phase : report.phases) {
        all += phase.seconds;
        parts.push_back(fmt::format("{} {:.1f}", phase.name, phase.seconds));
    }
    return fmt::format("took {:.1f} s: {}", all, joined(parts));
}

std::string shown_name(const std::string& host) { return host == own_process ? "this process" : host; }

bool took_part(const HostReport& host) { return host.state == "is ready" || host.state == "leaves"; }
// A launcher says so of those that it has lost sight of, however far they had come.
bool was_lost(const HostReport& host) { return host.state.starts_with("is lost"); }

// Why one that serves another run is not there; none: it isn't so.
std::optional<std::string> why_it_is_busy(const std::string& state) {
    constexpr std::string_view busy = "is busy: ";
    return state.starts_with(busy) ? std::optional(state.substr(busy.size())) : std::nullopt;
}

std::string why_absent(const HostReport& host) {
    if (const auto why = why_it_is_busy(host.state)) return "never came, as it is busy: " + *why;
    if (was_lost(host) || host.state.starts_with("takes no part")) return host.state;
    return "never came: it " + host.state;
}

// What a host was to hold, as the hosts file says.
std::string wanted_of(const Hosts& asked, const std::string& name) {
    for (const auto& host : asked.hosts) {
        if (host.endpoint != name) continue;
        std::vector<std::string> nodes;
        for (const auto& [node, replicas] : host.replicas) nodes.push_back(node);
        return "; it was to hold " + (nodes.empty() ? "the whole network" : joined(nodes));
    }
    return {};
}

std::string who_came(const RunReport& report, std::size_t all) {
    std::vector<std::string> names;
    std::uint32_t places = 0;
    for (const auto& host : report.hosts) {
        if (!took_part(host)) continue;
        names.push_back(fmt::format("{} ({})", shown_name(host.host), counted(host.places, "place")));
        places += host.places;
    }
    const auto of =
        names.size() < all ? fmt::format("{} of {}", names.size(), counted(all, "host")) : counted(all, "host");
    return fmt::format("on    {} with {}: {}", of, counted(places, "place"), joined_names(names));
}

std::string on_hosts(const RunReport& report, const Hosts& asked) {
    std::set<std::string> seen;
    std::string absent;
    for (const auto& host : report.hosts) {
        seen.insert(host.host);
        if (took_part(host)) continue;
        absent += "\n      " + shown_name(host.host) + " " + why_absent(host) + wanted_of(asked, host.host);
    }
    for (const auto& host : asked.hosts)
        if (seen.insert(host.endpoint).second)
            absent += "\n      " + host.endpoint + " never came" + wanted_of(asked, host.endpoint);
    return who_came(report, seen.size()) + absent;
}

std::string on_whom(const Ending& ending) {
    const auto& report = ending.report;
    if (!report.hosts.empty()) return on_hosts(report, ending.asked);
    return "on    " + counted(report.places.size(), "thread") + " of this machine";
}

std::string percent(double share) { return fmt::format("{:.0f} %", std::floor(share * 100)); }

// One hint, where the PNG shows little of the picture.
std::string hint(const Ending& ending) {
    const auto& brightness = ending.brightness;
    if (hardly_lit(brightness))
        return "\nhint: " +
               (brightness.lit == 0 ? "nothing is lit" : percent(brightness.black) + " of the pixels are black") +
               ": the scene lacks light (lightnet render --env 1 gives it some), or the camera looks elsewhere";
    const auto stops = helpful_stops(brightness);
    if (!stops) return {};
    if (ending.shown != 0 && !ending.chosen)
        return fmt::format(
            "\nhint: the PNG is {:.1f} stops {} than the EXR; exposure = {:.1f} of the graph's scene does that to "
            "both, "
            "--view plain to none",
            std::fabs(ending.shown), ending.shown > 0 ? "brighter" : "darker", ending.exposure + ending.shown);
    const bool clipped = *stops < 0;
    return fmt::format("\nhint: {} of the pixels of the PNG are {}; --exposure {:.1f} would show them",
                       percent(clipped ? brightness.clipped : brightness.black), clipped ? "clipped" : "black",
                       ending.chosen.value_or(0) + *stops);
}

}  // namespace

std::string summary_of(const Ending& ending) {
    return what(ending) + "\n" + how_long(ending.report) + "\n" + on_whom(ending) + hint(ending);
}

std::vector<std::pair<std::string, std::string>> facts_of(const RunReport& report, double at_work) {
    std::vector<std::pair<std::string, std::string>> facts{{"outcome", report.outcome}, {"graph", report.graph}};
    double working = 0;
    for (const auto& phase : report.phases) {
        facts.emplace_back(phase.name, fmt::format("{:.1f} s", phase.seconds));
        if (phase.name == "prepare" || phase.name == "render") working += phase.seconds;
    }
    facts.emplace_back("places", std::to_string(report.places.size()));
    facts.emplace_back("at work, on average", fmt::format("{:.2f} of them", at_work));
    facts.emplace_back("the same work on one place",
                       fmt::format("about {:.1f} s, had it nothing to wait for", at_work * working));
    for (const auto& layer : report.layers)
        facts.emplace_back("light of " + layer.name, fmt::format("{:.1f} %", 100 * layer.share));
    constexpr double mebibyte = 1 << 20;
    const auto peak = [](std::uint64_t bytes) {
        return fmt::format("at most {:.0f} MiB of memory", static_cast<double>(bytes) / mebibyte);
    };
    if (report.peak_memory) facts.emplace_back("the launcher had", peak(report.peak_memory));
    for (const auto& host : report.hosts)
        facts.emplace_back(host.host,
                           host.state + ", " + host.machine + (host.peak_memory ? ", " + peak(host.peak_memory) : ""));
    for (const auto& [name, count] : report.counters)
        if (count) facts.emplace_back(name, std::to_string(count));
    for (const auto* texts : {&report.settings, &report.versions})
        for (const auto& [name, text] : *texts) facts.emplace_back(name, text);
    return facts;
}

}  // namespace lightnet
