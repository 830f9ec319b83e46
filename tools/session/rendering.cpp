#include "tools/session/rendering.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/hash.hpp"
#include "core/base/this_machine.hpp"
#include "core/base/unwanted.hpp"
#include "core/network/graph/single_lights.hpp"
#include "core/run/assembly/sampling_profiler.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/schedule/spot_checks.hpp"
#include "core/run/serial/serial.hpp"
#include "tools/session/slices.hpp"
#include "transport/launcher/threaded_run.hpp"
#include "transport/store/cache_folder.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto drain_deadline = 5s;  // for tiles that are under way when the run is told to stop

// Where somebody edits what is at work, it may end at any time.
Slices slices_of(const RunRequest& request) { return {request.shown ? Slices::at_once : Slices::now_and_then}; }

// Somebody has answered falsely.
struct Lie {
    Failure what;
};

// For those who have to wait for the hosts of this run.
std::string who_runs(const Graph& graph) {
    const passwd* user = getpwuid(getuid());
    return fmt::format("{}@{} ({})", user ? user->pw_name : std::to_string(getuid()), machine_name(), graph.file);
}

}  // namespace

/// As long as it lives, hosts are attended to while the recorder writes or cleans for long.
class Rendering::Attention {
public:
    Attention(RunRecorder& book, Coordinator& coordinator) : book_(book) {
        book_.files().attend_by([this, &coordinator] {
            try {
                if (!trouble_) coordinator.wait(1ms);
            } catch (...) {
                trouble_ = std::current_exception();
            }
        });
    }
    ~Attention() { book_.files().attend_by(nullptr); }
    Attention(const Attention&) = delete;
    Attention& operator=(const Attention&) = delete;

    /// Throws what was met meanwhile.
    void check() const {
        if (trouble_) std::rethrow_exception(trouble_);
    }

private:
    RunRecorder& book_;
    std::exception_ptr trouble_;
};

Rendering::Rendering(Assignment what, RunRecorder& book, const Signals& signals)
    : what_(std::move(what)),
      book_(book),
      signals_(signals),
      image_(renderer_of(what_.job.graph, what_.registry)),
      id_(secret_number()) {
    book_.account().set("run", public_name_of_run(id_));
    if (what_.handover) liars_ = what_.handover->liars();
}

void Rendering::perform(LoadedScene scene, const DiskFiles& files) {
    if (what_.request.tuning.verify > 0 && what_.request.mode != Mode::network)
        book_.account().alert("--verify asks other hosts, and this run has none");
    const auto mode = what_.request.mode;
    if (mode == Mode::serial) serially(std::move(scene));
    if (mode == Mode::threads) in_threads(std::move(scene));
    if (mode == Mode::network) on_hosts(std::move(scene), files);
    if (!ended()) note_noise(book_, what_);
}

std::shared_ptr<const Network> Rendering::network_of(LoadedScene scene) {
    const LookingAt looking(what_.request.shown ? &signals_.superseded : nullptr);
    const auto network = what_.network = build_network(what_.job, what_.registry, std::move(scene));
    if (what_.handover) what_.handover->hold(network->scene);
    if (auto* watcher = book_.account().watcher(); watcher && !leaves_out(what_.job.graph))
        watcher->share(network, what_.made_from, book_.files().scale());
    return network;
}

void Rendering::serially(LoadedScene scene) {
    book_.account().phase("prepare");
    const auto network = network_of(std::move(scene));
    std::optional<SamplingProfiler> profiler;
    const Crowd alone{{}, {}, [&] { return std::vector{this_process(1, profiler->figures())}; }, {}};
    SerialRun run(*network, [&] {
        if (ended()) throw Cancelled{};
        if (profiler) show(alone);
    });
    std::optional<PlaceTracer> tracer;
    if (what_.request.tuning.trace) run.trace(tracer.emplace(what_.job.graph, 1 << 16));
    if (book_.account().watcher()) profiler.emplace(std::vector{&run.gauge()});
    run.watch([this](const PrepareProgress& progress) { book_.account().preparing(progress); });
    book_.account().use(Plan{{PlaceAt{}}, std::vector<std::vector<std::uint32_t>>(what_.job.graph.nodes.size(), {0})},
                        what_.job.graph);
    try {
        const LookingAt looking(&signals_.any);
        render(run);
    } catch (const Cancelled&) {
    }
    if (profiler) book_.account().watcher()->part_from(alone.hosts);
    auto counters = run.counters();
    if (tracer) counters.traces.push_back(tracer->take("", 0));
    book_.account().count(counters);
}

void Rendering::render(SerialRun& run) {
    auto tiles = book_.next_step();
    const auto say = [this](const std::string& text) { book_.account().say(text); };
    run.prepare(what_.made_from, cache(), say, TilesByPass(what_.job.graph, what_.registry, tiles).pass());
    what_.kept.write([&](std::size_t node) { return run.last_result(node); }, book_);
    book_.account().phase("render");
    for (; what_.wants(tiles) && !ended(); tiles = book_.next_step()) {
        TilesByPass passes(what_.job.graph, what_.registry, tiles);
        while (!passes.empty() && !ended()) {
            auto pass = passes.begin_next();
            for (std::size_t next = 0; next < pass.size() && !ended(); ++next) {
                const Tile tile = pass[next];
                const auto more = passes.sort(book_.take(tile, run.render(tile)));
                pass.insert(pass.end(), more.begin(), more.end());
            }
        }
    }
}

void Rendering::in_threads(LoadedScene scene) {
    book_.account().phase("prepare");
    const auto network = network_of(std::move(scene));
    const Plan plan =
        lightnet::plan(what_.job.graph, what_.registry, what_.request.hosts, {{"", what_.request.threads}});
    ThreadedRun run(network, id_, plan, what_.job.tuning);
    book_.account().use(plan, what_.job.graph);
    if (book_.account().watcher()) run.watch();
    const auto places = static_cast<std::uint32_t>(plan.places.size());
    const auto hosts = [&] { return std::vector{this_process(places, run.figures())}; };
    hand_out(run.carrier(), plan,
             {[&](std::size_t) { run.check(); }, [&] { return network->activity->all(); }, hosts, {}, [] {}});
    if (auto* watcher = book_.account().watcher()) watcher->part_from(hosts);
    book_.account().count(run.stop());
}

// How many tiles are under way per place: one that renders and one that waits, or, where lighting is elsewhere, as many
// as keep the questions of several together.
std::uint32_t Rendering::tiles_per_place(const Plan& plan) const {
    const auto& images = plan.places_of[image_];
    const bool alone = std::all_of(plan.places_of.begin(), plan.places_of.end(),
                                   [&](const auto& places) { return places.empty() || places == images; });
    return alone ? 2 : 6;
}

// Where what nodes prepare is kept. Doing without is slower, and no error.
ResultCache* Rendering::cache() {
    if (what_.request.tuning.verify > 0) return nullptr;  // what earlier runs have kept there nobody has verified
    if (preparing_nodes(what_.job.graph, what_.registry).empty()) return nullptr;
    const auto at_hand = what_.handover ? what_.handover->results : nullptr;
    if (what_.request.tuning.cache == "none") return at_hand.get();
    try {
        cache_ = std::make_unique<DiskResultCache>(
            what_.request.tuning.cache.empty() ? default_cache_folder() : what_.request.tuning.cache,
            what_.request.tuning.cache_size);
        if (at_hand) cache_ = at_hand_before(at_hand, std::move(cache_));
        return cache_.get();
    } catch (const Error& error) {
        book_.account().warn(std::string("what nodes prepare is not kept: ") + error.what());
        return at_hand.get();
    }
}

// True when all is prepared, false when the run was stopped, or its time is over.
bool Rendering::prepare(Coordinator& coordinator, const Crowd& crowd) {
    while (
        !slices_of(what_.request).of([&](auto most) { return coordinator.prepare(most); }, [&] { return ended(); })) {
        if (ended()) return false;
        crowd.look_around(coordinator.in_force().places_of[image_].size());
        book_.account().preparing(with(coordinator.progress(), crowd.doing()));
        show(crowd);
    }
    for (const auto& [node, hash] : coordinator.prepared()) book_.account().set("prepared." + node, to_hex(hash));
    return true;
}

void Rendering::hand_out(Carrier& carrier, const Plan& plan, const Crowd& crowd) {
    Coordinator::Options options;
    options.run = id_;
    options.graph = &what_.job.graph;
    options.registry = &what_.registry;
    options.width = static_cast<std::uint32_t>(what_.format.colours());
    options.made_from = what_.made_from;
    options.cache = cache();
    options.verify = what_.request.tuning.verify;
    options.say = [this](const std::string& text) { book_.account().say(text); };
    Coordinator coordinator(std::move(options), carrier);
    auto tiles = book_.next_step();
    coordinator.begin_pass(TilesByPass(what_.job.graph, what_.registry, tiles).pass());
    coordinator.propose(plan);
    if (!prepare(coordinator, crowd)) return;
    const auto write_kept = [&] {
        what_.kept.write([&](std::size_t node) { return coordinator.last_result(node); }, book_);
    };
    if (!what_.request.tuning.verify) write_kept();
    book_.account().phase("render");
    const Attention attention(book_, coordinator);
    for (; what_.wants(tiles) && !ended(); tiles = book_.next_step()) {
        attention.check();
        TilesByPass passes(what_.job.graph, what_.registry, tiles);
        while (!passes.empty() && !ended()) hand_out_pass(coordinator, passes, crowd, attention);
    }
    if (what_.request.tuning.verify && !signals_.any) write_kept();  // nobody was found to have lied
}

// Prepares for the next pass, as far as that is still to be done, and has its tiles rendered.
void Rendering::hand_out_pass(Coordinator& coordinator, TilesByPass& passes, const Crowd& crowd,
                              const Attention& attention) {
    MasterRenderer::Job job;
    job.run = id_;
    job.image = static_cast<std::uint32_t>(image_);
    job.width = static_cast<std::uint32_t>(what_.format.colours());
    job.tiles = passes.begin_next();
    coordinator.begin_pass(passes.pass());
    if (!prepare(coordinator, crowd)) return;
    coordinator.begin_master();
    const auto tiles = tiles_per_place(coordinator.proposed());
    job.credit = {tiles, tiles * MasterRenderer::most_together};
    job.check_answers = what_.request.tuning.check_answers;
    job.verify = what_.request.tuning.verify;
    job.alone = [this](const Plan& plan) { return answers_alone(plan, what_.job.graph, image_); };
    if (book_.account().watcher())
        job.handed_out = [this](const auto& handed_out) { book_.account().watcher()->handed_out(handed_out); };
    MasterRenderer* more = nullptr;
    MasterRenderer master(std::move(job), coordinator, [&](const Tile& tile, std::span<const Rgb> pixels) {
        more->append(passes.sort(book_.take(tile, pixels)));
        attention.check();
    });
    more = &master;
    master.use(coordinator.in_force());
    while (!ended() &&
           !slices_of(what_.request).of([&](auto most) { return master.work(most); }, [&] { return ended(); })) {
        crowd.look_around(master.renderers());
        crowd.move();
        show(crowd);
    }
    if (signals_.terminated) {
        master.drain();
        const auto end = Clock::now() + drain_deadline;
        while (master.outstanding() > 0 && Clock::now() < end && !signals_.interrupted) master.work(50ms);
    }
    crowd.trust();
    book_.account().count(master.counters());
    if (const auto& aside = master.set_aside_tiles(); !aside.empty()) {
        std::string all = "the picture lacks some of its tiles, and is not written:";
        for (const auto& tile : aside) all += "\n  " + tile;
        throw Error("node '" + what_.job.graph.nodes[image_].name + "'", all);
    }
}

Cluster::Options Rendering::cluster_options(const DiskFiles& files) {
    Cluster::Options options;
    options.run = id_;
    options.who = who_runs(what_.job.graph);
    options.job = what_.job;
    options.files = files.seen();
    options.plan = [this](const std::vector<HostOffer>& offers) {
        if (moves_ && !whole_) return moves_->plan(offers);
        return lightnet::plan(what_.job.graph, what_.registry, whole_ ? Hosts{} : what_.request.hosts, offers);
    };
    options.moved = [this] { return moves_ && moves_->take_change(); };
    options.say = [this](const std::string& text) { book_.account().say(text); };
    options.warn = [this](const std::string& text) { book_.account().warn(text); };
    return options;
}

void Rendering::on_hosts(LoadedScene scene, const DiskFiles& files) {
    book_.account().phase("prepare");
    if (what_.request.laid_out && what_.job.graph.sectors.empty())
        moves_.emplace(*what_.request.laid_out, Moves::Of{what_.job.graph, what_.registry, what_.request.hosts});
    if (moves_ && !moves_->may_move()) moves_.reset();
    auto options = cluster_options(files);
    options.liars = liars_;
    if (what_.request.threads)
        options.network = network_of(std::move(scene));
    else
        what_.beside = network_beside(what_, std::move(scene));
    std::optional<Crew> own;
    auto& crew = what_.handover ? what_.handover->crew() : own;
    const auto done = [this] { return book_.share_done(); };
    if (crew)
        crew->begin_next(what_.request, std::move(options), done);
    else
        crew.emplace(what_.request, std::move(options), done);
    while (true) {
        try {
            return on(*crew);
        } catch (const Lie& lie) {
            begin_anew(*crew, lie.what);
        }
    }
}

// What the liar has told may be in any sum, record or photon: all of it is done again, without him.
// DECISIONS: begun-anew-without-the-liar
void Rendering::begin_anew(Crew& crew, const Failure& lie) {
    crew.cluster().finish(300ms);
    book_.begin_anew();
    if (lie.host.empty() && whole_)
        throw Error("answers of hosts differ, and nobody can tell which is right",
                    lie.why + "; with three hosts, or with --threads 1, whose answers are believed, it can be told");
    if (lie.host.empty()) {
        book_.account().alert(
            lie.why + ": the run begins anew, with the whole network at each host, so that it shows who is wrong");
        whole_ = true;
    } else {
        book_.account().alert(lie.host + " is taken out, as it answers falsely: " + lie.why +
                              "; all that it has told is done again");
        liars_.insert(lie.host);
        if (what_.handover) what_.handover->liars() = liars_;
    }
    id_ = secret_number();
    book_.account().set("run", public_name_of_run(id_));
    book_.account().phase("prepare");
    crew.begin_anew(id_, liars_, what_.request.threads ? network_of_files() : nullptr);
}

// For places of this process, which keep what they have learnt with the network.
std::shared_ptr<const Network> Rendering::network_of_files() const {
    DiskFiles files;
    auto network = build_network(what_.job, what_.registry, files);
    for (const auto& [path, hash] : files.hashes())
        if (std::none_of(
                what_.job.files.begin(), what_.job.files.end(),
                [&, path = path, hash = hash](const JobFile& file) { return file.path == path && file.hash == hash; }))
            throw Error(path, "has changed since the run began");
    return network;
}

// A run on those hosts that are not known to lie. Throws Lie.
void Rendering::on(Crew& crew) {
    auto& cluster = crew.cluster();
    const auto trust = [&] {
        if (what_.request.tuning.verify > 0 && cluster.lie()) throw Lie{*cluster.lie()};
    };
    crew.gather(signals_.any, book_.steps().limit().left(std::chrono::steady_clock::now()));
    if (signals_.superseded) return crew.end_soon();
    if (ended()) return void(cluster.finish(300ms));
    book_.account().use(cluster.plan(), what_.job.graph);
    for (const auto& host : crew.missing()) book_.account().warn(host);
    warn_of_unverified(cluster.plan());
    std::optional<Clock::time_point> homeless;
    const auto look_around = [&](std::size_t renderers) {
        crew.look_after();
        trust();
        if (renderers > 0) return homeless.reset();
        const auto& name = what_.job.graph.nodes[image_].name;
        if (!homeless) {
            book_.account().say(fmt::format("node '{}' has no place any more; waiting {} s for a host to come", name,
                                            what_.request.wait.count()));
            homeless = Clock::now();
        }
        if (Clock::now() - *homeless > what_.request.wait)
            throw Error(fmt::format("node '{}' has no place any more, and no host came within {} s", name,
                                    what_.request.wait.count()));
    };
    if (book_.account().watcher() || moves_) cluster.watch();
    hand_out(cluster, cluster.plan(),
             {look_around, [&] { return cluster.doing(); }, [&] { return cluster.hosts(); },
              [&](const std::string& host) { return cluster.drain(host); }, trust, [&] { move_nodes(cluster); }});
    if (auto* watcher = book_.account().watcher()) watcher->part_from([&] { return cluster.hosts(); });
    book_.account().use(cluster.plan(), what_.job.graph);
    for (const auto& host : cluster.hosts()) book_.account().use(host);
    if (signals_.superseded) return crew.end_soon();
    const auto counted = cluster.finish(signals_.any ? 300ms : 1000ms);
    if (!signals_.any) trust();  // a word of the last moment
    for (const auto& host : cluster.hosts()) book_.account().use(host);
    book_.account().count(counted);
}

}  // namespace lightnet
