#include "tools/forecast/forecast_curve.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>

#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t most_places = 256;
constexpr std::chrono::milliseconds long_enough{500};  // no row is begun after that

void check_memory(const RunCosts& costs, const Plan& plan, const std::vector<ForecastHost>& hosts) {
    for (const auto& host : hosts) {
        if (host.memory <= 0) continue;
        double needed = 0;
        for (std::size_t node = 0; node < plan.places_of.size(); ++node) {
            const auto& places = plan.places_of[node];
            if (std::any_of(places.begin(), places.end(),
                            [&](auto place) { return plan.places[place].host == host.name; }))
                needed += costs.nodes[node].memory;
        }
        if (needed > host.memory)
            throw UserError({"", 0}, "host " + in_quotes(host.name) +
                                         " has not enough memory: what its nodes prepare "
                                         "takes about " +
                                         std::to_string(std::uint64_t(needed) >> 20) + " MiB, see --layout");
    }
}

// Many places even out what pieces of the picture cost, and take longer to foresee.
std::uint32_t rounds_for(std::size_t places) { return places <= 256 ? 5 : places <= 2048 ? 3 : 1; }

std::uint32_t most_on_a_host(const std::vector<ForecastHost>& hosts) {
    std::uint32_t most = 1;
    for (const auto& host : hosts) most = std::max(most, host.places);
    return most;
}

}  // namespace

ForecastRow foreseen_on(const ForecastCrew& crew, const RecordedRun& run, const RunCosts& costs,
                        const LineCost& launcher, const Registry& registry) {
    std::vector<HostOffer> offers;
    for (const auto& host : crew.hosts) offers.push_back({host.name, host.places});
    const Plan where = plan(run.graph, registry, crew.entries, offers);
    check_memory(costs, where, crew.hosts);
    return {crew.hosts.size(), where.places.size(),
            forecast(costs, where, crew.hosts, launcher, rounds_for(where.places.size()))};
}

ForecastCurve curve_of_run(const std::filesystem::path& report, const Registry& registry) try {
    const auto begun = Clock::now();
    const RecordedRun run = read_recorded_run(report, registry);
    const ForecastHostsOptions usual;
    const LineCost line = line_called(usual.line, {}).value_or(LineCost{});
    ForecastCurve curve;
    curve.per_host = most_on_a_host(run.hosts);
    curve.places = run.plan.places.size();
    curve.seconds = run.seconds;
    ForecastTable table;
    table.recorded = run.seconds;
    table.replayed = forecast(run.costs, run.plan, run.hosts, line, 3).seconds;
    curve.doubt = doubt_in(table);
    for (std::uint32_t places = 1; places <= most_places && Clock::now() < begun + long_enough; places *= 2)
        curve.rows.push_back(
            foreseen_on(crew_of_places(places, curve.per_host, usual), run, run.costs, line, registry));
    return curve;
} catch (const std::exception&) {  // nothing is foreseen from one thread, or from what was changed by hand
    return {};
}

}  // namespace lightnet
