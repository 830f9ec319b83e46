#include "tools/run.hpp"

#include <fmt/format.h>
#include <pwd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <random>
#include <utility>

#include "core/base/build_info.hpp"
#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/prepare/load_scene.hpp"
#include "core/run/runtime/conductor.hpp"
#include "core/run/runtime/fingerprint.hpp"
#include "core/run/runtime/job.hpp"
#include "core/run/runtime/master_renderer.hpp"
#include "core/run/runtime/serial.hpp"
#include "tools/crew.hpp"
#include "tools/delivery.hpp"
#include "tools/exit_code.hpp"
#include "tools/output_file.hpp"
#include "tools/picture_lock.hpp"
#include "tools/picture_recipe.hpp"
#include "tools/run_book.hpp"
#include "tools/signals.hpp"
#include "transport/cluster.hpp"
#include "transport/result_cache.hpp"
#include "transport/threaded_run.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto drain_deadline = 5s;  // for tiles that are under way when the run is told to stop

std::uint64_t random_number() {
    std::random_device device;  // names a run; nothing that is computed depends on it
    return (std::uint64_t{device()} << 32) | device();
}

// For those who have to wait for the hosts of this run.
std::string who_runs(const Graph& graph) {
    std::array<char, 256> machine{};
    gethostname(machine.data(), machine.size() - 1);
    const passwd* user = getpwuid(getuid());
    return fmt::format("{}@{} ({})", user ? user->pw_name : std::to_string(getuid()), machine.data(), graph.file);
}

const char* name_of(Mode mode) {
    return mode == Mode::serial ? "serial" : mode == Mode::threads ? "threads" : "network";
}

RunReport first_page(const RunRequest& request, const Registry& registry, const FilmFormat& film) {
    RunReport report;
    report.graph = request.graph.file;
    report.graph_hash = to_hex(content_hash(to_json(request.graph)));
    report.mode = name_of(request.mode);
    report.versions["lightnet"] = build_id();
    report.settings["samples"] = std::to_string(film.samples);
    report.settings["size"] = fmt::format("{}x{}", film.width, film.height);
    if (const auto& crop = film.crop)
        report.settings["crop"] =
            fmt::format("{},{},{},{}", crop->x, crop->y, crop->x + crop->width, crop->y + crop->height);
    if (film.adaptive()) report.settings["error"] = fmt::format("{}", film.refinement.error);
    report.settings["seed"] = std::to_string(request.seed);
    for (const auto& knob : knobs)
        if (knob.by == Knob::By::users) report.settings[knob.name] = text_of(request.tuning, knob);
    for (const auto& warning : irreproducible_nodes(request.graph, registry))  // said already, when it was checked
        report.warnings.push_back(to_string(warning));
    return report;
}

// One run of a checked graph, from its scene to its files.
class Run {
public:
    Run(const RunRequest& request, const Registry& registry)
        : request_(request),
          registry_(registry),
          signals_(watch_signals()),
          image_(renderer_of(request.graph, registry)),
          format_(format()),
          tiles_(tiles_of(format_, request.tuning.tile)),
          book_(format_, request.progress, work_in(tiles_of(format_.work(), request.tuning.tile, format_.samples)),
                first_page(request, registry, format_)) {}

    int perform();

private:
    FilmFormat format() const;
    Job make_job(DiskFiles& files) const;
    void take_up_checkpoint();
    void report_failure();
    void render_serially(LoadedScene scene);
    void render_in_threads(LoadedScene scene);
    void render_on_hosts(const DiskFiles& files, LoadedScene scene);
    Cluster::Options cluster_options(const DiskFiles& files);
    /// Called several times a second with the number of places that render.
    using LookAround = std::function<void(std::size_t renderers)>;
    void hand_out(Carrier& carrier, const Plan& plan, const LookAround& look_around);
    bool prepare(Conductor& conductor, const LookAround& look_around);
    ResultCache* cache();
    std::uint32_t tiles_per_place(const Plan& plan) const;
    bool stopped() const { return signals_.any; }

    const RunRequest& request_;
    const Registry& registry_;
    const Signals& signals_;
    std::size_t image_;
    FilmFormat format_;
    std::vector<Tile> tiles_;
    RunBook book_;
    Job job_;
    std::optional<DiskResultCache> cache_;
    const std::uint64_t id_ = random_number();
};

FilmFormat Run::format() const {
    const auto film = film_of(request_.graph, registry_);
    const auto sampling = sampling_of(request_.graph, registry_);
    const auto layers = layers_of(request_.graph, registry_);
    FilmFormat format{film.width, film.height, layers.film, sampling.samples, film.crop};
    format.refinement = {sampling.error, sampling.least_samples};
    format.shown = shown_names(layers, request_.graph);
    return format;
}

Job Run::make_job(DiskFiles& files) const {
    Job job;
    job.graph = request_.graph;
    job.scene = request_.scene;
    for (const auto& [path, hash] : files.hashes()) job.files.push_back({path, hash, files.seen().at(path)->size()});
    job.seed = request_.seed;
    job.isa = usual_isa();
    job.width = format_.width, job.height = format_.height;
    job.tuning = request_.tuning;
    return job;
}

void Run::take_up_checkpoint() {
    book_.keep_checkpoint(request_.output, picture_recipe(job_, registry_, format_, request_.tuning.tile),
                          std::chrono::seconds(request_.tuning.checkpoint));
    if (!request_.resume) return;
    book_.take_up_checkpoint();
    std::vector<Tile> left = book_.going_on();
    const auto all = work_in(tiles_);
    for (const auto& tile : std::exchange(tiles_, {}))
        for (const auto& lacking : book_.lacking(tile)) tiles_.push_back(lacking);
    book_.found(all - work_in(tiles_));
    tiles_.insert(tiles_.end(), left.begin(), left.end());
}

int Run::perform() {
    check_output(request_.output);
    const PictureLock lock(request_.output);
    try {
        book_.phase("load");
        const auto read = request_.read ? request_.read : std::make_shared<ReadScene>();
        DiskFiles& files = read->files;
        if (!request_.read) read->scene = read_scene(files, request_.scene, scene_constants(request_.graph, registry_));
        LoadedScene scene = override_scene(request_.graph, registry_, files, std::move(read->scene));
        for (const auto& warning : scene.data.warnings) book_.warn(to_string(warning));
        book_.will_keep(request_.graph, registry_, scene.data);
        const float scale = scene.data.film.scale;
        job_ = make_job(files);
        book_.expose(scale);
        if (request_.preview > 0) book_.preview(request_.output, request_.preview);
        take_up_checkpoint();
        if (book_.complete() && book_.is_written(request_.output)) {
            book_.say(request_.output + " is finished: nothing to do; ask for more with --samples");
            return exit_code::done;
        }
        if (book_.complete())
            book_.say(request_.output + " is finished but for its file");
        else if (request_.mode == Mode::serial)
            render_serially(std::move(scene));
        else if (request_.mode == Mode::threads)
            render_in_threads(std::move(scene));
        else
            render_on_hosts(files, std::move(scene));
        if (stopped()) {
            const bool kept = book_.save_checkpoint();
            book_.write_report(request_.output, "cancelled");
            std::cerr << (book_.previewed() ? "cancelled; the picture is a preview"
                                            : "cancelled; no picture was written")
                      << (kept ? "; --resume goes on from here" : "") << '\n';
            return exit_code::interrupted;
        }
        book_.phase("write");
        book_.name_not_finite(job_.graph);
        return finish_run(book_, request_, scene_overrides(request_.graph, registry_).exposure, signals_.any);
    } catch (const UserError&) {
        throw;
    } catch (const NoWorker& error) {
        report_failure();
        std::cerr << "lightnet: " << error.what() << '\n';
        return exit_code::no_worker;
    } catch (...) {
        report_failure();
        throw;
    }
}

// What went wrong is said anyhow; a report that can't be written must not hide it.
void Run::report_failure() {
    try {
        if (book_.save_checkpoint()) book_.say("what is there is kept: --resume goes on from here");
        book_.write_report(request_.output, "failed");
    } catch (const std::exception& error) {
        book_.say(error.what());
    }
}

void Run::render_serially(LoadedScene scene) {
    book_.phase("prepare");
    const auto network = build_network(job_, registry_, std::move(scene));
    SerialRun run(*network, [this] {
        if (stopped()) throw Cancelled{};
    });
    run.watch([this](const PrepareProgress& progress) { book_.preparing(progress); });
    book_.use(Plan{{PlaceAt{}}, std::vector<std::vector<std::uint32_t>>(job_.graph.nodes.size(), {0})}, job_.graph);
    try {
        run.prepare(made_from(job_), cache(), [this](const std::string& text) { book_.say(text); });
        book_.write_kept([&](std::size_t node) { return run.last_result(node); });
        book_.phase("render");
        for (std::size_t next = 0; next < tiles_.size() && !stopped(); ++next) {
            const Tile tile = tiles_[next];
            const auto more = book_.take(tile, run.render(tile));
            tiles_.insert(tiles_.end(), more.begin(), more.end());
        }
    } catch (const Cancelled&) {
    }
    book_.count(run.counters());
}

void Run::render_in_threads(LoadedScene scene) {
    book_.phase("prepare");
    const auto network = build_network(job_, registry_, std::move(scene));
    const Plan plan = lightnet::plan(job_.graph, registry_, {}, {{"", request_.threads}});
    ThreadedRun run(network, id_, plan, job_.tuning);
    book_.use(plan, job_.graph);
    hand_out(run.carrier(), plan, [&](std::size_t) { run.check(); });
    book_.count(run.stop());
}

// How many tiles are under way per place: one that renders and one that waits, or, where lighting is elsewhere, as many
// as keep the questions of several together.
std::uint32_t Run::tiles_per_place(const Plan& plan) const {
    const auto& images = plan.places_of[image_];
    const bool alone = std::all_of(plan.places_of.begin(), plan.places_of.end(),
                                   [&](const auto& places) { return places.empty() || places == images; });
    return alone ? 2 : 6;
}

// Where what nodes prepare is kept. Doing without is slower, and no error.
ResultCache* Run::cache() {
    if (request_.tuning.cache == "none" || preparing_nodes(job_.graph, registry_).empty()) return nullptr;
    try {
        cache_.emplace(request_.tuning.cache.empty() ? default_cache_folder() : request_.tuning.cache,
                       request_.tuning.cache_size);
        return &*cache_;
    } catch (const Error& error) {
        book_.warn(std::string("what nodes prepare is not kept: ") + error.what());
        return nullptr;
    }
}

// True when all is prepared, false when the run was stopped.
bool Run::prepare(Conductor& conductor, const LookAround& look_around) {
    while (!conductor.prepare(50ms)) {
        if (stopped()) return false;
        look_around(conductor.in_force().places_of[image_].size());
        book_.preparing(conductor.progress());
    }
    for (const auto& [node, hash] : conductor.prepared()) book_.set("prepared." + node, to_hex(hash));
    return true;
}

void Run::hand_out(Carrier& carrier, const Plan& plan, const LookAround& look_around) {
    Conductor::Options options;
    options.run = id_;
    options.graph = &job_.graph;
    options.registry = &registry_;
    options.width = static_cast<std::uint32_t>(format_.colours());
    options.made_from = made_from(job_);
    options.cache = cache();
    options.say = [this](const std::string& text) { book_.say(text); };
    Conductor conductor(std::move(options), carrier);
    conductor.propose(plan);
    if (!prepare(conductor, look_around)) return;
    book_.write_kept([&](std::size_t node) { return conductor.last_result(node); });
    book_.phase("render");
    MasterRenderer::Job job;
    job.run = id_;
    job.image = static_cast<std::uint32_t>(image_);
    job.width = static_cast<std::uint32_t>(format_.colours());
    job.tiles = tiles_;
    const auto tiles = tiles_per_place(plan);
    job.credit = {tiles, tiles * MasterRenderer::most_together};
    job.check_answers = request_.tuning.check_answers;
    MasterRenderer* more = nullptr;
    MasterRenderer master(std::move(job), conductor, [this, &more](const Tile& tile, std::span<const Rgb> pixels) {
        more->append(book_.take(tile, pixels));
    });
    more = &master;
    master.use(conductor.in_force());
    while (!stopped() && !master.work(50ms)) look_around(master.renderers());
    if (signals_.terminated) {
        master.drain();
        const auto end = Clock::now() + drain_deadline;
        while (master.outstanding() > 0 && Clock::now() < end && !signals_.interrupted) master.work(50ms);
    }
    book_.count(master.counters());
    if (const auto& aside = master.set_aside_tiles(); !aside.empty()) {
        std::string all = "the picture lacks some of its tiles, and is not written:";
        for (const auto& tile : aside) all += "\n  " + tile;
        throw Error("node '" + job_.graph.nodes[image_].name + "'", all);
    }
}

Cluster::Options Run::cluster_options(const DiskFiles& files) {
    Cluster::Options options;
    options.run = id_;
    options.who = who_runs(job_.graph);
    options.job = job_;
    options.files = files.seen();
    options.plan = [this](const std::vector<HostOffer>& offers) {
        return lightnet::plan(job_.graph, registry_, request_.hosts, offers);
    };
    options.say = [this](const std::string& text) { book_.say(text); };
    return options;
}

void Run::render_on_hosts(const DiskFiles& files, LoadedScene scene) {
    book_.phase("prepare");
    auto options = cluster_options(files);
    if (request_.threads) options.network = build_network(job_, registry_, std::move(scene));
    Crew crew(request_, std::move(options));
    auto& cluster = crew.cluster();
    crew.gather(signals_.any);
    if (stopped()) {
        cluster.finish(300ms);
        return;
    }
    book_.use(cluster.plan(), job_.graph);
    for (const auto& host : crew.missing()) book_.warn(host);
    std::optional<Clock::time_point> homeless;
    hand_out(cluster, cluster.plan(), [&](std::size_t renderers) {
        crew.look_after();
        if (renderers > 0) return homeless.reset();
        const auto& name = job_.graph.nodes[image_].name;
        if (!homeless) {
            book_.say(fmt::format("node '{}' has no place any more; waiting {} s for a host to come", name,
                                  request_.wait.count()));
            homeless = Clock::now();
        }
        if (Clock::now() - *homeless > request_.wait)
            throw Error(fmt::format("node '{}' has no place any more, and no host came within {} s", name,
                                    request_.wait.count()));
    });
    book_.use(cluster.plan(), job_.graph);
    for (const auto& host : cluster.hosts()) book_.use(host);
    book_.count(cluster.finish(stopped() ? 300ms : 1000ms));
}

}  // namespace

int run(const RunRequest& request, const Registry& registry) try {
    return Run(request, registry).perform();
} catch (const std::bad_alloc&) {  // whose own words are none
    const auto film = film_of(request.graph, registry);
    throw Error(
        fmt::format("there is not enough memory for {}x{} pixels of '{}'; a smaller --size or --crop takes less",
                    film.width, film.height, request.scene));
}

}  // namespace lightnet
