#include "tools/watch/watcher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>
#include <utility>

#include "core/base/processor_time.hpp"
#include "tools/watch/watch_page.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;

constexpr auto pixel_period = 0.125s;      // between two looks at the film
constexpr auto most_pixel_time = 0.0015s;  // of one look
constexpr auto state_period = 0.4s;
constexpr double most_state_share = 0.005;  // of the run's thread
constexpr std::size_t most_live_bytes = std::size_t{512} << 20;
constexpr std::size_t most_reported_lines = 1000;

// Of a pixel that is shown.
std::size_t colours_of(const FilmFormat& format) { return format.views().size() + LiveCleaning(format).colours(); }

}  // namespace

Watcher::Watcher(Options options, const WatchedRun& run)
    : options_(std::move(options)),
      graph_(run.graph),
      output_(run.output),
      noted_{hello_json(run), {}, {}},
      board_(std::make_shared<WatchBoard>(run.format.work(), colours_of(run.format))),
      too_large_(run.format.work().pixels() * colours_of(run.format) * sizeof(Rgb) > most_live_bytes),
      cleaning_(run.format),
      pixel_pace_(pixel_period, begun_),
      state_pace_(state_period, begun_),
      history_(begun_) {
    if (const auto& viewer = options_.viewer)
        viewer_ = std::make_unique<TevPreview>(TevPreview::Options{viewer->host, viewer->port, run.output, run.format},
                                               *board_);
    if (too_large_ && (options_.address || viewer_)) say("the picture is too large to be shown while it grows");
    if (!options_.address) return;
    const auto take = [this](WatchCommand command) {
        if (command.what == WatchCommand::What::end) {
            options_.end();
            return command.answer("");
        }
        const std::lock_guard lock(commands_mutex_);
        if (commands_.size() >= 100) return command.answer("too much is asked of the run at once");
        commands_.push_back(std::move(command));
    };
    std::function<void(const PixelWish&, std::function<void(std::string)>)> explain;
    if (auto* const explainer = options_.explainer)
        explain = [explainer](const PixelWish& wish, LiveExplainer::Reply reply) {
            explainer->explain(wish, std::move(reply));
        };
    WatchStage stage{noted_.hello, board_, take, explain};
    server_ = options_.server;
    if (server_) {
        server_->show(std::move(stage));
        return;
    }
    own_server_ = std::make_unique<WatchServer>(WatchServer::Options{*options_.address, new_token(), watch_page()},
                                                std::move(stage));
    server_ = own_server_.get();
}

// The last thing that it has shown stays on a server of others, unless another run is shown there already.
Watcher::~Watcher() {
    if (!server_ || own_server_) return;
    server_->show(
        {noted_.hello, board_, [](const WatchCommand& command) { command.answer("the picture is finished"); }}, board_);
}

std::string Watcher::url() const { return server_ ? server_->url() : std::string(); }

void Watcher::say(const std::string& text) {
    auto line = fmt::format("{:.1f}\t{}", std::chrono::duration<double>(Clock::now() - begun_).count(), text);
    if (options_.report && noted_.lines.size() < most_reported_lines) noted_.lines.push_back(line);
    board_->say(std::move(line));
}

void Watcher::part_from(const Hosts& hosts) {
    if (wanted()) look_at_hosts(hosts(), Clock::now());
}

void Watcher::preparing(const PrepareProgress& progress) {
    state_.doing = {{progress.node, {progress.what, progress.done, progress.total}}};
}

void Watcher::handed_out(const std::vector<Tile>& tiles) {
    state_.in_flight.insert(state_.in_flight.end(), tiles.begin(), tiles.end());
}

void Watcher::taken(const Tile& tile) {
    const auto flying = std::find(state_.in_flight.begin(), state_.in_flight.end(), tile);
    if (flying != state_.in_flight.end()) state_.in_flight.erase(flying);
    if (!changed_) return;
    Tile area{tile.x, tile.y, tile.width, tile.height};
    area.coarse = tile.coarse;
    if (std::find(changed_->begin(), changed_->end(), area) == changed_->end()) changed_->push_back(area);
}

// Somebody has come, so that from now on changes are noted, or all is other than it was.
void Watcher::take_areas_of(const Film& film) {
    const auto areas = film.areas();
    changed_.emplace(areas.begin(), areas.end());
    for (Tile& area : *changed_) area.coarse = film.format().coarse;
}

void Watcher::show_pixels(const Film& film, std::chrono::duration<double> most) {
    if (!changed_) take_areas_of(film);
    const auto end = Clock::now() + most;
    while (!changed_->empty() && Clock::now() < end) {
        const Tile area = changed_->front();
        const bool outdated = area.coarse && !film.format().coarse;
        if (!outdated && !board_->show(area, cleaning_.so_far(film, area))) return;
        changed_->pop_front();
    }
}

void Watcher::look(const Film& film) {
    const auto now = Clock::now();
    if (!board_->wanted() || too_large_ || !pixel_pace_.due(now)) return;
    if (!film.format().coarse && cleaning_.look(film)) take_areas_of(film);
    show_pixels(film, most_pixel_time);
    pixel_pace_.put_off(now);
}

void Watcher::look(const Film& film, const Hosts& hosts) {
    if (!wanted()) return;
    look(film);
    const auto now = Clock::now();
    if (!state_pace_.due(now)) return;
    const auto begun = thread_processor_time();  // on a busy machine, waiting for a processor is nobody's cost
    look_at_hosts(hosts(), now);
    tell();
    if (options_.report && history_.due(now)) history_.add(noted_.last_state, now);
    state_pace_.put_off(now, std::chrono::duration<double>(thread_processor_time() - begun) / most_state_share);
}

void Watcher::phase(const std::string& name) {
    state_.phase = name;
    if (name == "render" && options_.explainer) options_.explainer->begin();
    state_.doing.clear();
    tell();
}

bool Watcher::tell() {
    state_.seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
    noted_.last_state = state_json(state_, graph_);
    return board_->tell(noted_.last_state);
}

void Watcher::look_at_hosts(std::vector<HostState> hosts, Clock::time_point now) {
    state_.hosts = std::move(hosts);
    work_.look(state_.hosts, std::chrono::duration<double>(now - begun_).count());
}

std::vector<WatchCommand> Watcher::commands() {
    const std::lock_guard lock(commands_mutex_);
    return std::exchange(commands_, {});
}

void Watcher::finish(const Film& film, const std::string& outcome, ForecastCurve forecast) {
    if (!wanted() && !picture_wanted()) return;
    for (const auto& command : commands()) command.answer("the run is over");
    state_.outcome = outcome;
    state_.forecast = std::move(forecast);
    state_.in_flight.clear();
    state_.doing.clear();
    if (picture_wanted() && !too_large_ && !film.format().coarse && cleaning_.finish(film)) take_areas_of(film);
    bool told = false;
    const auto end = Clock::now() + 300ms;  // the board is never taken for long
    do {
        if (picture_wanted() && !too_large_) show_pixels(film, 1s);
        told = tell() || told;
        std::this_thread::sleep_for(1ms);
    } while ((!told || (changed_ && !changed_->empty())) && Clock::now() < end);
    if (viewer_ && options_.viewer->stays_here() && outcome == "done")
        viewer_->finish(std::filesystem::absolute(output_).string());
}

}  // namespace lightnet
