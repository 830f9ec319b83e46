#include "tools/watch/run_table.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr double rate_seconds = 3;  // over which rates are counted
constexpr std::size_t most_table_lines = 100;

std::string last_part(const std::string& path) { return path.substr(path.rfind('/') + 1); }

// Looks at places, or seconds of theirs: busy, asking, waiting, idle.
std::array<double, 4> shares_of(std::array<double, 4> parts) {
    double all = 0;
    for (const double part : parts) all += part;
    for (double& part : parts) part = all > 0 ? std::max(0.0, part) / all : 0;
    return parts;
}

std::array<double, 4> looks_at(const Json& host) {
    std::array<double, 4> sum{};
    for (const auto& place : host.at("looks").list())
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += place.list(4)[i].number();
    return sum;
}

double all_looks(const Json& state) {
    double sum = 0;
    for (const auto& host : state.at("hosts").list())
        for (const double part : looks_at(host)) sum += part;
    return sum;
}

// What a list has at an index more than an older one.
double grown(const Json& now, const Json& then, std::size_t index) {
    const auto at = [index](const Json& list) { return index < list.list().size() ? list.list()[index].number() : 0; };
    return std::max(0.0, at(now) - at(then));
}

// Questions, which stand first, along an edge.
double grown_edge(const Json& now, const Json& then, std::size_t edge) {
    if (edge >= now.list().size() || edge >= then.list().size()) return 0;
    return grown(now.list()[edge], then.list()[edge], 0);
}

RunTable::HostRow host_row(const Json& host) {
    return {host.at("name").text(),
            host.at("state").text(),
            host.at("there").flag(),
            host.at("places").whole<std::uint64_t>(),
            host.at("answered").whole<std::uint64_t>(),
            host.at("there").flag() ? shares_of(looks_at(host)) : std::array<double, 4>{}};
}

// In the order of watch_json.cpp: looks, waiting, bundles, questions, bytes, nanoseconds, answered.
RunTable::NodeRow node_row(const Json& now, const Json& then, double looks, double seconds) {
    RunTable::NodeRow row;
    const auto more = [&](std::size_t what) { return grown(now, then, what); };
    row.share = looks > 0 ? more(0) / looks : 0;
    row.waiting = now.list()[1].number();
    row.bundle = more(2) > 0 ? more(3) / more(2) : 0;
    row.bytes = seconds > 0 ? more(4) / seconds : 0;
    row.latency = more(6) > 0 ? more(5) / more(6) * 1e-9 : 0;
    return row;
}

}  // namespace

void LiveTable::hear(const std::string& text) {
    Json said = parse_json(text);
    const auto take = [&](const char* what) { return std::get<Json::Object>(said.data).at(what); };
    if (said.has("hello")) hello_ = take("hello"), lines_.clear();
    if (said.has("state")) {
        states_.push_back(take("state"));
        if (states_.back().at("t").number() < 0) throw Error("a run has no time before it began");
        while (states_.size() > 2 && states_[1].at("t").number() < states_.back().at("t").number() - rate_seconds)
            states_.pop_front();
    }
    if (said.has("log"))
        for (const auto& line : said.at("log").list()) lines_.push_back(line.text());
    if (lines_.size() > most_table_lines) lines_.erase(lines_.begin(), lines_.end() - most_table_lines);
    if (said.has("allowed")) allowed_ = said.at("allowed").flag();
    if (said.has("obeyed")) why_not_ = said.at("why_not").text();
    changed_ = true;
}

bool LiveTable::changed() { return std::exchange(changed_, false); }

std::string LiveTable::outcome() const { return states_.empty() ? "" : states_.back().at("outcome").text(); }

RunTable LiveTable::table() const {
    RunTable table;
    table.lines = lines_;
    for (auto& line : table.lines) std::replace(line.begin(), line.end(), '\t', ' ');
    if (!hello_.is_object()) return table;
    table.graph = last_part(hello_.at("graph").text());
    table.standing = "begins";
    if (states_.empty()) return table;
    const Json &now = states_.back(), &then = states_.front();
    table.standing = outcome().empty() ? now.at("phase").text() : outcome();
    table.done = now.at("done").number();
    table.seconds = now.at("t").number();
    const double seconds = table.seconds - then.at("t").number();
    if (outcome().empty() && now.has("left")) table.left = now.at("left").number();
    for (const auto& host : now.at("hosts").list()) table.hosts.push_back(host_row(host));

    const double looks = all_looks(now) - all_looks(then);
    const auto& nodes = hello_.at("nodes").list();
    const auto& edges = hello_.at("edges").list();
    const auto& figures = now.at("nodes").list();
    const auto& old = then.at("nodes").list();
    for (std::size_t k = 0; k < std::min(nodes.size(), figures.size()); ++k) {
        if (nodes[k].at("role").text() == "scene") continue;
        auto row = node_row(figures[k], k < old.size() ? old[k] : none_, looks, seconds);
        row.name = nodes[k].at("name").text(), row.kind = nodes[k].at("kind").text();
        for (std::size_t e = 0; e < edges.size(); ++e)
            if (edges[e].list(2)[1].whole<std::size_t>() == k && seconds > 0)
                row.questions += grown_edge(now.at("edges"), then.at("edges"), e) / seconds;
        table.nodes.push_back(std::move(row));
    }
    return table;
}

RunTable table_of_report(const std::string& text) {
    const Json report = parse_json(text);
    if (!report.has("format") || !report.at("format").text().starts_with("lightnet run "))
        throw Error("this is no report of a run (x.run.json)");
    RunTable table;
    table.rates = false;
    table.graph = last_part(report.at("graph").at("file").text());
    table.standing = report.at("outcome").text();
    if (table.standing == "done") table.done = 1;
    for (const auto& phase : report.at("phases").list()) table.seconds += phase.at("seconds").number();
    std::map<std::string, RunTable::HostRow> hosts;
    for (const auto& place : report.at("places").list()) {
        auto& host = hosts[place.at("host").text()];
        const double waiting = place.at("waiting").number(), idle = place.at("idle").number();
        const std::array<double, 4> parts{place.at("seconds").number() - waiting - idle, 0, waiting, idle};
        for (std::size_t i = 0; i < parts.size(); ++i) host.parts[i] += parts[i];
        ++host.places;
    }
    if (report.has("hosts"))
        for (const auto& said : report.at("hosts").list()) {
            auto& host = hosts[said.at("host").text()];
            host.state = said.at("state").text();
            host.there = !host.state.starts_with("is lost") && !host.state.starts_with("takes no part");
            host.places = said.at("places").whole<std::uint64_t>();
        }
    for (auto& [name, host] : hosts) {
        host.name = name, host.parts = shares_of(host.parts);
        table.hosts.push_back(std::move(host));
    }
    double all = 0;
    for (const auto& node : report.at("nodes").list()) all += node.at("own_seconds").number();
    for (const auto& node : report.at("nodes").list()) {
        RunTable::NodeRow row;
        row.name = node.at("name").text(), row.kind = node.at("kind").text();
        row.questions = node.at("questions").number();
        row.share = all > 0 ? node.at("own_seconds").number() / all : 0;
        row.latency = node.at("latency").number();
        table.nodes.push_back(std::move(row));
    }
    for (auto& row : table.nodes) {
        double bundles = 0, sent = 0;
        for (const auto& edge : report.at("edges").list()) {
            if (edge.at("to").text() != row.name || !edge.has("bytes")) continue;
            bundles += edge.at("bundles").number(), sent += edge.at("sent").number();
            row.bytes += edge.at("bytes").number();
        }
        row.bundle = bundles > 0 ? sent / bundles : 0;
    }
    for (const auto& warning : report.at("warnings").list()) table.lines.push_back("warning: " + warning.text());
    return table;
}

}  // namespace lightnet
