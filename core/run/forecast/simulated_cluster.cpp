#include "core/run/forecast/simulated_cluster.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/film/tile.hpp"
#include "core/run/message/place_name.hpp"

namespace lightnet {
namespace {

constexpr double much_too_long = 100;  // seconds in which nothing happens at all
constexpr double least_wait = 0.01;    // seconds: whoever waits for nothing to arrive doesn't look more often
constexpr double bytes_of_ask = 200;   // of tiles, and of any message beside what it carries
constexpr std::size_t entries_of_spread = 4096;

// What pieces cost beside a usual one, as often as they do.
std::vector<double> table_of(const std::vector<CostShare>& spread) {
    double weight = 0, sum = 0;
    for (const auto& share : spread) weight += share.weight, sum += share.weight * share.times;
    std::vector<double> table;
    for (const auto& share : spread)
        table.insert(table.end(), std::size_t(std::ceil(entries_of_spread * share.weight / weight)),
                     share.times * weight / sum);
    if (table.empty()) table.push_back(1);
    return table;
}

std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
}

}  // namespace

SimulatedCluster::SimulatedCluster(SimulatedSetting setting)
    : setting_(std::move(setting)),
      kinds_(place_kinds(setting_.costs, setting_.plan)),
      times_(table_of(setting_.costs.spread)),
      launcher_out_(setting_.launcher.bytes_per_second),
      launcher_in_(setting_.launcher.bytes_per_second) {
    make_hosts();
    make_places();
    for (std::size_t place = 0; place < places_.size(); ++place) {
        const auto& kind = places_[place]->kind();
        std::set<std::size_t> asked;
        for (const auto& work : kind.light)
            for (const auto& [node, questions] : work.asked) asked.insert(node);
        for (const auto node : asked) connect(place, node);
    }
}

void SimulatedCluster::make_hosts() {
    for (const auto& facts : setting_.hosts) {
        auto& host = hosts_[facts.name];
        host.facts = &facts;
        host.processors = std::make_unique<SharedProcessors>(events_, facts.processors, facts.speed);
        const bool own = facts.name.empty();
        host.in = host.out = SimulatedLine(own ? 0 : facts.line.bytes_per_second);
    }
}

void SimulatedCluster::make_places() {
    const auto& plan = setting_.plan;
    for (std::size_t place = 0; place < plan.places.size(); ++place) {
        auto& host = hosts_[plan.places[place].host];
        if (!host.facts) throw Error("nothing is known of host '" + plan.places[place].host + "'");
        host.places.emplace(plan.places[place].index, place);
        places_.push_back(std::make_unique<SimulatedPlace>(events_, *host.processors, setting_.costs,
                                                           kinds_.kinds[kinds_.of_place[place]]));
    }
}

double SimulatedCluster::bytes_of(std::size_t node) const {
    double bytes = 60;  // of a question and a colour
    for (const auto& edge : setting_.costs.edges)
        if (edge.to == node && edge.bytes > 0) bytes = edge.bytes;
    return bytes;
}

// Its own host's places one by one, and others by their hosts; of a node that it holds itself, those that lack another.
void SimulatedCluster::connect(std::size_t place, std::size_t node) {
    const auto& plan = setting_.plan;
    const bool holds = places_[place]->kind().holds[node];
    struct Target {
        Host* host;
        std::optional<std::uint32_t> index;
    };
    std::vector<Target> targets;
    std::map<std::string, std::uint32_t> others;  // places by host
    for (const auto other : plan.places_of[node]) {
        if (holds && holds_all_of(places_[other]->kind().holds, places_[place]->kind().holds)) continue;
        const auto& at = plan.places[other];
        if (at.host == plan.places[place].host)
            targets.push_back({&hosts_[at.host], at.index});
        else
            ++others[at.host];
    }
    const auto near = targets.size();
    for (const auto& [name, count] : others) targets.push_back({&hosts_[name], std::nullopt});
    Host& mine = hosts_[plan.places[place].host];
    const double bytes = bytes_of(node);
    auto& port = places_[place]->connect(
        node, targets.size(), plan.strategy_of(node), [this, targets, &mine, bytes](auto replica, SimulatedAsk ask) {
            const auto target = targets[replica];
            const double all = bytes_of_ask + bytes * ask.questions;
            ask.answered = [this, target, &mine, all, answered = std::move(ask.answered)](const SimulatedLoad& load) {
                carry(*target.host, mine, all / 4, [answered, load] { answered(load); });
            };
            carry(mine, *target.host, 3 * all / 4,
                  [this, target, ask = std::move(ask)] { take_at(*target.host, target.index, ask); });
        });
    std::uint32_t host = 1;
    for (std::size_t i = 0; i < near; ++i) port.replicas().join(0, 1, true);
    for (const auto& [name, count] : others) port.replicas().join(host++, count, false);
}

// Between places of a process, a pointer passes.
void SimulatedCluster::carry(Host& from, Host& to, double bytes, EventQueue::Happens happens) {
    if (&from == &to) return events_.at(events_.now(), std::move(happens));
    const double left = from.out.pass(events_.now(), bytes);
    const double on_its_way = std::max(from.facts->line.seconds, to.facts->line.seconds);
    events_.at(left + on_its_way, [this, &to, bytes, happens = std::move(happens)]() mutable {
        events_.at(to.in.pass(events_.now(), bytes), std::move(happens));
    });
}

SimulatedReplicas& SimulatedCluster::desk(Host& host, std::size_t node) {
    auto& desk = host.desks[node];
    if (desk) return *desk;
    std::vector<std::size_t> places;
    for (const auto& [index, place] : host.places)
        if (places_[place]->kind().holds[node]) places.push_back(place);
    desk = std::make_unique<SimulatedReplicas>(
        events_, setting_.plan.strategy_of(node),
        [this, places](auto replica, SimulatedAsk ask) { places_[places[replica]]->take(std::move(ask)); });
    for (std::size_t i = 0; i < places.size(); ++i) desk->join(0, 1, true);
    return *desk;
}

void SimulatedCluster::take_at(Host& host, std::optional<std::uint32_t> index, SimulatedAsk ask) {
    if (index) return places_[host.places.at(*index)]->take(std::move(ask));
    auto& dealt = desk(host, ask.node);
    dealt.add(std::move(ask));
}

// ---- the launcher's side --------------------------------------------------------------------------------------------

// Neighbours cost alike, and so do all samples of a piece of the picture.
double SimulatedCluster::times_of(const Tile& tile) const {
    const auto name = std::uint64_t{tile.x / 8} << 32 | tile.y / 8;
    return times_[mixed(name + setting_.seed * 0x9e3779b97f4a7c15) % times_.size()];
}

SimulatedAsk SimulatedCluster::work_in_tiles(const std::vector<Tile>& tiles) const {
    const auto side = double(setting_.costs.picture.tile);
    SimulatedAsk ask{setting_.costs.image, 0, 0, {}};
    for (const auto& tile : tiles) {
        const double share = double(tile.pixels()) * tile.blocks() / (side * side);
        ask.questions += share;
        ask.times += share * times_of(tile);
    }
    ask.times /= ask.questions;
    return ask;
}

bool SimulatedCluster::ask(const PlaceAt& to, Message& message) {
    auto& host = hosts_.at(to.host);
    const auto& tiles = *std::get<Questions<Tile>>(message.questions);
    SimulatedAsk ask = work_in_tiles(tiles);
    double bytes = bytes_of_ask;
    for (const auto& tile : tiles) bytes += bytes_of_colour * double(tile.pixels()) * setting_.costs.picture.colours;
    ask.answered = [this, &host, bytes, colours = answers_to(tiles, message.width),
                    reply = reply_to(message)](const SimulatedLoad& load) {
        Message answer = reply;
        answer.load = {std::uint32_t(load.fill), std::uint32_t(std::clamp(1e9 * load.service, 1.0, 4e9))};
        come_back(host, bytes, colours, std::move(answer));
    };
    const auto index = to.index == any_place ? std::nullopt : std::optional(to.index);
    const double there = is_own(host) ? now_ : launcher_out_.pass(now_, bytes_of_ask) + way_to(host);
    events_.at(there, [this, &host, index, ask = std::move(ask)] { take_at(host, index, ask); });
    return true;
}

// Pixels, to the launcher.
void SimulatedCluster::come_back(Host& host, double bytes, std::size_t colours, Message answer) {
    const double left = is_own(host) ? events_.now() : host.out.pass(events_.now(), bytes) + way_to(host);
    events_.at(left, [this, &host, bytes, colours, answer = std::move(answer)]() mutable {
        const double there = is_own(host) ? events_.now() : launcher_in_.pass(events_.now(), bytes);
        events_.at(there, [this, colours, answer = std::move(answer)]() mutable {
            answer.answers.resize(colours);
            arrived_.push_back(std::move(answer));
        });
    });
}

void SimulatedCluster::announce(double time, Plan plan) {
    Message message;
    message.type = Message::Type::plan;
    message.plan = std::make_shared<const Plan>(std::move(plan));
    events_.at(time, [this, message] { arrived_.push_back(message); });
}

std::optional<Message> SimulatedCluster::receive() {
    while (arrived_.empty() && events_.next() <= now_) events_.step();
    if (arrived_.empty()) return std::nullopt;
    Message message = std::move(arrived_.front());
    arrived_.pop_front();
    const double side = double(setting_.costs.picture.tile), colours = double(message.answers.size());
    const double work = setting_.costs.launcher_tile_seconds * colours / (side * side);
    now_ += work, launcher_busy_ += work;
    return message;
}

void SimulatedCluster::wait(std::chrono::nanoseconds most) {
    const double until = now_ + std::max(std::chrono::duration<double>(most).count(), least_wait);
    while (arrived_.empty() && events_.next() <= until) events_.step();
    if (arrived_.empty() && events_.next() == EventQueue::never && now_ > events_.now() + much_too_long)
        throw Error("this run would come to no end");
    now_ = arrived_.empty() ? until : std::max(now_, events_.now());
}

// ---- what it took ---------------------------------------------------------------------------------------------------

std::vector<double> SimulatedCluster::work_by_node() const {
    std::vector<double> work(setting_.costs.nodes.size(), 0);
    for (const auto& place : places_)
        for (std::size_t node = 0; node < work.size(); ++node) work[node] += place->by_node()[node];
    return work;
}

std::vector<double> SimulatedCluster::work_by_place() const {
    std::vector<double> work;
    for (const auto& place : places_) work.push_back(place->busy());
    return work;
}

std::vector<double> SimulatedCluster::host_lines() const {
    std::vector<double> lines;
    for (const auto& facts : setting_.hosts) {
        const auto& host = hosts_.at(facts.name);
        lines.push_back(std::max(host.in.busy(), host.out.busy()));
    }
    return lines;
}

}  // namespace lightnet
