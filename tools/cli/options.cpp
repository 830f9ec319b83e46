#include "tools/cli/options.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/network/graph/graph_film.hpp"
#include "core/readers/read_scene.hpp"
#include "tools/cli/trouble_options.hpp"
#include "tools/preview/tev_packets.hpp"
#include "tools/words/command_line.hpp"
#include "transport/wire/loopback.hpp"

namespace lightnet {
namespace {

// What ssh would take for an option of its own, or for nothing.
std::string mistake_in_ssh_host(const std::string& text) {
    const bool strange = text.empty() || text.front() == '-' || text.find_first_of(" \t\n") != std::string::npos;
    return strange ? "a machine is like onyx1 or anna@onyx1, not '" + text + "'" : "";
}

// Where the places come from; all of these go together.
void add_helpers(CLI::App& verb, RunningOptions& running) {
    takes_numbers(verb.add_option("--local-workers", running.local_workers, "daemons to start on this machine"), "N", 1,
                  1024);
    takes_endpoint(verb.add_option("--listen", running.listen,
                                   "where daemons may join (lightnetd --join), even in the middle of the run"),
                   true);
    verb.add_option("--key", running.key,
                    "file with our secret key (default: ~/.config/lightnet/key; lightnet key makes it)")
        ->type_name("FILE");
    verb.add_option("--allow", running.allow,
                    "let only hosts join whose keys are in this file (one a line, and a name behind it; read again "
                    "when it changes), or that have this public key")
        ->type_name("FILE|KEY");
    verb.add_option("--pass", running.pass,
                    "file with what a host must know to join (default: ~/.config/lightnet/pass, made when missing)")
        ->type_name("FILE");
    verb.add_flag("--insecure", running.insecure,
                  "reach beyond this machine without keys, unencrypted, on a network that is yours alone");
    takes_numbers(
        verb.add_option("--wait", running.wait,
                        "seconds to wait for a host to come, for a busy one to be free (if not given: as long "
                        "as it takes), or for a disk to take the picture"),
        "SECONDS", 0, 864000)
        ->default_str("30");
    auto* const ssh = verb.add_option("--ssh", running.ssh,
                                      "start a daemon on each of these machines by ssh, for this run (may be repeated)")
                          ->type_name("[USER@]HOST,…")
                          ->expected(1)
                          ->allow_extra_args(false)
                          ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
                          ->delimiter(',')
                          ->check([](const std::string& text) { return mistake_in_ssh_host(text); });
    verb.add_option("--ssh-command", running.ssh_command, "the ssh to use, with its options, as one text")
        ->capture_default_str()
        ->needs(ssh);
    verb.add_option("--ssh-daemon", running.ssh_daemon,
                    "lightnetd on those machines (default: where it lies here, or else in the PATH there)")
        ->type_name("PATH")
        ->needs(ssh);
    auto* const slurm = takes_numbers(
        verb.add_option("--slurm", running.slurm, "daemons to start as a job array of Slurm"), "N", 1, 10000);
    verb.add_option("--partition", running.partition, "the partition of Slurm to use")->type_name("P")->needs(slurm);
    verb.add_option("--slurm-args", running.slurm_arguments, "further arguments for sbatch, as one text")->needs(slurm);
}

// None: it is no "tev", "tev:HOST" or "tev:HOST:PORT".
std::optional<WatchAddress> tev_of(std::string_view text) {
    if (!text.starts_with("tev")) return std::nullopt;
    text.remove_prefix(3);
    if (text.empty()) return viewer_address("", usual_tev_port);
    if (text.size() < 2 || text.front() != ':') return std::nullopt;
    return viewer_address(text.substr(1), usual_tev_port);
}

void add_watching(CLI::App& verb, RunningOptions& running) {
    verb.add_option_function<std::string>(
            "--watch", [&running](const std::string& text) { running.watch = watch_address(text); },
            "serve a page that shows the run while it goes, and say where (default: 127.0.0.1 and a free port)")
        ->type_name("[ADDRESS[:PORT]]")
        ->expected(0, 1)
        ->check([](const std::string& text) {
            return watch_address(text) ? ""
                                       : "the page is served at an address like 127.0.0.1:8080 or [::1]:8080, not at " +
                                             text + "; files stand before --watch";
        });
    verb.add_option("--report", running.report, "write a page that shows what the run did, as one file")
        ->type_name("FILE.html")
        ->check([](const std::string& text) {
            return text.ends_with(".html") ? "" : "a report is a file like run.html, not " + text;
        });
}

// "2%" or "0.02"; none: no part of a whole.
std::optional<std::uint32_t> millionths_of(const std::string& text) {
    const bool percent = text.ends_with('%');
    const char* const end = text.data() + text.size() - percent;
    double part = 0;
    const auto [rest, fault] = std::from_chars(text.data(), end, part);
    if (fault != std::errc{} || rest != end) return {};
    if (percent) part /= 100;
    if (!(part >= 0 && part <= 1)) return {};
    return static_cast<std::uint32_t>(std::lround(part * 1e6));
}

std::string mistake_in_preview(const std::string& text) {
    if (text == "tev" || text.starts_with("tev:"))
        return tev_of(text) ? "" : "tev is called at a name or address and a port, like tev:desk:14158, not at " + text;
    const auto seconds = amount_of(text);
    if (seconds && *seconds > 0) return {};
    return "must be a number above 0 (of seconds), or tev or tev:HOST:PORT, not '" + text + "'";
}

void add_preview(CLI::App& verb, RunningOptions& running) {
    verb.add_option_function<std::vector<std::string>>(
            "--preview",
            [&running](const std::vector<std::string>& given) {
                for (const auto& one : given)
                    if (const auto viewer = tev_of(one))
                        running.viewer = viewer;
                    else
                        running.preview = amount_of(one).value_or(0);
            },
            "write the picture so far, every so many seconds, or show it in the viewer tev (may be given for both)")
        ->type_name("SECONDS|tev[:HOST:PORT]")
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->check(mistake_in_preview);
}

// The picture does not depend on any of these.
void add_knob(CLI::App& verb, const std::string& flag, const Knob& knob, bool& value) {
    verb.add_flag(flag, value, knob.help)->group("Tuning");
}
void add_knob(CLI::App& verb, const std::string& flag, const Knob& knob, std::string& value) {
    verb.add_option(flag, value, knob.help)->type_name(knob.unit)->group("Tuning");
}
void add_knob(CLI::App& verb, const std::string& flag, const Knob& knob, std::uint32_t& value) {
    takes_numbers(verb.add_option(flag, value, knob.help), knob.unit, knob.least, knob.most)->group("Tuning");
}
void add_knob(CLI::App& verb, const std::string& flag, const Knob& knob, std::uint64_t& value) {
    verb.add_option(flag, value, knob.help)
        ->type_name(knob.unit)
        ->default_str(std::to_string(value >> 30) + "G")
        ->transform(CLI::AsSizeValue(false).description(""))
        ->group("Tuning");
}

void add_tuning(CLI::App& verb, Tuning& tuning) {
    for (const auto& knob : knobs) {
        if (knob.by != Knob::By::users) continue;
        std::string flag = std::string("--") + knob.name;
        std::replace(flag.begin(), flag.end(), '_', '-');
        std::visit([&](const auto& member) { add_knob(verb, flag, knob, tuning.*member); }, knob.member);
    }
}

}  // namespace

void add_graph(CLI::App& verb, GraphOptions& graph) {
    verb.add_option("GRAPH", graph.file, "the graph file; -: standard input")->required();
    add_constants(verb, graph.constants, "override a constant of the graph file (may be repeated)");
}

void add_constants(CLI::App& verb, std::map<std::string, std::string>& constants, const char* help) {
    const auto add = [&constants](const std::vector<std::string>& given) {
        for (const auto& one : given) {
            const auto equals = one.find('=');
            if (equals == std::string::npos || equals == 0)
                throw CLI::ValidationError("-D", "wants NAME=VALUE, not " + one);
            constants[one.substr(0, equals)] = one.substr(equals + 1);
        }
    };
    // one value each time, or it would take the graph's name as well
    verb.add_option_function<std::vector<std::string>>("-D", add, help)
        ->type_name("NAME=VALUE")
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

CLI::Option* add_hosts(CLI::App& verb, std::string& file) {
    return verb.add_option("--hosts", file, "the hosts file: where nodes run; or addresses, with commas between them")
        ->type_name("FILE");
}

void add_layout(CLI::App& verb, RunningOptions& running) {
    verb.add_option("--layout", running.layout,
                    "auto: deal the nodes out to --hosts by what they cost in a rehearsal, or in an earlier run")
        ->type_name("auto|auto=X.run.json");
    verb.add_option("--layout-out", running.layout_out, "write the layout as a hosts file")->type_name("FILE");
    verb.add_option("--layout-memory", running.layout_memory,
                    "what a host may keep of what nodes prepare, for all or NAME=16G (default: four fifths of what it "
                    "has)")
        ->type_name("SIZE");
}

CLI::Option* add_threads(CLI::App& verb, std::optional<std::uint32_t>& threads, const char* help) {
    return takes_numbers(verb.add_option("--threads", threads, help), "N", 1, 1024);
}

void add_running(CLI::App& verb, RunningOptions& running) {
    add_picture(verb, running.picture);
    add_hosts(verb, running.hosts);
    add_threads(verb, running.threads,
                "threads of this process that render; 1: serial (default: one per core, if no daemons are asked for)");
    add_helpers(verb, running);
    takes_numbers(verb.add_option("--seed", running.seed, "seed of all random numbers"), "N", 0,
                  std::numeric_limits<std::uint64_t>::max());
    add_png(verb, running.png,
            "leave out what surrounds the scene, and keep which part of each pixel is covered: as A in the EXR, and as "
            "the alpha of the PNG");
    verb.add_option("--camera", running.picture.camera, "one of several cameras of the scene's file")
        ->type_name("NAME|N");
    add_clean(verb, running.picture);
    takes_one_of(verb.add_option("--compression", running.picture.compression,
                                 "how the EXR is packed, instead of the graph's; all lose nothing"),
                 lossless_compressions());
    add_arrays(verb, running.arrays);
    add_gains(verb, "--gain", running.picture.gains, "times which a layer is in the picture (may be repeated)");
    verb.add_option_function<std::string>(
            "--progress", [&running](const std::string& text) { running.progress = *progress_mode(text); },
            "how progress is shown; none: nothing but errors")
        ->type_name("auto|bar|plain|json|none")
        ->check([](const std::string& text) {
            return progress_mode(text) ? "" : "must be auto, bar, plain, json or none, not '" + text + "'";
        });
    add_preview(verb, running);
    takes_amounts(verb.add_option("--time-limit", running.time_limit,
                                  "end after so many seconds, with as many samples in all pixels as there is time for; "
                                  "--resume goes on"),
                  "SECONDS", Least::above_zero);
    auto* const reference =
        verb.add_option("--reference", running.reference, "say how far the picture is from this one: EXR, HDR, PNG …")
            ->type_name("REFERENCE");
    verb.add_option("--csv", running.curve, "write the error over samples and seconds")
        ->type_name("FILE.csv")
        ->needs(reference);
    verb.add_option("--trace", running.trace, "write what every place was busy with, for Perfetto (ui.perfetto.dev)")
        ->type_name("FILE.json");
    add_watching(verb, running);
    verb.add_option_function<std::string>(
            "--verify", [&running](const std::string& text) { running.tuning.verify = *millionths_of(text); },
            "ask a second host for such a part of all answers, chosen at random, and compare; who has answered falsely "
            "is taken out, and the run begins anew")
        ->type_name("PART")
        ->check([](const std::string& text) {
            return millionths_of(text) ? "" : "a part of all answers is like 2% or 0.02, not " + text;
        });
    verb.add_flag("--resume", running.resume,
                  "continue from the checkpoint beside the picture, if there is one; a finished picture gets the "
                  "samples that it lacks");
    verb.add_flag("--forget", running.forget,
                  "leave no checkpoint beside a finished picture, so that no samples can be added to it");
    verb.add_flag("--memo", running.memo,
                  "keep what is rendered in the cache, and take from there what earlier runs with --memo have rendered "
                  "of the same: after a change of gains, exposure or files nothing is rendered, and more samples are "
                  "added to those that are there");
    add_troubles(verb, running.troubles);
    add_tuning(verb, running.tuning);
}

std::optional<std::string> settle(RunningOptions& running) {
    running.picture.alpha = running.png.alpha;
    if (running.memo && running.tuning.cache == "none") return "--memo keeps films in the cache, and --cache is 'none'";
    const bool safe = running.insecure || !running.allow.empty() || running.slurm ||
                      !running.ssh.empty();  // which have keys by themselves
    if (!running.listen.empty() && !safe && !stays_on_this_machine(running.listen))
        return beyond_this_machine("--listen " + running.listen,
                                   "say --allow FILE with the keys of hosts that may join");
    if (running.watch && !running.insecure && !running.watch->stays_here())
        return beyond_this_machine("--watch " + in_url(running.watch->host),
                                   "put a server with TLS in front of 127.0.0.1");
    if (running.viewer && !running.insecure && !running.viewer->stays_here())
        return beyond_this_machine("--preview tev:" + running.viewer->host,
                                   "let ssh carry it: ssh -R 14158:127.0.0.1:14158 from the viewer's machine");
    if (auto mistake = mistake_in(running.troubles, running.local_workers.value_or(0))) return mistake;
    if ((running.slurm || !running.ssh.empty()) && running.listen.empty()) running.listen = "tcp://*:*";
    return std::nullopt;
}

std::optional<std::string> mistaken_scene(const std::string& graph, const std::string& instead) {
    if (!is_named_like_a_scene(graph)) return std::nullopt;
    return "'" + graph + "' is a scene file, not a graph; " + instead + " " + graph;
}

std::optional<std::string> mistaken_graph(const std::string& scene, const std::string& instead) {
    if (!scene.ends_with(".lua")) return std::nullopt;
    return "'" + scene + "' is a graph file, not a scene; " + instead + " " + scene;
}

}  // namespace lightnet
