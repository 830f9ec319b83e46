#include "tools/cli/lay_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ostream>
#include <utility>

#include "core/base/allowance.hpp"
#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "core/base/own_files.hpp"
#include "core/base/temporary_folder.hpp"
#include "core/base/this_machine.hpp"
#include "core/network/graph/check_hosts.hpp"
#include "core/network/graph/graph_film.hpp"
#include "tools/cli/asked_hosts.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/forecast/forecast_hosts.hpp"
#include "tools/forecast/recorded_run.hpp"
#include "transport/launcher/probe_hosts.hpp"

namespace lightnet {
namespace {

constexpr std::string_view by_rehearsal = "auto", by_report = "auto=";
constexpr std::string_view layout_beginning = "-- Laid out by lightnet";
constexpr double free_part = 0.8;              // of a host's memory, for what nodes prepare
constexpr std::uint32_t rehearsed_side = 128;  // pixels
constexpr std::uint32_t rehearsed_samples = 4;

// As large as the picture, but for its scale.
PictureSize small_size(const Graph& graph, const Registry& registry) {
    const auto film = film_of(graph, registry);
    const double scale = std::min(1.0, double(rehearsed_side) / std::max(film.width, film.height));
    const auto side = [&](std::uint32_t pixels) { return std::max(16u, std::uint32_t(pixels * scale)); };
    return {side(film.width), side(film.height)};
}

// `tile`: pixels along its side; 0: as before.
OtherPicture wanted_picture(const Graph& graph, const Registry& registry, std::uint32_t tile) {
    const auto film = film_of(graph, registry);
    return {film.width, film.height, sampling_of(graph, registry).samples, tile, 1};
}

// What it prepares is kept in the cache, where the run itself finds it.
RunCosts rehearsed(const RunningOptions& running, const Launcher& launcher, const Loaded& loaded) {
    launcher.err << "rehearsing for the layout: few samples of a small picture\n";
    const TemporaryFolder folder("rehearsal");
    RunningOptions small;
    small.seed = running.seed;
    small.tuning = running.tuning;
    small.tuning.tile = 16;
    small.progress = ProgressMode::none;
    small.threads = std::max(2u, usable_cores());
    small.forget = true;
    small.memo = false;
    small.picture.output = folder.path() + "/rehearsal.exr";
    small.picture.size = small_size(loaded.graph, launcher.registry);
    small.picture.samples = rehearsed_samples;
    Written written{loaded.graph, {}, {}};
    Loaded some = validate_job(std::move(written), small.picture, launcher.registry);
    if (const int code = launcher.run(request_of(small, launcher, std::move(some))); code != 0)
        throw Error("the rehearsal for the layout", "has ended with code " + std::to_string(code));
    const auto run = read_recorded_run(folder.path() + "/rehearsal.run.json", launcher.registry);
    return scaled(run.costs, wanted_picture(loaded.graph, launcher.registry, running.tuning.tile));
}

// What a host is like, as it says itself, and as far as the way to it can be measured.
ForecastHost facts_of(const HostEntry& entry, const HostProbe& probe) {
    const auto& answer = probe.answer;
    if (!answer.answers || answer.unknown)
        throw UserError(entry.where, "--layout auto: " + in_quotes(entry.endpoint) + " " + answer.state +
                                         "; a layout takes what each host is like");
    ForecastHost host{.name = entry.host()};
    const auto cores = std::max<std::uint64_t>(1, answer.places ? answer.places : answer.machine.cores);
    host.places = entry.places > 0 ? static_cast<std::uint32_t>(entry.places) : static_cast<std::uint32_t>(cores);
    host.memory = free_part * double(answer.machine.memory);
    if (probe.bandwidth > 0) host.line.bytes_per_second = probe.bandwidth;
    host.line.seconds = std::chrono::duration<double>(probe.round_trip).count() / 2;
    return host;
}

ForecastHost own_facts(const HostEntry& entry) {
    ForecastHost host{.name = entry.host(), .places = static_cast<std::uint32_t>(std::max(1, entry.places))};
    host.memory = free_part * double(usable_memory());
    return host;
}

std::vector<ForecastHost> facts_of_all(const RunningOptions& running, const Hosts& hosts) {
    AskedHostsOptions asking;
    asking.key = running.key;
    std::vector<ForecastHost> facts;
    for (const auto& entry : hosts.hosts) {
        if (!entry.replicas.empty())
            throw UserError(entry.where, "--layout auto: place " + in_quotes(entry.endpoint) +
                                             " names nodes already; leave them out, or --layout");
        if (entry.is_here()) {
            facts.push_back(own_facts(entry));
            continue;
        }
        if (!address_of(entry.endpoint))
            throw UserError(entry.where, "--layout auto: " + in_quotes(entry.endpoint) +
                                             " joins by itself, so it can't be asked what it is like");
        AskedHostsOptions one = asking;
        one.whom = {entry.endpoint}, one.host_key = entry.key;
        const auto probes = probe_hosts(asked_hosts(one).called, std::chrono::seconds(5));
        facts.push_back(facts_of(entry, probes.front()));
    }
    for (const auto& text : running.layout_memory) limit_memory(facts, text);
    return facts;
}

std::string lua_name(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "\"";
}

std::string entry_text(const HostEntry& entry) {
    std::string members;
    for (const auto& [node, count] : entry.replicas) members += fmt::format("{} = {}, ", node, count);
    if (entry.places > 0) members += fmt::format("places = {}, ", entry.places);
    if (!entry.key.empty()) members += "key = " + lua_name(entry.key) + ", ";
    if (!members.empty()) members.resize(members.size() - 2);
    return "place " + lua_name(entry.endpoint) + " { " + members + " }\n";
}

}  // namespace

std::optional<std::string> mistaken_layout(const RunningOptions& running) {
    const auto& layout = running.layout;
    if (layout.empty() && running.layout_out.empty() && running.layout_memory.empty()) return std::nullopt;
    if (layout.empty()) return "--layout-out and --layout-memory are about --layout auto";
    if (layout != by_rehearsal && !(layout.starts_with(by_report) && layout.size() > by_report.size()))
        return "--layout must be auto or auto=X.run.json, not '" + layout + "'";
    if (running.hosts.empty()) return "--layout takes the hosts to lay the graph out on: --hosts";
    return std::nullopt;
}

RecordedRun recorded_run_of(const Graph& graph, const Registry& registry, const std::string& report) {
    auto run = read_recorded_run(report, registry);
    const auto names = [](const Graph& one) {
        std::vector<std::string> all;
        for (const auto& node : one.nodes) all.push_back(node.name);
        return all;
    };
    if (names(run.graph) != names(graph))
        throw UserError({report, 0}, "is of another graph: its nodes are not those of " + graph.file);
    return run;
}

RunCosts costs_for(const Graph& graph, const Registry& registry, const std::string& report) {
    return scaled(recorded_run_of(graph, registry, report).costs, wanted_picture(graph, registry, 0));
}

std::string hosts_file_text(const Hosts& hosts, const std::vector<std::string>& why) {
    std::string text = std::string(layout_beginning) + ".\n";
    for (const auto& reason : why) text += "-- " + reason + "\n";
    for (const auto& [node, name, where] : hosts.strategies)
        text += node.empty() ? "strategy = " + lua_name(name) + "\n"
                             : fmt::format("strategy {{ {} = {} }}\n", node, lua_name(name));
    for (const auto& entry : hosts.hosts) text += entry_text(entry);
    return text;
}

Loaded laid_out(const RunningOptions& running, const Launcher& launcher, Loaded loaded) {
    if (!running.layout_out.empty())
        if (const auto why = why_not_replaced(running.layout_out, layout_beginning); !why.empty())
            throw UserError({running.layout_out, 0}, why);
    const auto facts = facts_of_all(running, loaded.hosts);
    const RunCosts costs = running.layout == by_rehearsal
                               ? rehearsed(running, launcher, loaded)
                               : costs_for(loaded.graph, launcher.registry, running.layout.substr(by_report.size()));
    const auto layout = place_nodes(costs, facts, {});
    const auto said = hosts_of(layout.holds, costs, facts, loaded.hosts);
    const LaidOut by{costs, facts, {}, layout.holds};
    const bool may_move = Mover(by).may_move() && loaded.hosts.layouts.empty();
    loaded.hosts = may_move ? with_empty_hosts(said, costs, std::move(loaded.hosts)) : said;
    loaded.laid_out = std::make_shared<const LaidOut>(by);
    for (const auto& reason : layout.why)
        if (running.progress != ProgressMode::none) launcher.err << "layout: " << reason << '\n';
    if (!running.layout_out.empty()) write_file(running.layout_out, hosts_file_text(said, layout.why));
    return loaded;
}

}  // namespace lightnet
