#include "tools/session/run_account.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <utility>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/own_process.hpp"
#include "core/base/this_machine.hpp"
#include "core/network/graph/layout.hpp"
#include "tools/session/run_figures.hpp"
#include "tools/session/run_trace.hpp"
#include "tools/support/log_line.hpp"

namespace lightnet {
namespace {

using Clock = RunAccount::Clock;

Progress::Style style_of(ProgressMode mode, std::optional<Progress::Series> series) {
    auto style = Progress::style_of_stderr(mode);
    style.series = series;
    return style;
}

// As hosts files call it.
std::string shown_host(const std::string& host) { return host.empty() ? std::string(own_process) : host; }

}  // namespace

RunAccount::RunAccount(RunReport report, ProgressMode mode, std::optional<Progress::Series> series, std::uint64_t work)
    : report_(std::move(report)), progress_(work, style_of(mode, series), std::cerr, Clock::now()) {}

void RunAccount::phase(const std::string& name) {
    const auto now = Clock::now();
    phases_.begin(name, now);
    progress_.phase(name, now);
    if (watcher_) watcher_->phase(name);
}

void RunAccount::stand_aside() {
    phases_.end(Clock::now());
    progress_.stand_aside();
}

void RunAccount::say(const LogEntry& entry) {
    Progress::Marks marks{{"time", log_time(std::chrono::system_clock::now())},
                          {"level", log_level(entry.level)},
                          {"host", machine_name()}};
    const auto run = report_.settings.find("run");
    if (run != report_.settings.end()) marks.emplace_back("run", run->second);
    if (entry.level == LogLevel::error)
        progress_.insist(entry.text, marks);
    else
        progress_.say(entry.text, marks);
    if (watcher_) watcher_->say(entry.text);
}

void RunAccount::warn(const std::string& text) {
    report_.warnings.push_back(text);
    say({LogLevel::warning, "warning: " + text});
}

// DECISIONS: errors-are-heard
void RunAccount::alert(const std::string& text) {
    auto& said = report_.warnings;
    if (std::find(said.begin(), said.end(), text) != said.end()) return;  // a full disk is tried again and again
    said.push_back(text);
    say({LogLevel::error, "lightnet: " + text});
}

void RunAccount::preparing(const PrepareProgress& progress) {
    if (progress.node.empty() || phases_.is("render")) return;  // between two passes
    if (watcher_) watcher_->preparing(progress);
    const auto now = Clock::now();
    if (phases_.preparing(progress, now)) say("preparing " + progress.node);
    const auto what = progress.what.empty() ? "" : ": " + progress.what;
    progress_.step(fmt::format("{} {}/{}{}", progress.node, progress.position, progress.nodes, what), progress.done,
                   progress.total, now);
}

void RunAccount::use(const HostState& host) {
    const auto known = std::find_if(report_.hosts.begin(), report_.hosts.end(),
                                    [&](const auto& one) { return one.host == shown_host(host.name); });
    if (known != report_.hosts.end()) {
        known->peak_memory = std::max(known->peak_memory, host.peak_memory);
        return;
    }
    const auto& machine = host.machine;
    report_.hosts.push_back({shown_host(host.name), host.state, machine.name, machine.cpu, machine.isa, machine.version,
                             machine.cores, machine.memory, host.places, host.peak_memory});
}

void RunAccount::use(const Plan& plan, const Graph& graph) {
    report_.places.clear();
    report_.nodes = nodes_without_figures(graph);
    graph_nodes_.clear();
    for (const auto& node : graph.nodes) graph_nodes_.push_back(node.name);
    for (const auto& [node, count] : shards_in(graph))
        report_.settings["layout." + node] = fmt::format("sharded, {} sectors", count);
    for (std::uint32_t place = 0; place < plan.places.size(); ++place) {
        PlaceReport entry;
        entry.host = shown_host(plan.places[place].host), entry.index = plan.places[place].index;
        for (std::size_t node = 0; node < plan.places_of.size(); ++node)
            if (std::count(plan.places_of[node].begin(), plan.places_of[node].end(), place))
                entry.nodes.push_back(graph.nodes[node].name);
        report_.places.push_back(std::move(entry));
    }
}

void RunAccount::moved(const Move& move) {
    const std::chrono::duration<double> since = Clock::now() - phases_.run_begun();
    MoveReport entry{steady_nanoseconds(), since.count(), move.gain, {}};
    entry.nodes = move.who;
    say(fmt::format("{}; what is left is to take {:.0f} % less time", fmt::join(move.who, ", "), 100 * move.gain));
    report_.moves.push_back(std::move(entry));
}

// A trace that can't be written is no reason to lose the report.
void RunAccount::end(const std::string& outcome, const std::string& trace) {
    const auto now = Clock::now();
    phases_.end(now);
    progress_.finish(now);
    report_.outcome = outcome;
    report_.peak_memory = peak_memory();
    if (!trace.empty() && !counters_.traces.empty()) try {
            write_file(trace, to_trace_json(counters_.traces, graph_nodes_, report_.moves));
            report_.outputs.push_back(trace);
        } catch (const Error& error) {
            alert(std::string("no trace: ") + error.what());
        }
    report_.counters = counters_.named();
    add_figures(report_, counters_.places);
}

void alert_of_bad_light(RunAccount& account, const Graph& graph) {
    const auto& counted = account.counted();
    const auto& counts = counted.not_finite;
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
        const auto count = counts.find(graph.nodes[node].name);
        const auto inputs = graph.inputs_of(node);
        const bool passed_on = std::any_of(inputs.begin(), inputs.end(),
                                           [&](std::size_t input) { return counts.contains(graph.nodes[input].name); });
        if (count != counts.end() && !passed_on)
            account.alert(fmt::format("{} '{}' gave {} answers that are not finite", graph.nodes[node].kind,
                                      graph.nodes[node].name, count->second));
    }
    for (const auto& [node, count] : counted.off_surface)
        account.alert(
            fmt::format("'{}' asked {} times about points that no surface is near; they count as black", node, count));
    for (const auto& [node, count] : counted.lost_rays)
        account.alert(
            fmt::format("'{}' sent {} rays that are not finite, have no direction, or begin too far away; they meet "
                        "nothing",
                        node, count));
    for (const auto& [node, count] : counted.unsound_questions)
        account.alert(
            fmt::format("'{}' was asked {} questions whose numbers are not finite; they count as black", node, count));
}

}  // namespace lightnet
