#include "core/run/forecast/mover.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/film/film.hpp"
#include "core/run/forecast/forecast.hpp"
#include "core/run/forecast/move_search.hpp"
#include "core/run/forecast/place_work.hpp"

namespace lightnet {
namespace {

constexpr double least_gain = 0.2;  // of the time that is left
constexpr double sure_gains = 0.8;  // gains of looks in a row, two at least: measuring errs, but not as often as that
constexpr double worth_of_gain = 0.5;  // of what it gains, that a move may cost
constexpr double first_wait = 2;       // seconds: after the first move twice as long, and so on
constexpr double calms_after = 4;      // times the last wait, in which nothing has moved
constexpr int most_doublings = 8;
constexpr double memory_comes_back = 10;  // seconds after which a host has let go of what left it
constexpr double long_ago = -std::numeric_limits<double>::infinity();

double wait_after(int moves) { return first_wait * std::exp2(std::min(moves, most_doublings)); }

// Where all are busy all the time: no layout is quicker.
double seconds_of_ideal(const RunCosts& costs, const std::vector<ForecastHost>& hosts) {
    const auto work = work_by_node(costs);
    double power = 0;
    for (const auto& host : hosts) power += host.power();
    return std::accumulate(work.begin(), work.end(), 0.0) / power;
}

// Of what is of all hosts: that of those who are there.
template <class OfHost>
std::vector<OfHost> of_those_there(const std::vector<OfHost>& all, const RunWindow& window) {
    std::vector<OfHost> there;
    for (std::size_t host = 0; host < all.size(); ++host)
        if (window.hosts[host].there) there.push_back(all[host]);
    return there;
}

// A picture by which layouts compare as by the whole, and which is played quickly: of fewer samples, and smaller.
RunCosts sample_of(RunCosts costs, const std::vector<ForecastHost>& hosts) {
    constexpr double blocks_of_place = 60;
    double blocks = 0;
    for (const auto& host : hosts) blocks += blocks_of_place * host.places;
    auto& samples = costs.picture.samples;
    const double too_many = usual_blocks(costs.picture) / std::max(blocks, 1.0);
    if (too_many > 1) samples = std::min(samples, std::max(samples_per_block, std::uint32_t(samples / too_many)));
    return shortened(costs, blocks);
}

std::string with(const std::string& names, const std::string& name) {
    return names + (names.empty() ? "" : ", ") + (name.empty() ? "here" : name);
}

}  // namespace

Mover::Mover(LaidOut by)
    : by_(std::move(by)),
      measured_(by_.costs, by_.hosts),
      left_(by_.hosts.size(), std::vector<Time>(by_.costs.nodes.size(), long_ago)) {
    const auto all = needed_nodes(by_.costs);
    for (const auto& host : by_.hosts) fits_ = fits_ && has_room(by_.costs, host, all);
}

bool Mover::may_move() const {
    const auto all = needed_nodes(by_.costs);
    return !fits_ || std::ranges::any_of(by_.holds, [&](const auto& held) { return held != all; });
}

std::optional<Move> Mover::look(Time now, const RunWindow& window) {
    measured_.take(window);
    if (!may_move() || window.hosts.size() != by_.hosts.size()) return std::nullopt;
    if (moves_ > 0 && now >= calm_) calm_ = now + calms_after * wait_after(--moves_);
    auto move = better(now, window);
    const bool at_once = move && move->gain == 1;
    const bool wanted_before = wanted_ > 0;
    wanted_ = move ? wanted_ + move->gain : 0;
    const bool sure = at_once || (wanted_before && wanted_ >= sure_gains && now >= next_);
    if (!move || !sure) return std::nullopt;
    take_up(move->holds, now);
    return move;
}

std::optional<Move> Mover::better(Time now, const RunWindow& window) const {
    const auto costs = measured_.costs();
    const auto hosts = of_those_there(measured_.hosts(), window);
    const auto before = of_those_there(by_.holds, window);
    HeldByHosts all_kept(by_.hosts.size(), std::vector<bool>(costs.nodes.size()));
    for (std::size_t host = 0; host < all_kept.size(); ++host)
        for (std::size_t node = 0; node < costs.nodes.size(); ++node) all_kept[host][node] = keeps(host, node, now);
    const auto kept = of_those_there(all_kept, window);
    if (hosts.empty() || window.left <= 0) return std::nullopt;
    if (fits_ && !are_played(costs, hosts)) return std::nullopt;
    MoveSearch search(costs, hosts, by_.launcher, kept);
    const double seconds = search.seconds(before);
    HeldByHosts found;
    double gain = 0;  // 1: what a node answers is to be had nowhere now
    if (fits_) {
        found.assign(hosts.size(), needed_nodes(costs));
        gain = gain_when_played(costs, hosts, before, found);
    } else if (1 - seconds_of_ideal(costs, hosts) / seconds >= least_gain) {
        found = search.better_than(before);
        if (found != before) gain = 1 - search.seconds(found) / seconds;
    }
    if (!(gain >= least_gain)) return std::nullopt;

    Move move;
    move.holds = by_.holds;
    for (std::size_t host = 0, there = 0; host < by_.hosts.size(); ++host)
        if (window.hosts[host].there) move.holds[host] = found[there++];
    move.cost = cost_of(now, move.holds);
    move.who = words_for(move.holds);
    move.gain = gain;
    move.seconds = move.gain * std::min(window.left * seconds, window.seconds_left);
    if (!(move.cost <= worth_of_gain * move.seconds)) return std::nullopt;
    return move;
}

// The estimate and the forecast don't agree on what everything everywhere brings where lines are slow.
// DECISIONS: everything-everywhere-is-played
double Mover::gain_when_played(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const HeldByHosts& before,
                               const HeldByHosts& after) const {
    const auto lost = [&](std::size_t node) {
        return std::ranges::none_of(before, [&](const auto& held) { return held[node]; });
    };
    if (std::ranges::any_of(costs.order, lost)) return 1;
    const auto sample = sample_of(costs, hosts);
    const auto seconds = [&](const HeldByHosts& holds) {
        return forecast(sample, plan_of(holds, hosts), hosts, by_.launcher, 1).render;
    };
    return 1 - seconds(after) / seconds(before);
}

bool Mover::keeps(std::size_t host, std::size_t node, Time now) const {
    return by_.holds[host][node] || now - left_[host][node] < memory_comes_back;
}

// Seconds: results on their way, and what each host prepares by itself.
double Mover::cost_of(Time now, const HeldByHosts& holds) const {
    double seconds = 0;
    for (std::size_t host = 0; host < holds.size(); ++host)
        for (std::size_t node = 0; node < holds[host].size(); ++node) {
            if (!holds[host][node] || keeps(host, node, now)) continue;
            const auto& preparing = by_.costs.nodes[node].preparing;
            const double rate = std::min(by_.launcher.bytes_per_second, by_.hosts[host].line.bytes_per_second);
            seconds += preparing.own_seconds / by_.hosts[host].power() + preparing.bytes / rate;
        }
    return seconds;
}

void Mover::take_up(const HeldByHosts& holds, Time now) {
    for (std::size_t host = 0; host < holds.size(); ++host)
        for (std::size_t node = 0; node < holds[host].size(); ++node)
            if (by_.holds[host][node] && !holds[host][node]) left_[host][node] = now;
    by_.holds = holds;
    next_ = now + wait_after(++moves_);
    calm_ = now + calms_after * wait_after(moves_);
    wanted_ = 0;
}

std::vector<std::string> Mover::words_for(const HeldByHosts& holds) const {
    std::vector<std::string> words;
    for (const auto node : by_.costs.order) {
        std::string from, to;
        for (std::size_t host = 0; host < holds.size(); ++host) {
            if (holds[host][node] == by_.holds[host][node]) continue;
            auto& names = holds[host][node] ? to : from;
            names = with(names, by_.hosts[host].name);
        }
        const auto& name = by_.costs.nodes[node].name;
        if (!from.empty() && !to.empty()) words.push_back(name + " goes from " + from + " to " + to);
        if (from.empty() && !to.empty()) words.push_back(name + " comes to " + to);
        if (!from.empty() && to.empty()) words.push_back(name + " leaves " + from);
    }
    return words;
}

}  // namespace lightnet
