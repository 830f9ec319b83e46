// lightnet explain: tells how a pixel of a picture came about.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <ostream>
#include <set>

#include "core/base/error.hpp"
#include "core/base/own_files.hpp"
#include "core/base/suggestion.hpp"
#include "core/film/png.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/explain/explanation_json.hpp"
#include "tools/explain/explanation_text.hpp"
#include "tools/explain/past_run.hpp"
#include "tools/explain/path_picture.hpp"
#include "tools/explain/pixel_account.hpp"
#include "tools/pictures/remix.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/run_report.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct ExplainOptions {
    std::string picture, report, paths, at;
    std::vector<std::uint32_t> pixel;
    std::optional<std::uint32_t> sample;
    std::optional<std::uint32_t> most;
    bool json = false;
};

void describe_explain(CLI::App& verb, ExplainOptions& options) {
    verb.add_option("IMAGE", options.picture, "a picture that lightnet has rendered")
        ->required()
        ->type_name("IMAGE.exr");
    verb.add_option("PIXEL", options.pixel, "column and row, from 0,0 in the upper left corner")
        ->required()
        ->delimiter(',')
        ->type_size(2)
        ->expected(1)
        ->type_name("X,Y");
    takes_numbers(verb.add_option("--sample", options.sample, "tell of this sample alone"), "N", 0, 0xffffffff);
    takes_numbers(verb.add_option("--most", options.most, "tell of so many samples, the brightest first (default: 4)"),
                  "N", 0, 0xffffffff)
        ->excludes(verb.get_option("--sample"));
    verb.add_flag("--json", options.json, "print JSON");
    verb.add_option("--paths", options.paths, "draw the rays of these samples over the picture")->type_name("FILE.png");
    verb.add_option("--at", options.at, "print the questions that this node was asked, one line of JSON for each")
        ->type_name("NODE")
        ->excludes(verb.get_option("--json"));
    verb.add_option("--report", options.report, "the report of its run, where it isn't beside the picture")
        ->type_name("FILE.run.json");
    verb.footer(
        "The samples of the pixel are computed again, alone, and must give the bits of the picture.\n"
        "Exit codes: 0 they do, 1 they don't, 2 the picture or its report can't be used.\n\n"
        "Examples:\n"
        "  lightnet explain cornell.exr 120,200 --paths paths.png\n"
        "  lightnet explain cornell.exr 120,200 --sample 17 --json\n"
        "  lightnet explain cornell.exr 120,200 --at direct");
}

// What was asked for of the samples.
void choose(PixelAccount& account, const ExplainOptions& options) {
    if (!options.sample) return;
    if (*options.sample >= account.samples)
        throw UserError({"--sample", 0}, "the pixel has samples 0 to " + std::to_string(account.samples - 1));
    std::erase_if(account.parts, [&](const auto& part) { return part.sample != *options.sample; });
}

void check_node(const std::string& name, const Graph& graph) {
    if (name.empty() || graph.find(name)) return;
    std::vector<std::string> names;
    for (const auto& node : graph.nodes) names.push_back(node.name);
    throw UserError({"--at", 0}, "the graph has no node '" + name + "'" + did_you_mean(name, names));
}

void print_questions(const PixelAccount& account, const std::string& node, std::ostream& out) {
    const auto& graph = account.network->graph;
    std::vector<const ExplainedSample*> in_order;
    for (const auto& part : account.parts) in_order.push_back(&part);
    std::sort(in_order.begin(), in_order.end(), [](auto a, auto b) { return a->sample < b->sample; });
    for (const auto* part : in_order)
        for (const auto& asked : part->account.questions)
            if (graph.nodes[asked.asked].name == node) out << question_line(asked, graph);
}

// Which colour is whose.
std::string legend_of(const PixelAccount& account) {
    const auto& graph = account.network->graph;
    std::string text = graph.nodes[renderer_of(graph, account.network->registry)].name + " white";
    std::set<std::size_t> tracing;
    for (const auto& part : account.parts)
        for (const auto& ray : part.account.rays)
            if (ray.within != AskedQuestion::nobody) tracing.insert(part.account.questions[ray.within].asked);
    for (const auto node : tracing) text += ", " + graph.nodes[node].name + " " + path_colour(node).name;
    return text;
}

int explain(const ExplainOptions& options, const Launcher& launcher) {
    if (!options.paths.empty()) expect_ours(options.paths, png_beginning);
    const Picture picture = read_layers(options.picture);
    const auto report = options.report.empty() ? report_beside(options.picture) : std::filesystem::path(options.report);
    const PastRun past = read_past_run(report, launcher.registry);
    check_node(options.at, past.graph);
    PixelAccount account = account_for(picture, past, options.pixel[0], options.pixel[1], launcher.registry);
    choose(account, options);
    const std::size_t most = options.most.value_or(4);
    if (!options.at.empty())
        print_questions(account, options.at, launcher.out);
    else if (options.json)
        launcher.out << explanation_json(account, options.picture, most);
    else
        launcher.out << explanation_text(account, options.picture, most);
    if (!options.paths.empty()) {
        write_png(options.paths, path_picture(picture, account, most));
        launcher.err << options.paths << ": " << legend_of(account) << ", dim: hidden\n";
    }
    if (account.equal.value()) return exit_code::done;
    launcher.err << "the samples don't give what " << options.picture << " has: its scene or the program has changed\n";
    return exit_code::failed;
}

}  // namespace

Verb explain_verb() {
    return verb<ExplainOptions>("explain", "tell how a pixel of a picture came about", describe_explain, explain);
}

}  // namespace lightnet
