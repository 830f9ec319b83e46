#include "tools/launcher.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <ostream>
#include <sstream>
#include <thread>

#include "core/network/graph/check_hosts.hpp"
#include "core/network/graph/check_params.hpp"
#include "core/network/graph/describe.hpp"
#include "core/network/graph/dot.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/layout.hpp"
#include "core/network/graph/plan.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/prepare/load_scene.hpp"
#include "lua/load_graph.hpp"
#include "tools/exit_code.hpp"
#include "tools/host_table.hpp"
#include "tools/loading.hpp"
#include "tools/node_pictures.hpp"
#include "tools/overrides.hpp"
#include "tools/render.hpp"
#include "tools/scene_info.hpp"
#include "transport/reach.hpp"

namespace lightnet {
namespace {

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

// Packets are for everybody to read who is in between.
void check_reach(const Options& options, const Hosts& hosts) {
    std::vector<Problem> problems;
    for (const auto& host : hosts.hosts)
        if (!options.insecure && address_of(host.endpoint) && !stays_on_this_machine(host.endpoint))
            problems.push_back({host.where, beyond_this_machine("'" + host.endpoint + "'")});
    if (!problems.empty()) throw UserError(std::move(problems));
}

RunRequest request_of(const Options& options, const Registry& registry, Loaded loaded) {
    check_reach(options, loaded.hosts);
    RunRequest request;
    request.scene = scene_file(loaded.graph, registry);
    request.output = output_file(loaded.graph, registry, options);
    request.graph = std::move(loaded.graph);
    request.hosts = std::move(loaded.hosts);
    request.seed = options.seed;
    request.preview = options.preview;
    request.progress = options.progress;
    request.listen = options.listen;
    request.pass = options.pass;
    request.tuning = options.tuning;
    request.local_workers = options.local_workers.value_or(0);
    request.slurm = {options.slurm.value_or(0), options.partition, words_of(options.slurm_arguments)};
    request.wait = std::chrono::seconds(options.wait);
    request.resume = options.resume;
    request.forget = options.forget;
    const bool network = !options.hosts.empty() || !options.listen.empty() || options.local_workers;
    request.threads = options.threads.value_or(network ? 0 : std::max(1u, std::thread::hardware_concurrency()));
    request.mode = network ? Mode::network : request.threads > 1 ? Mode::threads : Mode::serial;
    if (request.mode == Mode::network) {
        const auto shards = shards_of(request.graph, registry, request.hosts);
        request.graph = sharded(std::move(request.graph), shards);
    }
    return request;
}

// What hosts will offer isn't known before they are asked: at least what the file says of them.
std::vector<HostOffer> likely_offers(const Options& options, const Hosts& hosts) {
    if (options.threads) return {{"", *options.threads}};
    std::vector<HostOffer> offers;
    for (const auto& host : hosts.hosts)
        offers.push_back({host.endpoint, static_cast<std::uint32_t>(std::max(host.places, 1))});
    return offers;
}

void warn(const std::vector<Problem>& warnings, const Options& options, std::ostream& err) {
    if (options.progress == ProgressMode::none) return;
    for (const auto& warning : warnings) err << "warning: " << to_string(warning) << '\n';
}

}  // namespace

int Launcher::operator()(const std::vector<std::string>& arguments) const {
    try {
        const auto parsed = parse_options(arguments);
        if (const auto* finished = std::get_if<Finished>(&parsed)) {
            out << finished->out;
            err << finished->err;
            return finished->code;
        }
        return perform(std::get<Options>(parsed));
    } catch (const UserError& error) {
        err << error.what() << '\n';
        return exit_code::usage;
    } catch (const std::exception& error) {
        err << "lightnet: " << error.what() << '\n';
        return exit_code::failed;
    }
}

int Launcher::perform(const Options& options) const {
    switch (options.verb) {
        case Verb::run:
            return perform_run(options);
        case Verb::render:
            return perform_render(options);
        case Verb::scene_info:
            print_scene_info(options.scene, options.constants, out);
            return exit_code::done;
        case Verb::check:
            return perform_check(options);
        case Verb::dot:
            return perform_dot(options);
        case Verb::describe:
            return perform_describe(options);
        case Verb::hosts:
            return perform_hosts(options);
        case Verb::compare:
            return compare_pictures(options.compare, out, err);
    }
    return exit_code::usage;
}

int Launcher::perform_run(const Options& options) const {
    Loaded loaded = load(options, registry, true);
    warn(loaded.warnings, options, err);
    return run(request_of(options, registry, std::move(loaded)));
}

int Launcher::perform_render(Options options) const {
    Written written = read_render(options);
    auto read = std::make_shared<ReadScene>();
    const bool own_graph = !options.lighting.ends_with(".lua");  // else the constants are the graph's
    read->scene =
        read_scene(read->files, options.scene, own_graph ? options.constants : std::map<std::string, std::string>{});
    if (!options.size) options.size = PictureSize{read->scene.film.width, read->scene.film.height};
    if (!options.crop) options.crop = crop_in_pixels(read->scene.film.crop, *options.size);
    if (options.output.empty()) options.output = picture_of(options.scene);
    Loaded loaded = load_render(std::move(written), options, registry);
    warn(loaded.warnings, options, err);
    RunRequest request = request_of(options, registry, std::move(loaded));
    request.read = std::move(read);
    return run(request);
}

int Launcher::perform_check(const Options& options) const {
    const Loaded loaded = load(options, registry, true);
    warn(loaded.warnings, options, err);
    DiskFiles files;
    warn(load_scene(loaded.graph, registry, files, scene_file(loaded.graph, registry)).data.warnings, options, err);
    for (const auto& note : loaded.notes) err << "note: " << to_string(note) << '\n';
    const auto format = film_of(loaded.graph, registry);
    out << options.graph << ": sound: " << loaded.graph.nodes.size() << " nodes, " << format.width << "x"
        << format.height;
    if (const auto& crop = format.crop) out << " (" << crop->width << "x" << crop->height << " of it)";
    out << ", layers";
    for (const auto& layer : layers_of(loaded.graph, registry).film) out << ' ' << layer;
    for (const auto& [node, count] : shards_of(loaded.graph, registry, loaded.hosts))
        out << ", " << node << " in " << count << " sectors";
    out << '\n';
    return exit_code::done;
}

int Launcher::perform_dot(const Options& options) const {
    const Loaded loaded = load(options, registry, false);
    warn(loaded.warnings, options, err);
    const auto offers = likely_offers(options, loaded.hosts);
    std::map<std::string, std::string> pictures;
    if (!options.pictures.empty()) pictures = write_node_pictures(loaded.graph, registry, options.pictures);
    if (offers.empty()) {
        out << to_dot(loaded.graph, registry, nullptr, {}, pictures);
    } else {
        const Graph graph = sharded(loaded.graph, shards_of(loaded.graph, registry, loaded.hosts));
        const Plan where = plan(graph, registry, loaded.hosts, offers);
        out << to_dot(graph, registry, &where, {}, pictures);
    }
    return exit_code::done;
}

int Launcher::perform_describe(const Options& options) const {
    if (options.kind.empty()) {
        out << describe(registry);
        return exit_code::done;
    }
    if (const Kind* kind = registry.find(options.kind)) {
        out << describe(*kind);
        return exit_code::done;
    }
    std::vector<std::string> known;
    for (const auto& kind : registry.kinds()) known.push_back(kind.name);
    err << "lightnet: there is no kind '" << options.kind << "'" << suggest(options.kind, known) << '\n';
    return exit_code::usage;
}

int Launcher::perform_hosts(const Options& options) const {
    std::vector<std::string> endpoints, joining;
    for (const auto& one : options.whom) {
        if (address_of(one)) {
            endpoints.push_back(one);
            continue;
        }
        for (const auto& host : load_hosts(one).hosts)
            (address_of(host.endpoint) ? endpoints : joining).push_back(host.endpoint);
    }
    const auto answers = ask_state(endpoints, std::chrono::seconds(2));
    out << host_table(answers);
    for (const auto& name : joining)
        err << "lightnet: '" << name << "' joins by itself: ask its launcher (the endpoint behind --listen)\n";
    const auto absent = std::count_if(answers.begin(), answers.end(), [](const auto& host) { return !is_there(host); });
    if (absent == 0) return exit_code::done;
    err << "lightnet: " << absent << " of " << answers.size() << (absent == 1 ? " is" : " are") << " not there\n";
    return exit_code::no_worker;
}

}  // namespace lightnet
