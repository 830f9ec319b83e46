#include "tools/session/run_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/joined.hpp"
#include "core/base/own_files.hpp"
#include "core/base/words_of.hpp"
#include "core/film/clean/rounds.hpp"
#include "tools/session/firefly_words.hpp"

namespace lightnet {

using Clock = std::chrono::steady_clock;

RunRecorder::RunRecorder(FilmFormat format, ProgressMode progress, std::uint32_t tile, RunReport report,
                         std::optional<Progress::Series> series)
    : steps_(std::move(format), tile),
      all_blocks_(work_in(tiles_of(steps_.film().format().work(), tile, steps_.film().format().samples))),
      account_(std::move(report), progress, series, all_blocks_) {}

void RunRecorder::expose(float scale) {
    files_.expose(scale);
    steps_.film().expose(scale);
}

void RunRecorder::limit_time(double seconds) {
    if (seconds <= 0) return;
    steps_.limit({std::chrono::duration<double>(seconds), account_.phases().run_begun()});
    account_.progress().end_by(*steps_.limit().end());
}

void RunRecorder::compare_with(ErrorCurve curve) {
    curve_ = std::move(curve);
    steps_.by_groups();
}

void RunRecorder::show_steps(const std::string& exr, std::function<void(const PictureShown&)> shown) {
    steps_.by_groups(true);
    so_far_.show_steps(exr, std::move(shown));
}

void RunRecorder::show(const Watcher::Hosts& hosts) {
    Watcher& watcher = *account_.watcher();
    const auto left = account_.phases().is("render") ? account_.progress().seconds_left(Clock::now()) : std::nullopt;
    watcher.progress(steps_.done(), left, account_.report().moves);
    watcher.look(steps_.at_work(), hosts);
    for (const auto& line : watcher.news()) account_.say(line);
}

std::vector<Tile> RunRecorder::next_step() {
    const auto now = Clock::now();
    if (checkpoint_ && steps_.finished()) checkpoint_->lights().complete(steps_.film());
    auto tiles = steps_.next(now);
    note_error(now);
    if (!tiles.empty()) so_far_.step();
    steps_.begin(Clock::now());
    return tiles;
}

std::vector<Tile> RunRecorder::take(const Tile& tile, std::span<const Rgb> pixels) {
    Film& film = steps_.film_of(tile);
    const bool knows = checkpoint_ && checkpoint_->lights().are_shown();
    const bool added = knows ? film.add(tile, checkpoint_->lights().shown_in(tile, pixels)) : film.add(tile, pixels);
    const bool wanted = added || !film.has(tile);
    auto next = wanted ? film.more(tile) : std::vector<Tile>{};
    const auto of_round =
        added && film.round_is_over() ? files_.apart([&] { return end_round_if_over(film); }) : std::vector<Tile>{};
    next.insert(next.end(), of_round.begin(), of_round.end());
    if (added && steps_.lasts(tile)) blocks_ += tile.blocks();
    if (!wanted) ++repeated_;
    if (auto* watcher = account_.watcher()) watcher->taken(tile), watcher->look(film);
    account_.progress().update(work_shown(), Clock::now());
    so_far_.look();
    if (checkpoint_ && !tile.coarse)
        if (const auto why = checkpoint_->save_if_due(blocks_); !why.empty()) account_.alert("no checkpoint: " + why);
    return next;
}

// In blocks of tiles, which differ in size where cells decide.
std::uint64_t RunRecorder::work_shown() const {
    const bool adaptive = steps_.film().format().adaptive();
    return adaptive ? static_cast<std::uint64_t>(steps_.done() * double(all_blocks_)) : blocks_;
}

// Of the picture that would be written now, unless that has been noted.
void RunRecorder::note_error(Clock::time_point now) {
    const Film& film = steps_.picture();
    if (!curve_ || film.covered() < 1) return;
    const double samples = film.mean_samples();
    auto& noted = account_.report().error;
    if (noted && noted->samples == samples) return;
    try {
        const std::chrono::duration<double> since = now - account_.phases().run_begun();
        curve_->note(samples, since.count(), film.picture(files_.scale()));
    } catch (const Error& error) {
        account_.alert(std::string("no curve of errors: ") + error.what());
    }
    noted = curve_->last();
}

std::string RunRecorder::end_early() {
    auto& samples = account_.report().settings["samples"];
    const auto wanted = samples;
    steps_.end();
    note_error(Clock::now());
    const Film& film = steps_.picture();
    if (film.mean_samples() == 0) return {};
    samples = std::to_string(film.format().samples);
    if (film.covered() < 1) return fmt::format("{:.1f} % of the picture", std::floor(1000 * film.covered()) / 10);
    const bool even = film.complete() && !film.format().adaptive();
    const double mean = film.mean_samples();
    return fmt::format("{:.{}g} sample{} per pixel of {}{}", mean, even ? 10 : 4, mean == 1 ? "" : "s", wanted,
                       even ? "" : ", on average");
}

void RunRecorder::begin_anew() {
    if (checkpoint_) checkpoint_->begin_anew();
    if (so_far_.is_preview()) account_.alert("the preview that is there may hold false light");
    steps_.clear();
    blocks_ = 0;
    account_.progress().update(0, Clock::now());
    if (auto* watcher = account_.watcher()) watcher->look(steps_.film());
}

void RunRecorder::keep_checkpoint(const std::string& exr, std::map<std::string, std::string> recipe,
                                  std::chrono::seconds period, std::unique_ptr<FilmMemo> memo) {
    checkpoint_.emplace(steps_.film(), exr, std::move(recipe), period);
    checkpoint_->remember_in(std::move(memo));
}

Graph RunRecorder::take_up_checkpoint(bool resume, const Graph& graph, const Registry& registry) {
    Graph wanted = graph;
    if (!resume && !checkpoint_->remembers()) return wanted;
    const auto file = checkpoint_->file().string();
    const auto restore = [this](FilmState state) { steps_.restore(std::move(state)); };
    const bool there = resume && checkpoint_->take_up(restore);
    if (resume) account_.say(there ? "going on from " + file : "there is no " + file + "; beginning at the beginning");
    if (!there && checkpoint_->remembers()) {
        const bool known = checkpoint_->recall(restore);
        checkpoint_->recall_lights(graph, registry);
        const KnownLights& lights = checkpoint_->lights();
        if (!lights.empty()) wanted = lights.rest();
        account_.set("memo", fmt::format("{:.10g}", known ? steps_.film().mean_samples() : 0));
        account_.set("memo_layers", joined(lights.names()));
        account_.say(!lights.empty()
                         ? "memo: layers that are there: " + joined(lights.names()) + "; the others are rendered"
                     : !known ? std::string("memo: nothing of this picture is there; all of it is rendered")
                     : steps_.finished()
                         ? "memo: all of this picture is there; nothing is rendered"
                         : fmt::format("memo: {:.10g} samples per pixel of {} are there; the others are rendered",
                                       steps_.film().mean_samples(), steps_.film().format().samples));
    }
    blocks_ = steps_.found();
    if (there) checkpoint_->found(blocks_);
    if (blocks_) account_.progress().found_done(blocks_, Clock::now());
    return wanted;
}

bool RunRecorder::save_checkpoint(std::optional<std::chrono::duration<double>> most) {
    if (!keeps_checkpoint()) return false;
    if (!checkpoint_->save(blocks_, most))
        account_.say("there is no time for another checkpoint: the last one stays as it is");
    return true;
}

void RunRecorder::end_checkpoint(bool stays) {
    if (!checkpoint_) return;
    if (steps_.finished()) checkpoint_->remember();
    try {
        if (stays)
            save_checkpoint();
        else
            checkpoint_->remove();
    } catch (const std::exception& error) {
        account_.alert(std::string("samples can't be added to the picture later: ") + words_of(error));
    }
    checkpoint_.reset();
}

void RunRecorder::write_picture(const std::string& exr) {
    files_.write(exr);
    if (steps_.film().format().halves()) files_.write_clean(exr);
    so_far_.is_whole();
    const Film& film = steps_.picture();
    auto& report = account_.report();
    if (film.complete())
        if (const auto words = firefly_words(files_.now(), report, exr);
            !words.empty() && std::find(report.warnings.begin(), report.warnings.end(), words) == report.warnings.end())
            account_.warn(words);  // once: a disk may have been full
    if (film.format().adaptive() || !film.complete())
        account_.set("mean_samples", fmt::format("{:.2f}", film.mean_samples()));
}

void RunRecorder::write_report(const std::string& exr, const std::string& outcome, const std::string& trace) {
    account_.end(outcome, trace);
    account_.report().counters["repeated_tiles"] = repeated_;
    lightnet::write_report(report_file(exr, outcome), account_.report());
}

// The report beside a picture tells how that came about: a run that has written none leaves one that is there its own.
// DECISIONS: report-of-what-is-there
std::filesystem::path RunRecorder::report_file(const std::string& exr, const std::string& outcome) const {
    const auto of_failure = failed_report_beside(exr);
    std::error_code ignored;
    if (!files_.wrote(exr) && outcome != "done" && std::filesystem::exists(exr, ignored)) return of_failure;
    if (why_not_replaced(of_failure, report_beginning).empty()) std::filesystem::remove(of_failure, ignored);
    return report_beside(exr);
}

}  // namespace lightnet
