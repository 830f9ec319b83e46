#include "core/run/forecast/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "core/base/error.hpp"
#include "core/film/film.hpp"
#include "core/run/forecast/place_work.hpp"
#include "core/run/forecast/simulated_cluster.hpp"
#include "core/run/forecast/simulated_preparing.hpp"
#include "core/run/master/master_renderer.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;

constexpr double between_plans = 1;  // seconds, of hosts that are ready one after the other

// Rendered once.
struct Rendered {
    double seconds = 0, launcher_thread = 0, launcher_line = 0;
    std::vector<double> by_node, by_place, lines;
};

// The plan of those that are ready.
Plan ready_part(const Plan& plan, const std::map<std::string, double>& ready, double time) {
    Plan part = plan;
    for (auto& places : part.places_of) {
        std::vector<std::uint32_t> there;
        for (const auto place : places)
            if (ready.at(plan.places[place].host) <= time) there.push_back(place);
        if (!there.empty()) places = std::move(there);
    }
    return part;
}

// A place that works alone has two pieces at a time, and one that asks others some more, as Rendering has it.
Credit credit_of(const Plan& plan, std::size_t image) {
    const bool alone = std::all_of(plan.places_of.begin(), plan.places_of.end(), [&](const auto& places) {
        return places.empty() || places == plan.places_of[image];
    });
    const std::size_t tiles = alone ? 2 : 6;
    return {tiles, tiles * MasterRenderer::most_together};
}

Rendered render(const SimulatedSetting& setting, const SimulatedPreparing& prepared) {
    SimulatedCluster cluster(setting);
    const auto& costs = setting.costs;
    MasterRenderer::Job job;
    job.image = static_cast<std::uint32_t>(costs.image);
    job.tiles = tiles_of(costs.picture.width, costs.picture.height, costs.picture.tile, costs.picture.samples);
    job.credit = credit_of(setting.plan, costs.image);
    job.clock = [&cluster] { return cluster.now(); };
    MasterRenderer master(std::move(job), cluster, [](const Tile&, auto) {});
    const double begin = prepared.seconds;
    master.use(ready_part(setting.plan, prepared.ready, begin));
    std::set<double> later;
    for (const auto& [host, time] : prepared.ready)
        if (time > begin) later.insert(between_plans * std::ceil((time - begin) / between_plans));
    for (const auto time : later) cluster.announce(time, ready_part(setting.plan, prepared.ready, begin + time));
    if (!master.work(1'000'000'000s)) throw Error("this run would come to no end");
    return {cluster.now(),          cluster.launcher_thread(), cluster.launcher_line(),
            cluster.work_by_node(), cluster.work_by_place(),   cluster.host_lines()};
}

struct Use {
    double busy = 0;
    std::uint32_t places = 0;
};

// How busy hosts were, each by all of its places.
std::map<std::string, Use> use_of_hosts(const Plan& plan, const Rendered& rendered) {
    std::map<std::string, Use> hosts;
    for (std::size_t place = 0; place < plan.places.size(); ++place) {
        auto& host = hosts[plan.places[place].host];
        host.busy += rendered.by_place[place];
        ++host.places;
    }
    return hosts;
}

// Of the nodes that the busiest host holds, and not all others: the one with the most work. "": there is none.
std::string crowded_node(const RunCosts& costs, const Plan& plan, const Rendered& rendered, const std::string& host) {
    std::string name;
    double most = 0;
    for (std::size_t node = 0; node < costs.nodes.size(); ++node) {
        const auto& places = plan.places_of[node];
        const bool there =
            std::any_of(places.begin(), places.end(), [&](auto place) { return plan.places[place].host == host; });
        if (!there || places.size() == plan.places.size() || rendered.by_node[node] <= most) continue;
        most = rendered.by_node[node], name = costs.nodes[node].name;
    }
    return name;
}

void add_places(std::vector<BusyPart>& parts, const RunCosts& costs, const Plan& plan, const Rendered& rendered,
                double seconds) {
    constexpr double much_busier = 1.15;
    double sum = 0, most = 0;
    std::string busiest;
    for (const auto& [host, use] : use_of_hosts(plan, rendered)) {
        const double share = use.busy / use.places / seconds;
        sum += use.busy;
        if (share > most) most = share, busiest = host;
    }
    const double mean = sum / double(plan.places.size()) / seconds;
    parts.push_back({BusyPart::What::places, "", mean});
    if (most <= much_busier * mean) return;
    const auto node = crowded_node(costs, plan, rendered, busiest);
    if (node.empty())
        parts.push_back({BusyPart::What::host, busiest, most});
    else
        parts.push_back({BusyPart::What::node, node, most});
}

std::vector<BusyPart> busy_parts(const RunCosts& costs, const Plan& plan, const std::vector<ForecastHost>& hosts,
                                 const Rendered& rendered, const SimulatedPreparing& prepared, double seconds) {
    using What = BusyPart::What;
    std::vector<BusyPart> parts;
    add_places(parts, costs, plan, rendered, seconds);
    parts.push_back({What::alone, "", (costs.load_seconds + costs.write_seconds) / seconds});
    parts.push_back({What::launcher_thread, "", rendered.launcher_thread / seconds});
    parts.push_back({What::launcher_line, "", (rendered.launcher_line + prepared.launcher_line) / seconds});
    const auto line = std::max_element(rendered.lines.begin(), rendered.lines.end()) - rendered.lines.begin();
    parts.push_back({What::line, hosts[std::size_t(line)].name, rendered.lines[std::size_t(line)] / seconds});
    for (std::size_t node = 0; node < costs.nodes.size(); ++node)
        if (prepared.by_node[node] > 0)
            parts.push_back({What::preparing, costs.nodes[node].name, prepared.by_node[node] / seconds});
    std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
    return parts;
}

// Of all its places together, beside one at speed 1.
double power_of(const Plan& plan, const std::vector<ForecastHost>& hosts) {
    std::map<std::string, std::uint32_t> places;
    for (const auto& place : plan.places) ++places[place.host];
    double power = 0;
    for (const auto& host : hosts)
        if (const auto there = places.find(host.name); there != places.end()) power += host.power_of(there->second);
    return power;
}

}  // namespace

Forecast forecast(const RunCosts& costs, const Plan& plan, const std::vector<ForecastHost>& hosts,
                  const LineCost& launcher, std::uint32_t rounds) {
    for (const auto node : costs.order)
        if (plan.places_of[node].empty()) throw Error("no place holds '" + costs.nodes[node].name + "'");
    const auto prepared = simulate_preparing(costs, plan, hosts, launcher);
    Forecast all;
    all.by_node.assign(costs.nodes.size(), 0);
    Rendered last;
    const double frames = costs.picture.frames, before = costs.load_seconds + prepared.seconds + costs.write_seconds;
    std::vector<double> seconds;
    for (std::uint32_t round = 0; round < rounds; ++round) {
        last = render({costs, plan, hosts, launcher, round + 1}, prepared);
        seconds.push_back(last.seconds);
    }
    all.render = std::accumulate(seconds.begin(), seconds.end(), 0.0) / rounds;
    all.seconds = frames * (before + all.render);
    const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
    all.least = frames * (before + *least), all.most = frames * (before + *most);
    all.parts = busy_parts(costs, plan, hosts, last, prepared, before + last.seconds);
    all.load = frames * costs.load_seconds, all.write = frames * costs.write_seconds;
    all.prepare = frames * prepared.seconds, all.render *= frames;
    const auto work = work_by_node(costs);
    for (std::size_t node = 0; node < work.size(); ++node) all.by_node[node] = frames * work[node];
    all.work = std::accumulate(all.by_node.begin(), all.by_node.end(), frames * prepared.work);
    all.efficiency = all.work / (power_of(plan, hosts) * all.seconds);
    return all;
}

std::string words_for(const BusyPart& part) {
    switch (part.what) {
        case BusyPart::What::places:
            return "the places, all alike";
        case BusyPart::What::host:
            return "host '" + part.name + "'";
        case BusyPart::What::node:
            return "node '" + part.name + "'";
        case BusyPart::What::line:
            return "the line of host '" + part.name + "'";
        case BusyPart::What::launcher_line:
            return "the launcher's line";
        case BusyPart::What::launcher_thread:
            return "the launcher's own thread";
        case BusyPart::What::preparing:
            return "preparing '" + part.name + "'";
        case BusyPart::What::alone:
            return "loading the scene and writing the picture";
    }
    return "";
}

std::string advice_for(const Forecast& forecast) {
    const auto& busiest = forecast.parts.front();
    constexpr double hardly = 0.4;
    if (busiest.share < hardly) return "nobody is busy for long: smaller tiles (--tile) deal the work out better";
    switch (busiest.what) {
        case BusyPart::What::places:
            return "more places, or faster ones, make it quicker";
        case BusyPart::What::host:
            return "give the nodes of host '" + busiest.name + "' to others as well";
        case BusyPart::What::node:
            return "put more replicas of '" + busiest.name + "' where places wait";
        case BusyPart::What::line:
            return "put what is asked over this line on the same host, or take a faster line";
        case BusyPart::What::launcher_line:
            return "a faster line of the launcher; fewer layers and no more hosts";
        case BusyPart::What::launcher_thread:
            return "larger tiles (--tile) and fewer layers; more hosts don't help";
        case BusyPart::What::preparing:
            return "more samples or frames for what is prepared once; more hosts don't help";
        case BusyPart::What::alone:
            return "more hosts don't help: nobody else can do this";
    }
    return "";
}

RunCosts shortened(const RunCosts& costs, double most_blocks) {
    RunCosts fewer = costs;
    const double blocks = usual_blocks(costs.picture);
    if (blocks <= most_blocks) return fewer;
    const auto side = [&](std::uint32_t pixels) {
        return std::max(costs.picture.tile, std::uint32_t(pixels * std::sqrt(most_blocks / blocks)));
    };
    fewer.picture.width = side(costs.picture.width), fewer.picture.height = side(costs.picture.height);
    const double part = usual_blocks(fewer.picture) / blocks;
    for (auto& node : fewer.nodes) {
        auto& preparing = node.preparing;
        preparing.shard_seconds *= part, preparing.own_seconds *= part, preparing.bytes *= part;
    }
    return fewer;
}

bool are_played(const RunCosts& costs, const std::vector<ForecastHost>& hosts) {
    constexpr std::size_t few = 40;
    return hosts.size() * costs.order.size() <= few;
}

}  // namespace lightnet
