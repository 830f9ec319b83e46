// lightnet bench-hosts: how much quicker a graph becomes with more hosts.
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/base/allowance.hpp"
#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/base/json.hpp"
#include "core/base/own_files.hpp"
#include "core/base/plain_file.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/cli/trouble_options.hpp"
#include "tools/session/delivery.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;

struct BenchHostsOptions {
    GraphOptions graph;
    RunningOptions running;
    std::uint32_t rounds = 3;
    std::string csv;
};

void describe_bench_hosts(CLI::App& app, BenchHostsOptions& options) {
    auto& running = options.running;
    add_graph(app, options.graph);
    add_picture(app, running.picture);
    auto* const hosts = add_hosts(app, running.hosts);
    takes_numbers(
        app.add_option("--local-workers", running.local_workers,
                       "up to so many daemons on this machine, instead of a hosts file's (default: one per core)"),
        "N", 1, 1024)
        ->excludes(hosts);
    app.add_option("--key", running.key, "file with our secret key (default: ~/.config/lightnet/key)")
        ->type_name("FILE");
    app.add_flag("--insecure", running.insecure, "reach beyond this machine without keys");
    takes_numbers(app.add_option("--rounds", options.rounds, "times that each number of hosts is measured, in turns"),
                  "N", 1, 100)
        ->capture_default_str();
    app.add_option("--csv", options.csv, "write all figures, one line per run")->type_name("FILE.csv");
    add_troubles(app, running.troubles);
    when_taken_apart(app, [&options] {
        const auto mistake = mistaken_scene(options.graph.file, "to render it: lightnet render");
        const auto& given = options.running;
        return mistake ? mistake : mistake_in(given.troubles, given.local_workers.value_or(0));
    });
    add_examples(app, {"lightnet bench-hosts graphs/cornell.lua --size 256x256 --samples 64 --local-workers 4",
                       "lightnet bench-hosts graphs/cornell.lua --hosts lab.lua --rounds 5 --csv lab.csv"});
}

/// A folder for pictures that nobody wants, gone at the end.
class Scratch {
public:
    Scratch() : path_(new_folder_in(folders_of_last_resort().front())) {
        if (path_.empty()) throw Error("no folder for pictures", "in " + folders_of_last_resort().front());
    }
    ~Scratch() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    std::string file(const std::string& name) const { return (path_ / name).string(); }

private:
    fs::path path_;
};

std::string content_of(const std::string& path) { return PlainFile(path, std::uint64_t{1} << 30).text(); }

/// What one run took, seconds.
struct HostsRun {
    double prepare = 0, render = 0;
    double both() const { return prepare + render; }
};

/// So many hosts, and what their runs took.
struct HostsRow {
    std::uint32_t hosts = 1;
    std::vector<HostsRun> runs;
    double median(double (*of)(const HostsRun&)) const {
        std::vector<double> values;
        for (const auto& run : runs) values.push_back(of(run));
        std::sort(values.begin(), values.end());
        const auto middle = values.size() / 2;
        return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
    }
};

// 1, 2, 4, … and all of them.
std::vector<HostsRow> rows_up_to(std::uint32_t most) {
    std::vector<HostsRow> rows;
    for (std::uint32_t hosts = 1; hosts < most; hosts *= 2) rows.push_back({hosts, {}});
    rows.push_back({most, {}});
    return rows;
}

void check_that_any_host_will_do(const Hosts& hosts) {
    for (const auto& entry : hosts.hosts)
        if (!entry.replicas.empty() || entry.is_here())
            throw UserError(entry.where,
                            "bench-hosts wants hosts that hold the whole network, as it leaves some out: "
                            "place \"" +
                                entry.endpoint + "\" {}");
}

/// Runs a graph on more and more hosts.
class HostsBench {
public:
    HostsBench(const BenchHostsOptions& options, const Launcher& launcher)
        : options_(options),
          launcher_(launcher),
          loaded_(validate_job(read_files(options.graph, options.running.hosts), options.running.picture,
                               launcher.registry)) {
        check_that_any_host_will_do(loaded_.hosts);
    }

    std::uint32_t most() const {
        if (!loaded_.hosts.hosts.empty()) return static_cast<std::uint32_t>(loaded_.hosts.hosts.size());
        return options_.running.local_workers.value_or(usable_cores());
    }

    HostsRun run(std::uint32_t hosts) {
        RunningOptions running = options_.running;
        Loaded some = loaded_;
        if (some.hosts.hosts.empty()) {
            running.local_workers = hosts;
            // A worker that isn't there this time has no troubles.
            std::erase_if(running.troubles.slow, [&](const auto& one) { return one.first > hosts; });
            std::erase_if(running.troubles.lose, [&](const auto& one) { return one.first > hosts; });
        } else {
            some.hosts.hosts.resize(hosts);
        }
        running.picture.output = scratch_.file("picture.exr");
        running.progress = ProgressMode::none;
        running.tuning.cache = "none";
        running.forget = true;
        running.memo = false;
        auto request = request_of(running, launcher_, std::move(some));
        request.local_places = 1;
        if (const int code = launcher_.run(request); code != 0)
            throw Error("a run on " + std::to_string(hosts) + " hosts", "has ended with code " + std::to_string(code));
        compare(scratch_.file("picture.exr"));
        return times_in(scratch_.file("picture.run.json"));
    }

private:
    void compare(const std::string& picture) {
        const Hash hash = content_hash(content_of(picture));
        if (picture_ == Hash{}) picture_ = hash;
        if (hash != picture_)
            throw Error("the pictures of two runs differ", "which is an error of ours; please report it");
    }

    static HostsRun times_in(const std::string& report) {
        HostsRun run;
        const Json json = parse_json(content_of(report), {.depth = 40});
        for (const auto& phase : json.at("phases").list()) {
            if (phase.at("name").text() == "prepare") run.prepare = phase.at("seconds").number();
            if (phase.at("name").text() == "render") run.render = phase.at("seconds").number();
        }
        return run;
    }

    const BenchHostsOptions& options_;
    const Launcher& launcher_;
    Loaded loaded_;
    Scratch scratch_;
    Hash picture_{};
};

void print_table(std::ostream& out, const std::vector<HostsRow>& rows) {
    const auto prepare = [](const HostsRun& run) { return run.prepare; };
    const auto render = [](const HostsRun& run) { return run.render; };
    const auto both = [](const HostsRun& run) { return run.both(); };
    constexpr double cells_per_host = 4;
    fmt::print(out,
               "hosts  prepare   render     both  speed-up  of ideal  (o: as many times quicker as there are hosts)\n");
    for (const auto& row : rows) {
        const double speed_up = rows.front().median(both) / row.median(both);
        const auto bar = static_cast<std::size_t>(speed_up * cells_per_host + 0.5);
        const auto ideal = static_cast<std::size_t>(row.hosts * cells_per_host);
        std::string curve(std::max(bar, ideal) + 1, ' ');
        std::fill_n(curve.begin(), bar, '#');
        curve[ideal] = 'o';
        fmt::print(out, "{:5} {:6.2f} s {:6.2f} s {:6.2f} s {:9.2f} {:7.0f} %  {}\n", row.hosts, row.median(prepare),
                   row.median(render), row.median(both), speed_up, 100 * speed_up / row.hosts, curve);
    }
}

constexpr std::string_view csv_beginning = "hosts,round,prepare_seconds,render_seconds\n";

std::string csv_of(const std::vector<HostsRow>& rows) {
    std::string text(csv_beginning);
    for (const auto& row : rows)
        for (std::size_t round = 0; round < row.runs.size(); ++round)
            text += fmt::format("{},{},{},{}\n", row.hosts, round + 1, row.runs[round].prepare, row.runs[round].render);
    return text;
}

int bench_hosts(const BenchHostsOptions& options, const Launcher& launcher) {
    if (const auto why = options.csv.empty() ? "" : why_not_replaced(options.csv, csv_beginning); !why.empty())
        throw UserError({options.csv, 0}, why);
    HostsBench bench(options, launcher);
    auto rows = rows_up_to(bench.most());
    for (std::uint32_t round = 0; round < options.rounds; ++round)
        for (auto& row : rows) row.runs.push_back(bench.run(row.hosts));
    print_table(launcher.out, rows);
    fmt::print(launcher.out, "median of {} runs each, in turns; all pictures have the same bytes\n", options.rounds);
    if (!options.csv.empty()) write_file(options.csv, csv_of(rows));
    return 0;
}

}  // namespace

Verb bench_hosts_verb() {
    return verb<BenchHostsOptions>("bench-hosts", "measure how much quicker a graph becomes with more hosts",
                                   describe_bench_hosts, bench_hosts);
}

}  // namespace lightnet
