// lightnet predict: how long a run would take on other hosts.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "core/network/graph/check_hosts.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/options.hpp"
#include "tools/forecast/forecast_curve.hpp"
#include "tools/forecast/forecast_hosts.hpp"
#include "tools/forecast/forecast_text.hpp"
#include "tools/forecast/recorded_run.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct PredictOptions {
    std::string report;
    ForecastHostsOptions hosts;
    std::vector<std::uint32_t> places;
    std::uint32_t per_host = 1;
    std::vector<std::string> links;
    OtherPicture picture;
    std::string size;
    bool json = false;
};

// WIDTHxHEIGHT.
bool read_size(const std::string& text, OtherPicture& picture) {
    const auto number = [](const std::string& digits, std::uint32_t& to) {
        const auto all = !digits.empty() && digits.size() < 7 &&
                         std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
        to = all ? static_cast<std::uint32_t>(std::stoul(digits)) : 0;
        return to > 0;
    };
    const auto x = text.find('x');
    return x != std::string::npos && number(text.substr(0, x), picture.width) &&
           number(text.substr(x + 1), picture.height);
}

void describe_predict(CLI::App& app, PredictOptions& options) {
    app.add_option("report", options.report, "report of a run, which was done on any hosts")
        ->type_name("X.run.json")
        ->required();
    auto* const hosts =
        app.add_option("--hosts", options.hosts.hosts, "these: hosts files, or NAME=PLACES (may be repeated)")
            ->type_name("FILE")
            ->delimiter(',');
    takes_numbers(app.add_option("--places", options.places, "so many places, as in 1,2,4,10000"), "N", 1, 1'000'000)
        ->delimiter(',')
        ->excludes(hosts);
    takes_numbers(app.add_option("--per-host", options.per_host, "of them on each host (default: 1)"), "N", 1, 4096);
    app.add_option("--link", options.links,
                   "line of each host, and of the launcher (default: 1Gbit,0.2ms); NAME=100Mbit,5ms: of one host")
        ->type_name("LINE");
    app.add_option("--memory", options.hosts.memory, "what a host may keep, for all or NAME=16G")->type_name("SIZE");
    app.add_option("--speed", options.hosts.speeds, "NAME=2: twice as quick as where it was recorded")
        ->type_name("SPEED");
    app.add_option("--processors", options.hosts.processors,
                   "NAME=1.5: so many are shared by its places, however many these are (default: one each)")
        ->type_name("COUNT");
    takes_numbers(app.add_option("--frames", options.picture.frames, "so many such pictures"), "N", 1, 1'000'000);
    takes_numbers(app.add_option("--samples", options.picture.samples, "with so many samples per pixel"), "N", 1,
                  1'000'000);
    app.add_option("--size", options.size, "of so many pixels")->type_name("WxH");
    takes_numbers(app.add_option("--tile", options.picture.tile, "pixels along a side of a tile"), "N", 1, 256);
    app.add_flag("--json", options.json, "print JSON");
    add_examples(app, {"lightnet predict cornell.run.json --places 1,2,4,8,16 --per-host 8",
                       "lightnet predict cornell.run.json --hosts onyx1=8,onyx2=4 --link 10Gbit,0.1ms --frames 240"});
}

// Of all, or of one by its name, by the equals sign.
void sort_links(const PredictOptions& options, ForecastHostsOptions& hosts) {
    for (const auto& link : options.links)
        if (link.find('=') == std::string::npos)
            hosts.line = link;
        else
            hosts.lines.push_back(link);
}

int predict(const PredictOptions& options, const Launcher& launcher) {
    OtherPicture picture = options.picture;
    if (!options.size.empty() && !read_size(options.size, picture))
        throw UserError({"", 0}, "--size " + in_quotes(options.size) + ": it is said like 1920x1080");
    ForecastHostsOptions said = options.hosts;
    sort_links(options, said);
    const auto line = line_called(said.line, {});
    const RecordedRun run = read_recorded_run(options.report, launcher.registry);
    const RunCosts costs = scaled(run.costs, picture);
    std::vector<ForecastCrew> crews;
    for (const auto places : options.places) crews.push_back(crew_of_places(places, options.per_host, said));
    if (!said.hosts.empty()) crews.push_back(crew_called(said));
    if (crews.empty())
        for (const std::uint32_t places : {1, 2, 4, 8, 16, 32})
            crews.push_back(crew_of_places(places, options.per_host, said));
    for (const auto& crew : crews) {
        std::vector<Problem> problems;
        check_hosts(crew.entries, run.graph, launcher.registry, problems);
        if (!problems.empty()) throw UserError(problems);
    }
    ForecastTable table;
    table.report = options.report;
    table.recorded = run.seconds;
    table.replayed = forecast(run.costs, run.plan, run.hosts, line.value_or(LineCost{}), 3).seconds;
    for (const auto& node : run.costs.nodes) table.nodes.push_back(node.name);
    table.width = costs.picture.width, table.height = costs.picture.height;
    table.samples = costs.picture.samples, table.frames = costs.picture.frames;
    for (const auto& crew : crews)
        table.rows.push_back(foreseen_on(crew, run, costs, line.value_or(LineCost{}), launcher.registry));
    launcher.out << (options.json ? to_json(table) : to_text(table));
    return exit_code::done;
}

}  // namespace

Verb predict_verb() {
    return verb<PredictOptions>("predict",
                                "say how long a recorded run would take on other hosts, and what holds it up",
                                describe_predict, predict);
}

}  // namespace lightnet
