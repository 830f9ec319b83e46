// lightnet sweep: runs a graph with all combinations of some constants and seeds, and tables what came of it.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/atomic_file.hpp"
#include "core/base/between_commas.hpp"
#include "core/base/error.hpp"
#include "core/base/own_files.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/race/lap.hpp"
#include "tools/race/race_text.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

using Constants = std::map<std::string, std::string>;
constexpr std::size_t most_runs = 10000;

struct SweepOptions {
    GraphOptions graph;  // each constant may have several values, with commas between them
    std::vector<int> seeds{0};
    RunningOptions running;
    std::string csv;
};

void describe_sweep(CLI::App& app, SweepOptions& options) {
    app.add_option("GRAPH", options.graph.file, "the graph file; -: standard input")->required();
    add_constants(app, options.graph.constants,
                  "override a constant of the graph file, by each of these values: -D samples=16,64 (may be repeated: "
                  "all combinations)");
    app.add_option_function<std::string>(
           "--seed",
           [&options](const std::string& text) { options.seeds = std::get<std::vector<int>>(frames_of(text)); },
           "seeds of all random numbers, like 1-5 or 1,3,7")
        ->type_name("N|N-M")
        ->check([](const std::string& text) {
            const auto found = frames_of(text);
            return std::holds_alternative<std::string>(found) ? "seeds are like 1-5 or 1,3,7, not " + text : "";
        });
    app.add_option("--reference", options.running.reference, "say how far pictures are from this one: EXR, HDR, PNG …")
        ->type_name("REFERENCE");
    takes_amounts(app.add_option("--time-limit", options.running.time_limit, "end each run after so many seconds"),
                  "SECONDS", Least::above_zero);
    add_picture(app, options.running.picture);
    add_hosts(app, options.running.hosts);
    add_threads(app, options.running.threads, "threads of this process that render (default: one per core)");
    takes_numbers(app.add_option("--local-workers", options.running.local_workers, "daemons to start on this machine"),
                  "N", 1, 1024);
    app.add_option("--csv", options.csv, "write the numbers as well")->type_name("FILE.csv");
    add_examples(app, {"lightnet sweep graphs/cornell.lua -D samples=16,64 --seed 1-5 --reference ref.exr"});
}

// The last constant changes first.
std::vector<Constants> combinations(const Constants& lists) {
    std::vector<Constants> all{{}};
    for (const auto& [name, list] : lists) {
        std::vector<Constants> more;
        for (const auto& before : all)
            for (const auto& value : between_commas(list)) {
                more.push_back(before);
                more.back()[name] = value;
            }
        if (more.size() > most_runs)
            throw UserError({"-D", 0}, fmt::format("these are more than {} combinations", most_runs));
        all = std::move(more);
    }
    return all;
}

// "rays=1 samples=16"
std::string name_of(const Constants& constants) {
    std::string name;
    for (const auto& [key, value] : constants) name += (name.empty() ? "" : " ") + key + "=" + value;
    return name.empty() ? "-" : name;
}

std::vector<Contestant> all_runs(const SweepOptions& options, const Launcher& launcher) {
    auto running = options.running;
    running.progress = ProgressMode::none;
    running.picture.output = "sweep.exr";  // each lap has its own
    auto graph = taken_from_standard_input(options.graph);
    std::vector<Contestant> all;
    for (auto& constants : combinations(options.graph.constants)) {
        graph.constants = constants;
        Loaded loaded = validate_job(read_files(graph, running.hosts), running.picture, launcher.registry);
        all.push_back({name_of(constants), request_of(running, launcher, std::move(loaded))});
    }
    return all;
}

int sweep(const SweepOptions& options, const Launcher& launcher) {
    if (const auto why = why_not_replaced(options.csv, laps_beginning); !options.csv.empty() && !why.empty())
        throw UserError({options.csv, 0}, why);
    const auto all = all_runs(options, launcher);
    Track track(launcher.run, options.running.reference);
    std::vector<Lap> laps;
    try {
        for (const auto& contestant : all)
            for (const int seed : options.seeds) {
                laps.push_back(track.lap(contestant, static_cast<std::uint64_t>(seed), false));
                launcher.err << fmt::format("{}, seed {}: {:.2f} s\n", contestant.name, seed, laps.back().seconds);
            }
    } catch (const Track::Interrupted&) {
        launcher.out << table_of(laps);
        return exit_code::interrupted;
    }
    launcher.out << table_of(laps);
    if (!options.csv.empty()) write_file(options.csv, csv_of(laps));
    return exit_code::done;
}

}  // namespace

Verb sweep_verb() {
    return verb<SweepOptions>("sweep", "run a graph with several constants and seeds, and table what came of it",
                              describe_sweep, sweep);
}

}  // namespace lightnet
