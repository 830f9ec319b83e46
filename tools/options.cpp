#include "tools/options.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <tuple>

#include "core/base/build_info.hpp"
#include "core/base/suggestion.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/readers/read_scene.hpp"
#include "tools/exit_code.hpp"
#include "transport/reach.hpp"

namespace lightnet {
namespace {

const std::vector<std::pair<std::string, Verb>> verbs{
    {"run", Verb::run},           {"render", Verb::render},    {"check", Verb::check}, {"dot", Verb::dot},
    {"describe", Verb::describe}, {"scene", Verb::scene_info}, {"hosts", Verb::hosts}, {"compare", Verb::compare}};

std::optional<PictureSize> size_of(std::string_view text) {
    PictureSize size;
    const auto cross = text.find('x');
    for (auto [part, side] : {std::pair{text.substr(0, cross), &size.width},
                              {text.substr(std::min(cross, text.size() - 1) + 1), &size.height}}) {
        const auto [end, fault] = std::from_chars(part.begin(), part.end(), *side);
        if (fault != std::errc{} || end != part.end() || *side < 1) return std::nullopt;
    }
    return size;
}

// What is wrong with a size; "": nothing.
std::string mistake_in_size(const std::string& text) {
    const auto size = size_of(text);
    if (!size) return "a size is like 640x480, not " + text;
    if (size->width <= longest_side && size->height <= longest_side) return {};
    return "a picture has at most " + std::to_string(longest_side) + " pixels along each side, not " + text;
}

std::optional<PictureCrop> crop_of(std::string_view text) {
    std::array<std::uint32_t, 4> edges{};
    const char* at = text.begin();
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (i > 0 && (at == text.end() || *at++ != ',')) return std::nullopt;
        const auto [end, fault] = std::from_chars(at, text.end(), edges[i]);
        if (fault != std::errc{}) return std::nullopt;
        at = end;
    }
    if (at != text.end()) return std::nullopt;
    return PictureCrop{edges[0], edges[1], edges[2], edges[3]};
}

/// The grammar of the command line, and what it fills.
class Grammar {
public:
    Grammar() : app_("A lighting network: one graph, serial, threaded or networked, the same picture.", "lightnet") {
        app_.set_version_flag("--version", "lightnet " + version());
        app_.require_subcommand(1);
        app_.footer(
            "exit codes: 0 done, 1 the run failed (or pictures are too far apart), 2 usage, graph or scene error,\n"
            "3 no worker reachable, 130 interrupted\n\nExamples:\n  lightnet run graphs/cornell.lua\n"
            "  lightnet help run");
        add_run();
        add_render();
        add_scene();
        add_check();
        add_dot();
        add_describe();
        add_hosts_verb();
        add_compare();
        app_.add_subcommand("help", "tell how a verb is used: lightnet help run");
    }

    std::variant<Options, Finished> parse(std::vector<std::string> words) {
        if (!words.empty() && words[0] == "help") words = help_words(words);
        if (auto unknown = unknown_verb(words)) return *unknown;
        if (auto finished = take_apart(app_, words)) return *finished;
        for (const auto& [name, verb] : verbs)
            if (app_.got_subcommand(name)) options_.verb = verb;
        if (auto mistake = mistaken_file()) return usage_error(app_, *mistake);
        if (!options_.listen.empty() && !options_.insecure && !stays_on_this_machine(options_.listen))
            return usage_error(app_, beyond_this_machine("--listen " + options_.listen));
        if (options_.slurm && options_.listen.empty())
            options_.listen = options_.insecure ? "tcp://0.0.0.0:*" : "tcp://127.0.0.1:*";
        return options_;
    }

private:
    // "help run" is "run --help".
    static std::vector<std::string> help_words(std::vector<std::string> words) {
        words.erase(words.begin());
        if (!words.empty() && words[0] == "help") words.clear();
        words.push_back("--help");
        return words;
    }

    // The library would only say that a verb is missing.
    std::optional<Finished> unknown_verb(const std::vector<std::string>& words) const {
        if (words.empty()) return Finished{exit_code::usage, "", app_.help()};
        const auto& word = words[0];
        if (word.starts_with('-')) return std::nullopt;
        std::vector<std::string> known{"help"};
        for (const auto& [name, verb] : verbs) known.push_back(name);
        if (std::find(known.begin(), known.end(), word) != known.end()) return std::nullopt;
        if (word.ends_with(".lua"))
            return usage_error(app_, "'" + word + "' is a graph file; to render it: lightnet run " + word);
        if (is_named_like_a_scene(word))
            return usage_error(app_, "'" + word + "' is a scene file; to render it: lightnet render " + word);
        return usage_error(app_, "there is no verb '" + word + "'" + did_you_mean(word, known));
    }

    // A scene file where a graph is wanted, or the other way round.
    std::optional<std::string> mistaken_file() const {
        const auto& [graph, scene] = std::tie(options_.graph, options_.scene);
        if (is_named_like_a_scene(graph))
            return "'" + graph + "' is a scene file, not a graph; " +
                   (options_.verb == Verb::run ? "to render it: lightnet render "
                                               : "to look at it: lightnet scene info ") +
                   graph;
        if (scene.ends_with(".lua"))
            return "'" + scene + "' is a graph file, not a scene; " +
                   (options_.verb == Verb::render ? "to render it: lightnet run " : "to look at it: lightnet check ") +
                   scene;
        return std::nullopt;
    }

    void add_graph(CLI::App& verb) {
        verb.add_option("GRAPH", options_.graph, "the graph file")->required();
        add_constants_option(verb);
    }

    void add_constants_option(CLI::App& verb,
                              const char* help = "override a constant of the graph file (may be repeated)") {
        // one value each time, or it would take the graph's name as well
        verb.add_option_function<std::vector<std::string>>(
                "-D", [this](const std::vector<std::string>& given) { add_constants(given); }, help)
            ->type_name("NAME=VALUE")
            ->expected(1)
            ->allow_extra_args(false)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    }

    void add_constants(const std::vector<std::string>& given) {
        for (const auto& one : given) {
            const auto equals = one.find('=');
            if (equals == std::string::npos || equals == 0)
                throw CLI::ValidationError("-D", "wants NAME=VALUE, not " + one);
            options_.constants[one.substr(0, equals)] = one.substr(equals + 1);
        }
    }

    CLI::Option* add_hosts(CLI::App& verb) {
        return verb.add_option("--hosts", options_.hosts, "the hosts file: where nodes run")->type_name("FILE");
    }

    CLI::Option* add_threads(CLI::App& verb, const char* help) {
        return takes_numbers(verb.add_option("--threads", options_.threads, help), "N", 1, 1024);
    }

    void add_picture(CLI::App& verb) {
        takes_numbers(verb.add_option("--samples", options_.samples, "samples per pixel, instead of the graph's"), "N",
                      1, std::numeric_limits<std::uint32_t>::max());
        verb.add_option_function<std::string>(
                "--size", [this](const std::string& text) { options_.size = size_of(text); },
                "size of the picture, instead of the graph's")
            ->type_name("WxH")
            ->check(mistake_in_size);
        verb.add_option_function<std::string>(
                "--crop", [this](const std::string& text) { options_.crop = crop_of(text); },
                "only this part of the picture, instead of the graph's: edges in pixels, from the upper left corner")
            ->type_name("X0,Y0,X1,Y1")
            ->check([](const std::string& text) {
                return crop_of(text) ? "" : "a crop is like 10,20,110,80 (left, top, right, bottom), not " + text;
            });
    }

    void add_run() {
        CLI::App& verb = *app_.add_subcommand("run", "render a graph");
        add_graph(verb);
        add_running(verb);
        verb.add_option("-o,--output", options_.output, "the picture, instead of the graph's")->type_name("OUT.exr");
        add_examples(verb, {"lightnet run graphs/cornell.lua --samples 16 -o cornell.exr",
                            "lightnet run graphs/cornell.lua --local-workers 2"});
    }

    void add_render() {
        CLI::App& verb = *app_.add_subcommand("render", "render a scene file as it is");
        verb.add_option("FILE", options_.scene, "the scene file")->required();
        verb.add_option("--lighting", options_.lighting,
                        "path: all light; direct: what comes straight from lamps; ao: how open a place is; or a graph "
                        "file, whose scene this one replaces")
            ->type_name("path|direct|ao|GRAPH.lua")
            ->capture_default_str();
        verb.add_option("--env", options_.environment,
                        "what is around the scene: a picture, or a colour like 1,0.9,0.8")
            ->type_name("FILE|COLOUR");
        verb.add_flag("--two-sided", options_.two_sided, "no surface is black from behind, as Mitsuba's may be");
        add_constants_option(verb, "define a variable of the scene file, or a constant of GRAPH.lua (may be repeated)");
        add_running(verb);
        verb.add_option("-o,--output", options_.output, "the picture, instead of the scene's name with .exr here")
            ->type_name("OUT.exr");
        add_examples(verb, {"lightnet render graphs/cornell_box.pbrt --size 256x256 --samples 16"});
    }

    void add_scene() {
        CLI::App& verb = *app_.add_subcommand("scene", "look at scene files");
        verb.require_subcommand(1);
        CLI::App& info = *verb.add_subcommand("info", "tell what is in a scene file, and what of it is not supported");
        info.add_option("FILE", options_.scene, "the scene file")->required();
        add_constants_option(info, "define a variable of the scene file (may be repeated)");
        for (auto* app : {&verb, &info}) add_examples(*app, {"lightnet scene info graphs/cornell_box.pbrt"});
    }

    // What all verbs that make a picture take.
    void add_running(CLI::App& verb) {
        add_picture(verb);
        add_hosts(verb);
        add_threads(verb, "places in this process; 1: serial (default: one per core, if no daemons are asked for)");
        add_helpers(verb);
        takes_numbers(verb.add_option("--seed", options_.seed, "root of all random numbers"), "N", 0,
                      std::numeric_limits<std::uint64_t>::max());
        verb.add_option("--exposure", options_.exposure, "exposure in stops: each makes the picture twice as bright")
            ->type_name("STOPS");
        verb.add_option_function<std::string>(
                "--progress", [this](const std::string& text) { options_.progress = *progress_mode(text); },
                "how progress is shown; none: nothing but errors")
            ->type_name("auto|bar|plain|json|none")
            ->check([](const std::string& text) {
                return progress_mode(text) ? "" : "must be auto, bar, plain, json or none, not '" + text + "'";
            });
        takes_amounts(verb.add_option("--preview", options_.preview, "write the picture so far from time to time"),
                      "SECONDS", Least::above_zero);
        verb.add_flag("--resume", options_.resume,
                      "go on from the checkpoint beside the picture, if there is one; of a finished picture, to more "
                      "samples");
        verb.add_flag("--forget", options_.forget,
                      "leave no checkpoint beside a finished picture, so that no samples can be added to it");
        add_tuning(verb);
    }

    // Where the places come from; all of these go together.
    void add_helpers(CLI::App& verb) {
        takes_numbers(verb.add_option("--local-workers", options_.local_workers, "daemons to start on this machine"),
                      "N", 1, 1024);
        takes_endpoint(verb.add_option("--listen", options_.listen,
                                       "where lightnetd --join may join, even in the middle of the run"),
                       true);
        verb.add_option("--pass", options_.pass,
                        "file with what a host must know to join (default: ~/.config/lightnet/pass, made when missing)")
            ->type_name("FILE");
        verb.add_flag("--insecure", options_.insecure,
                      "reach beyond this machine, unencrypted, on a network that is yours alone");
        takes_numbers(verb.add_option("--wait", options_.wait,
                                      "seconds to wait for a host to come, or for a disk to take the picture"),
                      "SECONDS", 0, 864000)
            ->capture_default_str();
        auto* const slurm = takes_numbers(
            verb.add_option("--slurm", options_.slurm, "daemons to start as a job array of Slurm"), "N", 1, 10000);
        verb.add_option("--partition", options_.partition, "of Slurm")->type_name("P")->needs(slurm);
        verb.add_option("--slurm-args", options_.slurm_arguments, "more words for sbatch, in one")->needs(slurm);
    }

    // The picture does not depend on any of these.
    void add_tuning(CLI::App& verb) {
        for (const auto& knob : knobs) {
            if (knob.by != Knob::By::users) continue;
            std::string flag = std::string("--") + knob.name;
            std::replace(flag.begin(), flag.end(), '_', '-');
            std::visit([&](const auto& member) { add_knob(verb, flag, knob, options_.tuning.*member); }, knob.member);
        }
    }
    static void add_knob(CLI::App& verb, const std::string& flag, const Knob& knob, bool& value) {
        verb.add_flag(flag, value, knob.help)->group("Tuning");
    }
    static void add_knob(CLI::App& verb, const std::string& flag, const Knob& knob, std::string& value) {
        verb.add_option(flag, value, knob.help)->type_name(knob.unit)->group("Tuning");
    }
    static void add_knob(CLI::App& verb, const std::string& flag, const Knob& knob, std::uint32_t& value) {
        takes_numbers(verb.add_option(flag, value, knob.help), knob.unit, knob.least, knob.most)->group("Tuning");
    }
    static void add_knob(CLI::App& verb, const std::string& flag, const Knob& knob, std::uint64_t& value) {
        verb.add_option(flag, value, knob.help)
            ->type_name(knob.unit)
            ->default_str(std::to_string(value >> 30) + "G")
            ->transform(CLI::AsSizeValue(false).description(""))
            ->group("Tuning");
    }

    void add_check() {
        CLI::App& verb = *app_.add_subcommand("check", "find everything that is wrong with a graph");
        add_graph(verb);
        add_picture(verb);
        add_hosts(verb);
        add_examples(verb, {"lightnet check graphs/figure5.lua"});
    }

    void add_dot() {
        CLI::App& verb = *app_.add_subcommand("dot", "print a graph as Graphviz DOT");
        add_graph(verb);
        auto* const hosts = add_hosts(verb);
        add_threads(verb, "show what places of one process hold")->excludes(hosts);
        verb.add_option("--pictures", options_.pictures, "a picture of this graph: each node shows what it gave to it")
            ->type_name("PICTURE.exr");
        add_examples(verb, {"lightnet dot graphs/figure8.lua | dot -Tsvg > figure8.svg"});
    }

    void add_describe() {
        CLI::App& verb = *app_.add_subcommand("describe", "list the kinds of nodes, or tell all of one");
        verb.add_option("KIND", options_.kind, "the kind to tell of");
        add_examples(verb, {"lightnet describe PhotonMap"});
    }

    void add_hosts_verb() {
        CLI::App& verb =
            *app_.add_subcommand("hosts", "tell the state and load of daemons, and what their machines are like");
        verb.add_option("WHOM", options_.whom, "hosts files, endpoints of daemons, or that of a launcher (--listen)")
            ->required();
        add_examples(verb, {"lightnet hosts tcp://127.0.0.1:7777"});
    }

    void add_compare() {
        CLI::App& verb = *app_.add_subcommand("compare", "tell how far pictures are from a reference");
        add_compare_options(verb, options_.compare);
    }

    CLI::App app_;
    Options options_;
};

}  // namespace

std::variant<Options, Finished> parse_options(const std::vector<std::string>& arguments) {
    return Grammar().parse(arguments);
}

}  // namespace lightnet
