// Forecasts beside SimGrid (Casanova et al. 2014), which knows nothing of our places, bundles and schedulers: the same
// hosts, lines and work, dealt out by a dealer that knows how busy everybody is. Twenty networks and hosts as in
// `layouts`, without preparing; the argument is the seed of the first. Built where SimGrid is, and run where it is
// named.
#include <sys/wait.h>
#include <unistd.h>
#include <xbt/log.h>
#include <simgrid/s4u.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/run/forecast/place_work.hpp"
#include "core/run/message/tuning.hpp"
#include "core/run/place/full_bundle.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/judge.hpp"
#include "tests/run/layout_cases.hpp"

namespace lightnet::bench {
namespace {

namespace sg = simgrid::s4u;
using namespace test;

// As in the forecast: of a message beside what it carries, and of a place's thread for each.
constexpr double bytes_of_message = 200, seconds_of_message = 2e-5;

/// Hosts, lines and actors of one case. SimGrid has one engine in each process.
class Actors {
public:
    Actors(const LayoutCase& made, const HeldByHosts& holds)
        : made_(made), plan_(plan_of(holds, made.hosts)), kinds_(place_kinds(made.costs, plan_)), engine_("lightnet") {
        xbt_log_control_set("xbt_cfg.thres:warning");
        // Lines as they are, without what SimGrid knows of TCP by default.
        sg::Engine::set_config("network/model:CM02");
        sg::Engine::set_config("network/TCP-gamma:0");
        sg::Engine::set_config("network/crosstraffic:0");
        auto* const zone = sg::create_full_zone("all");
        for (const auto& facts : made.hosts) {
            auto& host = hosts_.emplace_back();
            host.facts = &facts;
            host.machine = zone->create_host(facts.name, facts.speed)->set_core_count(int(facts.places));
            add_lines(zone, host, facts.name, facts.line.bytes_per_second);
            for (std::uint32_t place = 0; place < facts.places; ++place)
                host.places.push_back({sg::Semaphore::create(1), 0});
        }
        launcher_.machine = zone->create_host("launcher", 1);
        add_lines(zone, launcher_, "launcher", launcher.bytes_per_second);
        for (auto& from : hosts_) {
            const auto there = from.facts->line.seconds;
            connect(zone, launcher_, from, there + launcher.seconds);
            connect(zone, from, launcher_, there + launcher.seconds);
            for (auto& to : hosts_)
                if (&from != &to) connect(zone, from, to, std::max(there, to.facts->line.seconds));
        }
        zone->seal();
        for (std::size_t place = 0; place < plan_.places.size(); ++place)
            for (auto& host : hosts_)
                if (host.facts->name == plan_.places[place].host) host.kind = &kinds_.kinds[kinds_.of_place[place]];
    }

    double seconds() {
        const auto& picture = made_.costs.picture;
        tiles_ = tiles_of(picture.width, picture.height, picture.tile, picture.samples).size();
        const bool alone = std::all_of(hosts_.begin(), hosts_.end(), [&](const auto& host) {  // nobody asks anybody
            return !holds(host, made_.costs.image) || host.kind->light[made_.costs.image].asked.empty();
        });
        for (auto& host : hosts_)
            for (std::size_t i = 0; holds(host, made_.costs.image) && i < host.places.size() * (alone ? 2 : 6); ++i)
                sg::Actor::create("tiles", launcher_.machine, [this, &host] { render(host); });
        engine_.run();
        return sg::Engine::get_clock();
    }

private:
    struct CorePlace {
        sg::SemaphorePtr core;
        double busy;  // seconds of work that it has been given
    };
    struct Host {
        const ForecastHost* facts = nullptr;
        const PlaceWork* kind = nullptr;  // of all its places; null: nothing
        sg::Host* machine = nullptr;
        sg::Link *out = nullptr, *in = nullptr;
        std::vector<CorePlace> places{};
    };

    static void add_lines(sg::NetZone* zone, Host& host, const std::string& name, double bytes_per_second) {
        host.out = zone->create_link(name + " out", bytes_per_second)->seal();
        host.in = zone->create_link(name + " in", bytes_per_second)->seal();
    }
    static void connect(sg::NetZone* zone, const Host& from, const Host& to, double seconds) {
        auto* const way = zone->create_link(from.machine->get_name() + " to " + to.machine->get_name(), 1e15)
                              ->set_latency(seconds)
                              ->seal();
        zone->add_route(from.machine->get_netpoint(), to.machine->get_netpoint(), nullptr, nullptr,
                        {sg::LinkInRoute(from.out), sg::LinkInRoute(way), sg::LinkInRoute(to.in)}, false);
    }
    static bool holds(const Host& host, std::size_t node) { return host.kind && host.kind->holds[node]; }

    void render(Host& host) {
        const auto& picture = made_.costs.picture;
        while (tiles_ > 0) {
            --tiles_;
            sg::Comm::sendto(launcher_.machine, host.machine, std::uint64_t(bytes_of_message));
            const auto done = sg::Actor::create("tile", host.machine, [&] { work(host, made_.costs.image, 1); });
            done->join();
            sg::Comm::sendto(host.machine, launcher_.machine,
                             std::uint64_t(bytes_of_message + bytes_of_colour * picture.tile * picture.tile));
        }
    }

    // On the host's own machine.
    void work(Host& host, std::size_t node, double questions) {
        const auto& light = host.kind->light[node];
        const double seconds = questions * light.seconds + seconds_of_message;
        auto& place = *std::min_element(host.places.begin(), host.places.end(),
                                        [](const auto& a, const auto& b) { return a.busy < b.busy; });
        place.busy += seconds;
        place.core->acquire();
        sg::this_actor::execute(seconds);
        place.core->release();
        place.busy -= seconds;
        std::vector<sg::ActorPtr> asks;
        for (const auto& [asked, each] : light.asked) ask(host, asked, questions * each, asks);
        for (const auto& one : asks) one->join();
    }

    void ask(Host& from, std::size_t node, double questions, std::vector<sg::ActorPtr>& asks) {
        const double full = double(full_bundle(Tuning{}.bundle, made_.costs.nodes[node].seconds));
        const double pieces = std::max(1.0, std::ceil(questions / full));
        for (int piece = 0; piece < int(pieces); ++piece)
            asks.push_back(sg::Actor::create(
                "ask", from.machine, [this, &from, node, some = questions / pieces] { answer(from, node, some); }));
    }

    void answer(Host& from, std::size_t node, double questions) {
        Host& to = first_to_answer(from, node, questions);
        const double bytes = bytes_of_message + 60 * questions;
        if (&to != &from) sg::Comm::sendto(from.machine, to.machine, std::uint64_t(0.75 * bytes));
        sg::Actor::create("work", to.machine, [&] { work(to, node, questions); })->join();
        if (&to != &from) sg::Comm::sendto(to.machine, from.machine, std::uint64_t(0.25 * bytes));
    }

    Host& first_to_answer(Host& from, std::size_t node, double questions) {
        Host* first = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (auto& host : hosts_) {
            if (!holds(host, node)) continue;
            double busy = std::numeric_limits<double>::infinity();
            for (const auto& place : host.places) busy = std::min(busy, place.busy);
            double end = (busy + questions * host.kind->light[node].seconds) / host.facts->speed;
            if (&host != &from) end += 2 * std::max(host.facts->line.seconds, from.facts->line.seconds);
            if (end < least) least = end, first = &host;
        }
        return *first;
    }

    const LayoutCase& made_;
    Plan plan_;
    PlaceKinds kinds_;
    sg::Engine engine_;
    std::vector<Host> hosts_;
    Host launcher_;
    std::size_t tiles_ = 0;
};

// In a process of its own.
double seconds_by_simgrid(const LayoutCase& made, const HeldByHosts& holds) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const int process = fork();
    if (process == 0) {
        const double seconds = Actors(made, holds).seconds();
        const bool written = write(ends[1], &seconds, sizeof seconds) == ssize_t(sizeof seconds);
        _exit(written ? 0 : 1);
    }
    close(ends[1]);
    double seconds = 0;
    const bool whole = read(ends[0], &seconds, sizeof seconds) == ssize_t(sizeof seconds);
    close(ends[0]);
    waitpid(process, nullptr, 0);
    if (!whole) throw std::runtime_error("SimGrid came to no end");
    return seconds;
}

void measure(std::uint64_t first_seed) {
    const std::vector<std::pair<std::size_t, std::size_t>> sizes{{2, 3}, {3, 2}, {4, 2}, {3, 3}, {2, 4}};
    std::vector<double> ours, theirs, differences;
    for (std::size_t i = 0; i < sized<std::size_t>(20, 2); ++i) {
        auto made = LayoutDice(first_seed + i).roll(sizes[i % sizes.size()].first, sizes[i % sizes.size()].second);
        for (auto& node : made.costs.nodes) node.preparing = {};
        const auto holds = place_nodes(made.costs, made.hosts, launcher).holds;
        const double by_simgrid = seconds_by_simgrid(made, holds), foreseen = seconds_of(made, holds);
        ours.push_back(foreseen), theirs.push_back(by_simgrid);
        differences.push_back(std::abs(foreseen / by_simgrid - 1));
        std::printf("  simgrid: seed %llu: %.3f s foreseen, %.3f by SimGrid (%+.1f %%)\n",
                    static_cast<unsigned long long>(first_seed + i), foreseen, by_simgrid,
                    100 * (foreseen / by_simgrid - 1));
        std::fflush(stdout);
    }
    figure("simgrid.rank", {rank_correlation(ours, theirs)}, 0.9, true);
    figure("simgrid.difference", differences, 0.05, false);
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    return lightnet::bench::run("simgrid", [&] { lightnet::bench::measure(argc > 1 ? std::stoull(argv[1]) : 0); });
}
