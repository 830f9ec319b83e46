#include "tools/forecast/forecast_hosts.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/base/between_commas.hpp"
#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "core/base/suggestion.hpp"
#include "lua/load_graph.hpp"

namespace lightnet {
namespace {

struct Amount {
    double number = 0;
    std::string unit;
};

std::optional<Amount> amount_in(const std::string& text) {
    Amount amount;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), amount.number);
    if (fault != std::errc{} || !(amount.number > 0)) return std::nullopt;
    amount.unit.assign(end, text.data() + text.size());
    return amount;
}

std::optional<double> times_of_unit(const std::string& unit, const std::vector<std::pair<const char*, double>>& units) {
    for (const auto& [name, factor] : units)
        if (unit == name) return factor;
    return std::nullopt;
}

// "NAME=WHAT"; without a name: "".
std::pair<std::string, std::string> named(const std::string& text) {
    const auto equals = text.rfind('=');
    if (equals == std::string::npos) return {"", text};
    return {text.substr(0, equals), text.substr(equals + 1)};
}

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& like) {
    throw UserError({"", 0}, option + " " + in_quotes(text) + ": it is said like " + like);
}

std::optional<std::uint32_t> count_in(const std::string& text) {
    const auto amount = amount_in(text);
    if (!amount || !amount->unit.empty() || amount->number != double(std::uint32_t(amount->number))) return {};
    return std::uint32_t(amount->number);
}

// Does `set` for all hosts, or for the one that is named.
template <class Set>
void for_named(std::vector<ForecastHost>& hosts, const std::string& option, const std::string& name, const Set& set) {
    bool found = false;
    std::vector<std::string> names;
    for (auto& host : hosts) {
        names.push_back(host.name);
        if (!name.empty() && host.name != name) continue;
        set(host);
        found = true;
    }
    if (!found) throw UserError({"", 0}, option + ": there is no host " + in_quotes(name) + did_you_mean(name, names));
}

void set_facts(std::vector<ForecastHost>& hosts, const ForecastHostsOptions& options) {
    for (const auto& text : options.lines) {
        const auto [name, what] = named(text);
        const auto line = line_called(what, {});
        if (!line) refuse("--link", text, "10Gbit,0.1ms or NAME=100Mbit,5ms");
        for_named(hosts, "--link", name, [&](ForecastHost& host) { host.line = *line; });
    }
    for (const auto& text : options.memory) limit_memory(hosts, text);
    for (const auto& text : options.speeds) {
        const auto [name, what] = named(text);
        const auto speed = amount_in(what);
        if (!speed || !speed->unit.empty()) refuse("--speed", text, "NAME=2");
        for_named(hosts, "--speed", name, [&](ForecastHost& host) { host.speed = speed->number; });
    }
    for (const auto& text : options.processors) {
        const auto [name, what] = named(text);
        const auto count = amount_in(what);
        if (!count || !count->unit.empty()) refuse("--processors", text, "NAME=1.5");
        for_named(hosts, "--processors", name, [&](ForecastHost& host) { host.processors = count->number; });
    }
}

void add_entry(ForecastCrew& crew, HostEntry entry) {
    int places = entry.places;
    for (const auto& [node, count] : entry.replicas) places = std::max(places, count);
    if (places <= 0)
        throw UserError(entry.where, "place " + in_quotes(entry.endpoint) +
                                         ": say how many places it has (places = 8), as it is not asked");
    entry.places = places;
    const auto name = entry.host();
    const auto known =
        std::find_if(crew.hosts.begin(), crew.hosts.end(), [&](const auto& host) { return host.name == name; });
    if (known == crew.hosts.end())
        crew.hosts.push_back({name, static_cast<std::uint32_t>(places)});
    else
        known->places += static_cast<std::uint32_t>(places);
    crew.entries.hosts.push_back(std::move(entry));
}

LineCost usual_line(const ForecastHostsOptions& options) {
    const auto line = line_called(options.line, {});
    if (!line) refuse("--link", options.line, "10Gbit,0.1ms");
    return *line;
}

void finish(ForecastCrew& crew, const ForecastHostsOptions& options) {
    for (auto& host : crew.hosts) host.line = usual_line(options);
    set_facts(crew.hosts, options);
}

}  // namespace

void limit_memory(std::vector<ForecastHost>& hosts, const std::string& text) {
    const auto [name, what] = named(text);
    const auto bytes = bytes_called(what);
    if (!bytes) refuse("--memory", text, "16G or NAME=16G");
    for_named(hosts, "--memory", name, [&](ForecastHost& host) { host.memory = *bytes; });
}

std::optional<double> bytes_called(const std::string& text) {
    const auto amount = amount_in(text);
    const auto times =
        amount ? times_of_unit(amount->unit, {{"", 1}, {"K", 0x1p10}, {"M", 0x1p20}, {"G", 0x1p30}, {"T", 0x1p40}})
               : std::nullopt;
    return times ? std::optional(*times * amount->number) : std::nullopt;
}

std::optional<LineCost> line_called(const std::string& text, LineCost usual) {
    for (const auto& part : between_commas(text)) {
        const auto amount = amount_in(part);
        if (!amount) return std::nullopt;
        const auto rate = times_of_unit(amount->unit, {{"kbit", 125}, {"Mbit", 125e3}, {"Gbit", 125e6}});
        const auto time = times_of_unit(amount->unit, {{"us", 1e-6}, {"ms", 1e-3}, {"s", 1}});
        if (rate)
            usual.bytes_per_second = *rate * amount->number;
        else if (time)
            usual.seconds = *time * amount->number;
        else
            return std::nullopt;
    }
    return usual;
}

ForecastCrew crew_called(const ForecastHostsOptions& options) {
    ForecastCrew crew;
    for (const auto& text : options.hosts) {
        const auto [name, what] = named(text);
        const auto places = name.empty() ? std::nullopt : count_in(what);
        if (!name.empty() && !places) refuse("--hosts", text, "a hosts file, or NAME=PLACES");
        if (places) {
            add_entry(crew, {.endpoint = name, .replicas = {}, .places = int(*places), .where = {}});
            continue;
        }
        const Hosts file = load_hosts(text);
        for (const auto& entry : file.hosts) add_entry(crew, entry);
        crew.entries.strategies = file.strategies;
    }
    finish(crew, options);
    return crew;
}

ForecastCrew crew_of_places(std::uint32_t places, std::uint32_t per_host, const ForecastHostsOptions& options) {
    ForecastCrew crew;
    for (std::uint32_t host = 0; places > 0; ++host) {
        const auto some = std::min(places, per_host);
        places -= some;
        const auto name = "host" + std::to_string(host + 1);
        crew.entries.hosts.push_back({.endpoint = name, .replicas = {}, .places = int(some), .where = {}});
        crew.hosts.push_back({name, some});
    }
    finish(crew, options);
    return crew;
}

}  // namespace lightnet
