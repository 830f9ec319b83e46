// lightnet race: lets graphs render for the same time, in turns, and says how far each came.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/own_files.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/overrides.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/race/lap.hpp"
#include "tools/race/race_text.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t no_end = 1 << 24;  // samples: time ends a run

struct RaceOptions {
    std::vector<std::string> graphs;
    std::map<std::string, std::string> constants;
    RunningOptions running;
    double seconds = 60;
    std::uint32_t seeds = 3;
    std::string page = "race.html", csv = "race.csv";
};

void describe_race(CLI::App& app, RaceOptions& options) {
    app.add_option("GRAPH", options.graphs, "the graph files")->required();
    add_constants(app, options.constants, "override a constant of all graph files (may be repeated)");
    app.add_option("--reference", options.running.reference, "what all are to come near: EXR, HDR, PNG …")
        ->required()
        ->type_name("REFERENCE");
    takes_amounts(app.add_option("--seconds", options.seconds, "that each run has"), "S", Least::above_zero)
        ->capture_default_str();
    takes_numbers(app.add_option("--seeds", options.seeds, "runs of each graph, whose seeds are 1 to K"), "K", 1, 1000)
        ->capture_default_str();
    add_picture(app, options.running.picture);
    add_hosts(app, options.running.hosts);
    add_threads(app, options.running.threads, "threads of this process that render (default: one per core)");
    takes_numbers(app.add_option("--local-workers", options.running.local_workers, "daemons to start on this machine"),
                  "N", 1, 1024);
    app.add_option("-o,--output", options.page, "the page with curves and pictures")
        ->type_name("FILE.html")
        ->capture_default_str();
    app.add_option("--csv", options.csv, "the numbers")->type_name("FILE.csv")->capture_default_str();
    add_examples(app, {"lightnet race graphs/path.lua graphs/guided.lua --reference ref.exr --seconds 30 --seeds 5"});
}

// "path", "guided"; of two of one name all that the user typed.
std::vector<std::string> names_of(const std::vector<std::string>& graphs) {
    std::set<std::string> stems;
    for (const auto& graph : graphs) stems.insert(std::filesystem::path(graph).stem().string());
    std::vector<std::string> names;
    for (const auto& graph : graphs) names.push_back(stems.size() == graphs.size() ? stem_of_pictures(graph) : graph);
    return names;
}

// All graphs are evaluated before the first run starts threads.
std::vector<Contestant> contestants(const RaceOptions& options, const Launcher& launcher) {
    auto running = options.running;
    running.time_limit = options.seconds;
    running.progress = ProgressMode::none;
    if (!running.picture.samples) running.picture.samples = no_end;
    running.picture.output = "race.exr";  // each lap has its own
    const auto names = names_of(options.graphs);
    std::vector<Contestant> all;
    for (std::size_t i = 0; i < names.size(); ++i) {
        GraphOptions graph;
        graph.file = options.graphs[i];
        graph.constants = options.constants;
        Loaded loaded = validate_job(read_files(graph, running.hosts), running.picture, launcher.registry);
        all.push_back({names[i], request_of(running, launcher, std::move(loaded))});
    }
    return all;
}

void check_outputs(const RaceOptions& options) {
    if (const auto why = why_not_replaced(options.page, race_page_beginning); !why.empty())
        throw UserError({options.page, 0}, why);
    if (const auto why = why_not_replaced(options.csv, laps_beginning); !why.empty())
        throw UserError({options.csv, 0}, why);
}

void write_results(const RaceOptions& options, const std::vector<Lap>& laps, const Track& track) {
    write_file(options.csv, csv_of(laps));
    write_file(options.page, race_page(laps, {options.running.reference, track.reference_png(), options.seconds}));
}

// In turns, so that whatever else the machine does meets all of them alike.
int race(const RaceOptions& options, const Launcher& launcher) {
    check_outputs(options);
    const auto all = contestants(options, launcher);
    Track track(launcher.run, options.running.reference);
    std::vector<Lap> laps;
    try {
        for (std::uint32_t seed = 1; seed <= options.seeds; ++seed)
            for (const auto& contestant : all) {
                const Lap& lap = laps.emplace_back(track.lap(contestant, seed, seed == 1));
                launcher.err << fmt::format("{}, seed {}: {:g} samples, relMSE {:.4g}\n", lap.name, seed, lap.samples,
                                            lap.error->relative_square);
                write_results(options, laps, track);
            }
    } catch (const Track::Interrupted&) {
        launcher.out << table_of(laps);
        return exit_code::interrupted;
    } catch (const Error&) {
        launcher.out << table_of(laps);
        throw;
    }
    launcher.out << table_of(laps);
    launcher.err << options.page << ", " << options.csv << '\n';
    return exit_code::done;
}

}  // namespace

Verb race_verb() {
    return verb<RaceOptions>("race", "let graphs render for the same time, and compare how far they come",
                             describe_race, race);
}

}  // namespace lightnet
