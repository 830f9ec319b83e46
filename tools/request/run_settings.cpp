#include "tools/request/run_settings.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <system_error>
#include <variant>

#include "core/base/build_info.hpp"
#include "core/base/hash.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "core/network/graph/plugin_use.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/assembly/fingerprint.hpp"

namespace lightnet {
namespace {

const char* name_of(Mode mode) {
    return mode == Mode::serial ? "serial" : mode == Mode::threads ? "threads" : "network";
}

}  // namespace

FilmFormat film_format(const RunRequest& request, const Registry& registry) {
    const auto film = film_of(request.graph, registry);
    const auto sampling = sampling_of(request.graph, registry);
    const auto layers = layers_of(request.graph, registry);
    FilmFormat format{film.width, film.height, layers.film, sampling.samples, film.crop};
    format.refinement = {sampling.noise, sampling.least_samples};
    format.shown = shown_names(layers, request.graph);
    format.alpha = layers.alpha;
    format.storage = film.storage;
    for (std::size_t i = 0; i < layers.shown.size(); ++i) {
        const Node& node = request.graph.nodes[layers.shown[i]];
        const auto& light = registry.find(node.kind)->light;
        if (light.facts) format.facts.insert(node.name);
        if (light.letters)
            if (const auto letters = light.letters(node); letters != usual_letters) format.letters[node.name] = letters;
        if (layers.ids[i]) format.ids[node.name] = layers.ids[i];
    }
    format.gains = one_for_each(film.gains, layers.film);
    return format;
}

namespace {

// What the kinds of its nodes are from, and what reads its scene.
std::set<std::string> plugins_of(const RunRequest& request, const Registry& registry) {
    auto plugins = plugins_of(request.graph, registry);
    const auto* format = scene_format_of(request.scene);
    if (format && !format->plugin.empty()) plugins.insert(format->plugin);
    return plugins;
}

}  // namespace

Job make_job(const RunRequest& request, const Registry& registry, const FilmFormat& format, DiskFiles& files) {
    Job job;
    job.graph = request.graph;
    job.scene = request.scene;
    for (const auto& [path, hash] : files.hashes()) job.files.push_back({path, hash, files.seen().at(path)->size()});
    job.seed = request.seed;
    job.isa = usual_isa();
    job.width = format.width, job.height = format.height;
    job.tuning = request.tuning;
    const auto plugins = plugins_of(request, registry);
    job.plugins = {plugins.begin(), plugins.end()};
    return job;
}

RunReport first_page(const RunRequest& request, const Registry& registry, const FilmFormat& film) {
    RunReport report;
    report.graph = request.graph.file;
    report.graph_hash = to_hex(content_hash(to_json(request.graph)));
    report.network = to_json(written(request.graph));
    std::error_code ignored;
    report.folder = std::filesystem::current_path(ignored).string();
    report.mode = name_of(request.mode);
    report.versions["lightnet"] = build_id();
    for (const auto& plugin : plugins_of(request, registry))
        report.versions["plugin " + plugin.substr(0, plugin.find(' '))] = plugin;
    report.settings["samples"] = std::to_string(film.samples);
    report.settings["size"] = fmt::format("{}x{}", film.width, film.height);
    if (const auto& crop = film.crop)
        report.settings["crop"] =
            fmt::format("{},{},{},{}", crop->x, crop->y, crop->x + crop->width, crop->y + crop->height);
    if (film.adaptive()) report.settings["noise"] = fmt::format("{}", film.refinement.noise);
    if (const auto gains = film_of(request.graph, registry).gains; !gains.empty()) {
        auto& text = report.settings["gains"];
        for (const auto& gain : gains) text += (text.empty() ? "" : " ") + to_string(gain);
    }
    if (const auto& [name, trials] = request.lighting; !name.empty()) {
        report.settings["lighting"] = name;
        if (!trials.empty()) report.settings["lighting_trials"] = trials;
    }
    report.settings["seed"] = std::to_string(request.seed);
    for (const auto& knob : knobs)
        if (knob.by == Knob::By::users) report.settings[knob.name] = text_of(request.tuning, knob);
    report.settings["verify"] = fmt::format("{}", request.tuning.verify / 1e6);
    for (const auto& warning : irreproducible_nodes(request.graph, registry))  // said already, when it was checked
        report.warnings.push_back(to_string(warning));
    return report;
}

}  // namespace lightnet
