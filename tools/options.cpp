#include "tools/options.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include "core/build_info.hpp"
#include "core/graph/graph_film.hpp"
#include "core/suggestion.hpp"
#include "tools/exit_code.hpp"
#include "transport/reach.hpp"

namespace lightnet {
namespace {

const std::vector<std::pair<std::string, Verb>> verbs{
    {"run", Verb::run},           {"render", Verb::render},    {"check", Verb::check}, {"dot", Verb::dot},
    {"describe", Verb::describe}, {"scene", Verb::scene_info}, {"hosts", Verb::hosts}};

std::optional<std::uint32_t> side_of(std::string_view text) {
    std::uint32_t side = 0;
    const auto [end, fault] = std::from_chars(text.begin(), text.end(), side);
    if (fault != std::errc{} || end != text.end() || side < 1 || side > longest_side) return std::nullopt;
    return side;
}

std::optional<PictureSize> size_of(std::string_view text) {
    const auto cross = text.find('x');
    if (cross == std::string_view::npos) return std::nullopt;
    const auto width = side_of(text.substr(0, cross)), height = side_of(text.substr(cross + 1));
    if (!width || !height) return std::nullopt;
    return PictureSize{*width, *height};
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
            "exit codes: 0 done, 1 the run failed, 2 usage, graph or scene error, 3 no worker reachable, "
            "130 interrupted");
        add_run();
        add_render();
        add_scene();
        add_check();
        add_dot();
        add_describe();
        add_hosts_verb();
    }

    std::variant<Options, Finished> parse(std::vector<std::string> arguments) {
        if (auto unknown = unknown_verb(arguments)) return *unknown;
        const std::vector<std::string> typed = arguments;
        std::reverse(arguments.begin(), arguments.end());  // so the library wants them
        try {
            app_.parse(arguments);
        } catch (const CLI::Success& done) {
            std::ostringstream out, err;
            app_.exit(done, out, err);
            return Finished{exit_code::done, out.str(), err.str()};
        } catch (const CLI::ExtrasError&) {
            return usage(unknown_argument(typed));
        } catch (const CLI::ParseError& error) {
            return usage(error.what());
        }
        for (const auto& [name, verb] : verbs)
            if (app_.got_subcommand(name)) options_.verb = verb;
        if (!options_.listen.empty() && !options_.insecure && !stays_on_this_machine(options_.listen))
            return usage(beyond_this_machine("--listen " + options_.listen));
        if (options_.slurm && options_.listen.empty())
            options_.listen = options_.insecure ? "tcp://0.0.0.0:*" : "tcp://127.0.0.1:*";
        return options_;
    }

private:
    static Finished usage(const std::string& what) {
        return {exit_code::usage, "", "lightnet: " + what + "\n" + "try: lightnet --help\n"};
    }

    // The library would only say that a verb is missing.
    std::optional<Finished> unknown_verb(const std::vector<std::string>& arguments) const {
        if (arguments.empty()) return Finished{exit_code::usage, "", app_.help()};
        if (arguments[0].starts_with('-')) return std::nullopt;
        std::vector<std::string> known;
        for (const auto& [name, verb] : verbs) known.push_back(name);
        if (std::find(known.begin(), known.end(), arguments[0]) != known.end()) return std::nullopt;
        return usage("there is no verb '" + arguments[0] + "'" + did_you_mean(arguments[0], known));
    }

    std::string unknown_argument(const std::vector<std::string>& typed) const {
        const auto chosen = app_.get_subcommands();
        const CLI::App& verb = chosen.empty() ? app_ : *chosen.front();
        std::vector<std::string> known;
        for (const auto* option : verb.get_options())
            for (const auto& name : option->get_lnames()) known.push_back("--" + name);
        for (const auto& argument : typed) {
            const std::string name = argument.substr(0, argument.find('='));
            if (name.starts_with("--") && std::find(known.begin(), known.end(), name) == known.end())
                return "there is no option '" + name + "'" + did_you_mean(name, known);
        }
        const auto left = app_.remaining(true);
        return "what is '" + (left.empty() ? std::string() : left.front()) + "' for?";
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

    CLI::Option* add_threads(CLI::App& verb) {
        return verb.add_option("--threads", options_.threads, "places in this process")
            ->type_name("N")
            ->check(CLI::Range(1, 1024));
    }

    void add_picture(CLI::App& verb) {
        verb.add_option("--samples", options_.samples, "samples per pixel, instead of the graph's")
            ->type_name("N")
            ->check(CLI::PositiveNumber);
        verb.add_option_function<std::string>(
                "--size", [this](const std::string& text) { options_.size = size_of(text); },
                "size of the picture, instead of the graph's")
            ->type_name("WxH")
            ->check([](const std::string& text) { return size_of(text) ? "" : "a size is like 640x480, not " + text; });
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
        verb.add_option("--exposure", options_.exposure, "how many times the picture becomes twice as bright")
            ->type_name("STOPS");
        verb.add_flag("--two-sided", options_.two_sided, "no surface is black from behind, as Mitsuba's may be");
        add_constants_option(verb, "define a variable of the scene file, or a constant of GRAPH.lua (may be repeated)");
        add_running(verb);
        verb.add_option("-o,--output", options_.output, "the picture, instead of the scene's name with .exr here")
            ->type_name("OUT.exr");
    }

    void add_scene() {
        CLI::App& verb = *app_.add_subcommand("scene", "look at scene files");
        verb.require_subcommand(1);
        CLI::App& info = *verb.add_subcommand("info", "tell what is in a scene file, and what of it is not supported");
        info.add_option("FILE", options_.scene, "the scene file")->required();
        add_constants_option(info, "define a variable of the scene file (may be repeated)");
    }

    // What all verbs that make a picture take.
    void add_running(CLI::App& verb) {
        add_picture(verb);
        add_hosts(verb);
        add_threads(verb);
        add_helpers(verb);
        verb.add_option("--seed", options_.seed, "root of all random numbers")
            ->type_name("N")
            ->check(CLI::NonNegativeNumber);  // or -1 would be a very large number
        verb.add_option_function<std::string>(
                "--progress", [this](const std::string& text) { options_.progress = *progress_mode(text); },
                "how progress is shown")
            ->type_name("auto|bar|plain|json|none")
            ->check(CLI::IsMember({"auto", "bar", "plain", "json", "none"}));
        verb.add_option("--preview", options_.preview, "write the picture so far from time to time")
            ->type_name("SECONDS")
            ->check(CLI::PositiveNumber);
        verb.add_flag("--resume", options_.resume,
                      "go on from the checkpoint beside the picture, if there is one; of a finished picture, to more "
                      "samples");
        verb.add_flag("--forget", options_.forget,
                      "leave no checkpoint beside a finished picture, so that no samples can be added to it");
        verb.add_flag("--check-answers", options_.check_answers,
                      "ask wrapped classes some questions twice, and compare all that is answered twice, bit by bit");
        add_tuning(verb);
    }

    // Where the places come from; all of these go together.
    void add_helpers(CLI::App& verb) {
        verb.add_option("--local-workers", options_.local_workers, "daemons to start on this machine")
            ->type_name("N")
            ->check(CLI::Range(1, 1024));
        verb.add_option("--listen", options_.listen, "where lightnetd --join may join, even in the middle of the run")
            ->type_name("tcp://HOST:PORT");
        verb.add_option("--pass", options_.pass,
                        "file with what a host must know to join (default: ~/.config/lightnet/pass, made when missing)")
            ->type_name("FILE");
        verb.add_flag("--insecure", options_.insecure,
                      "reach beyond this machine, unencrypted, on a network that is yours alone");
        verb.add_option("--wait", options_.wait, "seconds to wait for a host when a node has no place any more")
            ->type_name("SECONDS")
            ->check(CLI::Range(0, 864000))
            ->capture_default_str();
        auto* const slurm = verb.add_option("--slurm", options_.slurm, "daemons to start as a job array of Slurm")
                                ->type_name("N")
                                ->check(CLI::Range(1, 10000));
        verb.add_option("--partition", options_.partition, "of Slurm")->type_name("P")->needs(slurm);
        verb.add_option("--slurm-args", options_.slurm_arguments, "more words for sbatch, in one")->needs(slurm);
    }

    // The picture does not depend on any of these.
    void add_tuning(CLI::App& verb) {
        auto& tuning = options_.tuning;
        const auto add = [&](const char* name, std::uint32_t& value, int least, int most, const char* help) {
            verb.add_option(name, value, help)->type_name("N")->check(CLI::Range(least, most))->group("Tuning");
        };
        add("--tile", tuning.tile, 1, 256, "pixels along a side of a tile");
        add("--bundle", tuning.bundle, 1, 65536, "questions in a full bundle");
        add("--credit", tuning.credit, 1, 1024, "bundles under way to one place, per node asked");
        add("--checkpoint", tuning.checkpoint, 1, 86400, "seconds between two checkpoints");
        verb.add_option("--cache", tuning.cache, "where what nodes prepare is kept from run to run; 'none': nowhere")
            ->type_name("FOLDER")
            ->group("Tuning");
        verb.add_option("--cache-size", tuning.cache_size, "bytes that the cache may keep, like 500M")
            ->type_name("SIZE")
            ->default_str("4G")
            ->transform(CLI::AsSizeValue(false).description(""))
            ->group("Tuning");
        add("--spare-fibers", tuning.spare_fibers, 0, 4096, "fibers of a place beside one per node");
        add("--side-fibers", tuning.side_fibers, 0, 8192, "fibers of a place for questions that wrapped code asks");
    }

    void add_check() {
        CLI::App& verb = *app_.add_subcommand("check", "find everything that is wrong with a graph");
        add_graph(verb);
        add_picture(verb);
        add_hosts(verb);
    }

    void add_dot() {
        CLI::App& verb = *app_.add_subcommand("dot", "draw a graph, in the language of Graphviz");
        add_graph(verb);
        auto* const hosts = add_hosts(verb);
        add_threads(verb)->excludes(hosts);
        verb.add_option("--pictures", options_.pictures, "a picture of this graph: each node shows what it gave to it")
            ->type_name("PICTURE.exr");
    }

    void add_describe() {
        CLI::App& verb = *app_.add_subcommand("describe", "list the kinds of nodes, or tell all of one");
        verb.add_option("KIND", options_.kind, "the kind to tell of");
    }

    void add_hosts_verb() {
        CLI::App& verb = *app_.add_subcommand("hosts", "tell how daemons are, and what their machines are like");
        verb.add_option("WHOM", options_.whom, "hosts files, endpoints of daemons, or that of a launcher (--listen)")
            ->required();
    }

    CLI::App app_;
    Options options_;
};

}  // namespace

std::variant<Options, Finished> parse_options(const std::vector<std::string>& arguments) {
    return Grammar().parse(arguments);
}

}  // namespace lightnet
