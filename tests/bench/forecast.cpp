// Forecasts beside runs: layouts of one network, the best, the worst and others by chance, are foreseen from the report
// of one small run, as `lightnet predict` does, and then run by `lightnet` on daemons of different speed.
//
// `waiting`: nodes wait instead of computing, so that two cores can be a dozen processors. `computing`: the network of
// the paper's figure 5 on three daemons that may use parts of this machine's processors.
// Arguments: one of these; and the seed of networks and layouts, which else follows from the commit.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <memory>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/allowance.hpp"
#include "core/base/json.hpp"
#include "core/base/math/random.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/daemon.hpp"
#include "tests/bench/emulated_kinds.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/judge.hpp"
#include "tests/bench/processor_group.hpp"
#include "tests/support/folder.hpp"
#include "tools/forecast/forecast_curve.hpp"
#include "tools/forecast/recorded_run.hpp"
#include "transport/start/child.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

/// A daemon, and how quick each of its places is.
struct SpeedyDaemon {
    std::unique_ptr<ProcessorGroup> group;  // outlives who is in it
    std::unique_ptr<Daemon> daemon;
    std::uint32_t places = 1;
    double speed = 1, processors = 0;  // 0: one for each place
};

/// What is laid out, and where.
struct Trial {
    std::string graph;                   // a file
    std::vector<std::string> operators;  // and an image
    std::vector<std::string> words;      // of each run
    std::string small;                   // size of the picture that is recorded, "128x128"
    std::string size;                    // of the one that is foreseen
    std::deque<SpeedyDaemon> hosts;
};

/// By host: which of its nodes it holds; the image is the last.
using Layout = std::vector<std::vector<bool>>;

std::string hosts_file(const Trial& trial, const Layout& layout) {
    std::string text;
    for (std::size_t host = 0; host < layout.size(); ++host) {
        std::string held;
        for (std::size_t node = 0; node < layout[host].size(); ++node)
            if (layout[host][node])
                held += fmt::format(" {} = {},", node < trial.operators.size() ? trial.operators[node] : "image",
                                    trial.hosts[host].places);
        if (!held.empty())
            text += fmt::format("place \"{}\" {{ places = {},{} }}\n", trial.hosts[host].daemon->endpoint(),
                                trial.hosts[host].places, held);
    }
    return text;
}

std::string words_for(const Trial& trial, const Layout& layout) {
    std::string text;
    for (const auto& held : layout) {
        text += &held == &layout.front() ? "" : " | ";
        for (std::size_t node = 0; node < held.size(); ++node)
            if (held[node]) text += (node < trial.operators.size() ? trial.operators[node] : "image") + " ";
    }
    return text;
}

bool covers(const Layout& layout) {
    for (std::size_t node = 0; node < layout.front().size(); ++node)
        if (std::none_of(layout.begin(), layout.end(), [&](const auto& held) { return held[node]; })) return false;
    return true;
}

std::vector<Layout> layouts_by_chance(const Trial& trial, std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::set<Layout> seen;
    std::vector<Layout> layouts;
    for (int tries = 0; layouts.size() < count && tries < 100000; ++tries) {
        Layout layout(trial.hosts.size(), std::vector<bool>(trial.operators.size() + 1));
        for (auto& held : layout)
            for (std::size_t node = 0; node < held.size(); ++node) held[node] = random() >> 40 & 1;
        if (covers(layout) && seen.insert(layout).second) layouts.push_back(layout);
    }
    return layouts;
}

/// Seconds of a run, by its report; without waiting for hosts to be there.
struct Phases {
    double all = 0, load = 0, prepare = 0, render = 0, write = 0;
};

Phases phases_in(const std::string& report) {
    std::ostringstream text;
    text << std::ifstream(report).rdbuf();
    Phases phases;
    const auto json = parse_json(text.str());
    for (const auto& phase : json.at("phases").list()) {
        const auto& name = phase.at("name").text();
        const double seconds = phase.at("seconds").number();
        if (name != "gather") phases.all += seconds;
        if (name == "load") phases.load = seconds;
        if (name == "prepare") phases.prepare = seconds;
        if (name == "render") phases.render = seconds;
        if (name == "write") phases.write = seconds;
    }
    return phases;
}

// Its report.
std::string run_of(const Trial& trial, const test::Folder& folder, const std::vector<std::string>& more,
                   const std::string& size) {
    std::vector<std::string> words{LIGHTNET_STARTS_LIGHTNET,
                                   "run",
                                   trial.graph,
                                   "--cache",
                                   "none",
                                   "--progress",
                                   "none",
                                   "-o",
                                   folder.file("made.exr"),
                                   "-D",
                                   "width=" + size.substr(0, size.find('x')),
                                   "-D",
                                   "height=" + size.substr(size.find('x') + 1)};
    words.insert(words.end(), trial.words.begin(), trial.words.end());
    words.insert(words.end(), more.begin(), more.end());
    const auto output = run_program(words, "", 10min);
    if (output.code != 0) throw std::runtime_error(output.text);
    return folder.file("made.run.json");
}

/// Foresees layouts from one recorded run.
class Foresight {
public:
    Foresight(const Trial& trial, const Registry& registry, const test::Folder& folder)
        : trial_(trial),
          registry_(registry),
          folder_(folder),
          recorded_(read_recorded_run(run_of(trial, folder, {"--threads", "2"}, trial.small), registry)),
          costs_(recorded_.costs) {
        OtherPicture other;
        other.width = std::uint32_t(std::stoul(trial.size));
        other.height = std::uint32_t(std::stoul(trial.size.substr(trial.size.find('x') + 1)));
        costs_ = scaled(costs_, other);
        for (const auto node : costs_.order)
            std::printf("  forecast: %s takes %.3g us\n", costs_.nodes[node].name.c_str(),
                        1e6 * costs_.nodes[node].seconds);
    }

    Forecast of(const Layout& layout) const {
        ForecastHostsOptions said;
        said.hosts = {folder_.write("foreseen.lua", hosts_file(trial_, layout))};
        said.line = "10Gbit,0.05ms";
        const auto line = line_called(said.line, {}).value();
        for (std::size_t host = 0; host < layout.size(); ++host) {
            if (std::find(layout[host].begin(), layout[host].end(), true) == layout[host].end()) continue;
            const auto& [group, daemon, places, speed, processors] = trial_.hosts[host];
            said.speeds.push_back(fmt::format("{}={}", daemon->endpoint(), speed));
            if (processors > 0) said.processors.push_back(fmt::format("{}={}", daemon->endpoint(), processors));
        }
        return foreseen_on(crew_called(said), recorded_, costs_, line, registry_).what;
    }

private:
    const Trial& trial_;
    const Registry& registry_;
    const test::Folder& folder_;
    RecordedRun recorded_;
    RunCosts costs_;
};

/// The best and the worst of many, and some of the others.
std::vector<Layout> chosen_of(const std::vector<Layout>& many, const Foresight& foresight, std::size_t count) {
    std::vector<double> seconds;
    for (const auto& layout : many) seconds.push_back(foresight.of(layout).seconds);
    const auto best = std::size_t(std::min_element(seconds.begin(), seconds.end()) - seconds.begin());
    const auto worst = std::size_t(std::max_element(seconds.begin(), seconds.end()) - seconds.begin());
    std::vector<Layout> chosen{many[best]};
    if (count > 1) chosen.push_back(many[worst]);
    for (std::size_t i = 0; i < many.size() && chosen.size() < count; ++i)
        if (i != best && i != worst) chosen.push_back(many[i]);
    return chosen;
}

void compare(const std::string& name, const Trial& trial, const Registry& registry, const test::Folder& folder,
             std::uint64_t seed) {
    const Foresight foresight(trial, registry, folder);
    const auto count = sized<std::size_t>(30, 2);
    const auto layouts = chosen_of(layouts_by_chance(trial, sized<std::size_t>(200, 4), seed), foresight, count);
    std::vector<double> foreseen, found, errors;
    for (const auto& layout : layouts) {
        const auto what = foresight.of(layout);
        const auto phases = phases_in(
            run_of(trial, folder, {"--hosts", folder.write("layout.lua", hosts_file(trial, layout))}, trial.size));
        foreseen.push_back(what.seconds), found.push_back(phases.all);
        errors.push_back(std::abs(what.seconds / phases.all - 1));
        std::printf(
            "  %s: %.3f s foreseen, %.3f found (%+.1f %%); to load %.3f, %.3f; to prepare %.3f, %.3f; to render %.3f, "
            "%.3f; to write %.3f, %.3f; %s\n",
            name.c_str(), what.seconds, phases.all, 100 * (what.seconds / phases.all - 1), what.load, phases.load,
            what.prepare, phases.prepare, what.render, phases.render, what.write, phases.write,
            words_for(trial, layout).c_str());
        std::fflush(stdout);
    }
    show((name + "_errors").c_str(), errors);
    figure(name + "_rank", {rank_correlation(foreseen, found)}, 0.9, true);
    figure(name + "_error", {part_below(errors, 0.9)}, 0.05, false);
}

// ---- nodes that wait ------------------------------------------------------------------------------------------------

// Each operator asks some of those before it; the image asks the last.
std::string waiting_graph(std::mt19937_64& random, std::size_t operators) {
    const auto part = [&] { return double(random() >> 11) * 0x1p-53; };
    std::string text = fmt::format("width, height = 512, 512\nscene = Scene {{ \"{}/graphs/cornell_box.pbrt\" }}\n",
                                   LIGHTNET_SOURCE_DIR);
    for (std::size_t node = 0; node < operators; ++node) {
        text += fmt::format("op{} = EmulatedLight {{ ", node);
        for (std::size_t to = 0; to < node; ++to)
            if (to + 1 == node || part() < 0.4) text += fmt::format("op{}, ", to);
        text += fmt::format("microseconds = {:.2f} }}\n", 12 * std::pow(4, part()));
    }
    return text +
           fmt::format(
               "image = EmulatedImage {{ op{}, scene = scene, milliseconds = 20, questions = 1024, samples = 16, "
               "film = {{ "
               "width, height }} }}\n",
               operators - 1);
}

void measure_waiting(std::uint64_t seed) {
    const test::Folder folder;
    std::mt19937_64 random(seed);
    Trial trial;
    const auto graph = waiting_graph(random, 4);
    std::printf("%s", graph.c_str());
    trial.graph = folder.write("waiting.lua", graph);
    for (int node = 0; node < 4; ++node) trial.operators.push_back("op" + std::to_string(node));
    trial.words = {"--plugin", LIGHTNET_STARTS_WAITING};
    trial.small = sized("256x128", "64x64"), trial.size = sized("512x512", "64x64");
    for (const auto& [places, speed] : {std::pair{2U, 1.0}, {1U, 2.0}, {1U, 4.0}, {2U, 0.5}}) {
        auto& host = trial.hosts.emplace_back();
        host.places = places, host.speed = speed;
        host.daemon = std::make_unique<Daemon>(
            LIGHTNET_STARTS_LIGHTNETD, places, folder.file("cache" + std::to_string(trial.hosts.size())),
            std::vector<std::string>{"--plugin", LIGHTNET_STARTS_WAITING},
            std::vector<std::string>{fmt::format("LIGHTNET_WAITING_SPEED={}", speed)});
    }
    Registry registry{standard_nodes()};
    registry.add(emulated_kinds_with(nullptr, nullptr));
    compare("forecast.waiting", trial, registry, folder, seed);
}

// ---- nodes that compute ---------------------------------------------------------------------------------------------

void measure_computing(std::uint64_t seed) {
    const char* const name = "forecast.computing";
    const test::Folder folder;
    Trial trial;
    trial.graph = LIGHTNET_SOURCE_DIR "/graphs/paper/figure5.lua";
    trial.operators = {"direct", "caustics", "global", "soft", "first", "lighting"};
    trial.words = {"-D", std::string("samples=") + sized("16", "1")};
    trial.small = sized("128x128", "32x32"), trial.size = sized("256x256", "32x32");
    const double of_one = 0.875 * usable_cores() / 7;
    for (const std::uint32_t places : {4U, 2U, 1U}) {
        auto& host = trial.hosts.emplace_back();
        host.places = places, host.processors = of_one * places;
        const auto called = "host" + std::to_string(places);
        host.group = std::make_unique<ProcessorGroup>(called, of_one * places);
        if (!host.group->there())
            return not_run(name, "this system limits no process to a part of its processors (control groups)");
        host.daemon = std::make_unique<Daemon>(LIGHTNET_STARTS_LIGHTNETD, places, folder.file(called));
        host.group->take(host.daemon->process());
    }
    const Registry registry{standard_nodes()};
    compare(name, trial, registry, folder, seed);
}

std::uint64_t seed_of_commit() {
    const char* const commit = std::getenv("LIGHTNET_BENCH_COMMIT");
    return key_of(commit && *commit ? commit : "no commit") >> 24;
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    using namespace lightnet::bench;
    return run("forecast", [&] {
        std::uint64_t seed = seed_of_commit();
        std::string only;
        for (const auto& word : std::vector<std::string>(argv + 1, argv + argc))
            if (word == "waiting" || word == "computing")
                only = word;
            else
                seed = std::stoull(word, nullptr, 0);
        if (only != "computing") measure_waiting(seed);
        if (only != "waiting") measure_computing(seed);
    });
}
