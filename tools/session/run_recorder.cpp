#include "tools/session/run_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <utility>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/own_files.hpp"
#include "core/base/own_process.hpp"
#include "core/base/plain_file.hpp"
#include "core/base/this_machine.hpp"
#include "core/base/words_of.hpp"
#include "core/film/clean/rounds.hpp"
#include "core/film/exr.hpp"
#include "core/network/graph/layout.hpp"
#include "core/run/message/message.hpp"
#include "tools/session/firefly_words.hpp"
#include "tools/session/run_figures.hpp"
#include "tools/session/run_trace.hpp"
#include "tools/support/log_line.hpp"
#include "tools/support/summary.hpp"
#include "tools/watch/report_page.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

// False also where there is no such file.
bool holds(const std::string& file, const std::string& bytes) try {
    return PlainFile(file, bytes.size()).text() == bytes;
} catch (const Error&) {
    return false;
}

// As hosts files call it.
std::string shown_host(const std::string& host) { return host.empty() ? std::string(own_process) : host; }

}  // namespace

namespace {

Progress::Style style_of(ProgressMode progress, std::optional<Progress::Series> series) {
    auto style = Progress::style_of_stderr(progress);
    style.series = series;
    return style;
}

}  // namespace

RunRecorder::RunRecorder(FilmFormat format, ProgressMode progress, std::uint32_t tile, RunReport report,
                         std::optional<Progress::Series> series)
    : steps_(std::move(format), tile),
      report_(std::move(report)),
      all_blocks_(work_in(tiles_of(film().format().work(), tile, film().format().samples))),
      progress_(all_blocks_, style_of(progress, series), std::cerr, Clock::now()) {}

void RunRecorder::end_phase(Clock::time_point now) {
    end_doing(now);
    if (phase_begun_) {
        auto& phase = report_.phases.back();
        phase.seconds = std::chrono::duration<double>(now - *phase_begun_).count();
        phase.processor = seconds_of_this_thread() - phase.processor;
    }
    phase_begun_.reset();
}

void RunRecorder::phase(const std::string& name) {
    const auto now = Clock::now();
    end_phase(now);
    report_.phases.push_back({name, 0, seconds_of_this_thread()});
    phase_begun_ = now;
    progress_.phase(name, now);
    if (watcher_) watcher_->phase(name);
}

void RunRecorder::stand_aside() {
    end_phase(Clock::now());
    progress_.stand_aside();
}

void RunRecorder::say(const LogEntry& entry) {
    Progress::Marks marks{{"time", log_time(std::chrono::system_clock::now())},
                          {"level", log_level(entry.level)},
                          {"host", machine_name()}};
    const auto run = report_.settings.find("run");
    if (run != report_.settings.end()) marks.emplace_back("run", run->second);
    if (entry.level == LogLevel::error)
        progress_.insist(entry.text, marks);
    else
        progress_.say(entry.text, marks);
    if (watcher_) watcher_->say(entry.text);
}

void RunRecorder::name_run(std::uint64_t number) { set("run", public_name_of_run(number)); }

void RunRecorder::show_outcome(const std::string& outcome, ForecastCurve forecast) {
    if (!watcher_) return;
    watcher_->progress(steps_.done(), {}, report_.moves);
    watcher_->finish(steps_.picture(), outcome, std::move(forecast));
}

void RunRecorder::warn(const std::string& text) {
    report_.warnings.push_back(text);
    say({LogLevel::warning, "warning: " + text});
}

// DECISIONS: errors-are-heard
void RunRecorder::alert(const std::string& text) {
    auto& said = report_.warnings;
    if (std::find(said.begin(), said.end(), text) != said.end()) return;  // a full disk is tried again and again
    said.push_back(text);
    say({LogLevel::error, "lightnet: " + text});
}

void RunRecorder::preparing(const PrepareProgress& progress) {
    const bool anew = !report_.phases.empty() && report_.phases.back().name == "render";  // between two passes
    if (progress.node.empty() || anew) return;
    if (watcher_) watcher_->preparing(progress);
    if (std::exchange(last_prepared_, progress.node) != progress.node) say("preparing " + progress.node);
    const auto now = Clock::now();
    const auto what = progress.what.empty() ? "" : ": " + progress.what;
    progress_.step(fmt::format("{} {}/{}{}", progress.node, progress.position, progress.nodes, what), progress.done,
                   progress.total, now);
    auto& did = report_.preparing;
    if (doing_since_ && did.back().node == progress.node && did.back().what == progress.what) return;
    end_doing(now);
    if (progress.what.empty()) return;
    did.push_back({progress.node, progress.what, 0});
    doing_since_ = now;
}

void RunRecorder::end_doing(Clock::time_point now) {
    if (doing_since_) report_.preparing.back().seconds = std::chrono::duration<double>(now - *doing_since_).count();
    doing_since_.reset();
}

void RunRecorder::expose(float scale) {
    scale_ = scale;
    steps_.film().expose(scale);
}

void RunRecorder::preview(const std::string& exr, double seconds) {
    preview_ = Preview{exr, Pace(std::chrono::duration<double>(seconds), Clock::now())};
}

std::vector<Tile> RunRecorder::take(const Tile& tile, std::span<const Rgb> pixels) {
    Film& film = steps_.film_of(tile);
    const bool added = film.add(tile, pixels);
    const bool wanted = added || !film.has(tile);
    auto next = wanted ? film.more(tile) : std::vector<Tile>{};
    const auto of_round =
        added && film.round_is_over() ? apart([&] { return end_round_if_over(film); }) : std::vector<Tile>{};
    next.insert(next.end(), of_round.begin(), of_round.end());
    if (added && steps_.lasts(tile)) blocks_ += tile.blocks();
    if (!wanted) ++repeated_;
    if (watcher_) watcher_->taken(tile), watcher_->look(film);
    progress_.update(work_shown(), Clock::now());
    if (preview_ && preview_->pace.due(Clock::now()) && !steps_.finished()) write_preview();
    if (checkpoint_ && !tile.coarse)
        if (const auto why = checkpoint_->save_if_due(blocks_); !why.empty()) alert("no checkpoint: " + why);
    return next;
}

// In blocks of tiles, which differ in size where cells decide.
std::uint64_t RunRecorder::work_shown() const {
    return film().format().adaptive() ? static_cast<std::uint64_t>(steps_.done() * double(all_blocks_)) : blocks_;
}

void RunRecorder::show(const Watcher::Hosts& hosts) {
    const bool renders = !report_.phases.empty() && report_.phases.back().name == "render";
    watcher_->progress(steps_.done(), renders ? progress_.seconds_left(Clock::now()) : std::nullopt, report_.moves);
    watcher_->look(steps_.at_work(), hosts);
    for (const auto& line : watcher_->news()) say(line);
}

std::string RunRecorder::preview_now(const std::string& exr) {
    const auto usual = std::exchange(preview_, Preview{exr, Pace(std::chrono::seconds(0), Clock::now())});
    auto why_not = write_preview();
    preview_ = usual;
    return why_not;
}

// A preview that can't be written is no reason to lose the picture.
std::string RunRecorder::write_preview() {
    const auto begun = Clock::now();
    std::string why_not;
    try {
        write_files(preview_->exr);
        last_.is_preview = true;
        RunReport report = report_;
        report.outcome = "preview";
        report.settings["done"] = fmt::format("{:.4f}", steps_.done());
        report.settings["mean_samples"] = fmt::format("{:.2f}", steps_.picture().mean_samples());
        lightnet::write_report(report_beside(preview_->exr), report);
        if (!std::exchange(preview_->said, true)) say(preview_->exr + " shows the picture so far");
    } catch (const Error& error) {
        alert(why_not = std::string("no preview: ") + error.what());
    }
    // Writing takes at most a tenth of the time, however large the picture.
    const auto now = Clock::now();
    preview_->pace.put_off(now, 9 * (now - begun));
    return why_not;
}

void RunRecorder::keep_checkpoint(const std::string& exr, std::map<std::string, std::string> recipe,
                                  std::chrono::seconds period, std::unique_ptr<FilmMemo> memo) {
    checkpoint_.emplace(steps_.film(), exr, std::move(recipe), period);
    checkpoint_->remember_in(std::move(memo));
}

void RunRecorder::take_up_checkpoint(bool resume) {
    if (!resume && !checkpoint_->remembers()) return;
    const auto file = checkpoint_->file().string();
    const auto restore = [this](FilmState state) { steps_.restore(std::move(state)); };
    const bool there = resume && checkpoint_->take_up(restore);
    if (resume) say(there ? "going on from " + file : "there is no " + file + "; beginning at the beginning");
    if (!there && checkpoint_->remembers()) {
        const bool known = checkpoint_->recall(restore);
        set("memo", fmt::format("{:.10g}", known ? film().mean_samples() : 0));
        say(!known ? std::string("memo: nothing of this picture is there; all of it is rendered")
            : steps_.finished()
                ? "memo: all of this picture is there; nothing is rendered"
                : fmt::format("memo: {:.10g} samples per pixel of {} are there; the others are rendered",
                              film().mean_samples(), film().format().samples));
    }
    blocks_ = steps_.found();
    if (there) checkpoint_->found(blocks_);
    if (blocks_) progress_.found_done(blocks_, Clock::now());
}

void RunRecorder::begin_anew() {
    if (checkpoint_) checkpoint_->begin_anew();
    if (last_.is_preview) alert("the preview that is there may hold false light");
    steps_.clear();
    blocks_ = 0;
    progress_.update(0, Clock::now());
    if (watcher_) watcher_->look(film());
}

bool RunRecorder::save_checkpoint(std::optional<std::chrono::duration<double>> most) {
    if (!keeps_checkpoint()) return false;
    if (!checkpoint_->save(blocks_, most)) say("there is no time for another checkpoint: the last one stays as it is");
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
        alert(std::string("samples can't be added to the picture later: ") + words_of(error));
    }
    checkpoint_.reset();
}

void RunRecorder::use(const HostState& host) {
    const auto known = std::find_if(report_.hosts.begin(), report_.hosts.end(),
                                    [&](const auto& one) { return one.host == shown_host(host.name); });
    if (known != report_.hosts.end()) {
        known->peak_memory = std::max(known->peak_memory, host.peak_memory);
        return;
    }
    const auto& machine = host.machine;
    report_.hosts.push_back({shown_host(host.name), host.state, machine.name, machine.cpu, machine.isa, machine.version,
                             machine.cores, machine.memory, host.places, host.peak_memory});
}

void RunRecorder::moved(const Move& move) {
    MoveReport entry{steady_nanoseconds(), std::chrono::duration<double>(Clock::now() - begun_).count(), move.gain, {}};
    entry.nodes = move.who;
    say(fmt::format("{}; what is left is to take {:.0f} % less time", fmt::join(move.who, ", "), 100 * move.gain));
    report_.moves.push_back(std::move(entry));
}

void RunRecorder::name_bad_light(const Graph& graph) {
    const auto& counts = counters_.not_finite;
    for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
        const auto count = counts.find(graph.nodes[node].name);
        const auto inputs = graph.inputs_of(node);
        const bool passed_on = std::any_of(inputs.begin(), inputs.end(),
                                           [&](std::size_t input) { return counts.contains(graph.nodes[input].name); });
        if (count != counts.end() && !passed_on)
            alert(fmt::format("{} '{}' gave {} answers that are not finite", graph.nodes[node].kind,
                              graph.nodes[node].name, count->second));
    }
    for (const auto& [node, count] : counters_.off_surface)
        alert(
            fmt::format("'{}' asked {} times about points that no surface is near; they count as black", node, count));
    for (const auto& [node, count] : counters_.lost_rays)
        alert(
            fmt::format("'{}' sent {} rays that are not finite, have no direction, or begin too far away; they meet "
                        "nothing",
                        node, count));
    for (const auto& [node, count] : counters_.unsound_questions)
        alert(
            fmt::format("'{}' was asked {} questions whose numbers are not finite; they count as black", node, count));
    const auto lost = steps_.picture().lost();
    for (std::size_t layer = 0; layer < lost.size(); ++layer)
        if (lost[layer])
            alert(fmt::format("{} colours of layer '{}' were not finite and count as black", lost[layer],
                              film().format().name_of(layer)));
}

void RunRecorder::use(const Plan& plan, const Graph& graph) {
    report_.places.clear();
    report_.nodes = nodes_without_figures(graph);
    graph_nodes_.clear();
    for (const auto& node : graph.nodes) graph_nodes_.push_back(node.name);
    for (const auto& [node, count] : shards_in(graph))
        report_.settings["layout." + node] = fmt::format("sharded, {} sectors", count);
    for (std::uint32_t place = 0; place < plan.places.size(); ++place) {
        PlaceReport entry;
        entry.host = shown_host(plan.places[place].host), entry.index = plan.places[place].index;
        for (std::size_t node = 0; node < plan.places_of.size(); ++node)
            if (std::count(plan.places_of[node].begin(), plan.places_of[node].end(), place))
                entry.nodes.push_back(graph.nodes[node].name);
        report_.places.push_back(std::move(entry));
    }
}

void RunRecorder::write_picture(const std::string& exr) {
    write_files(exr);
    if (film().format().halves()) write_clean(exr);
    last_.is_preview = false;
    const Film& film = steps_.picture();
    if (film.complete())
        if (const auto words = firefly_words(picture_now(), report_.nodes, exr);
            !words.empty() &&
            std::find(report_.warnings.begin(), report_.warnings.end(), words) == report_.warnings.end())
            warn(words);  // once: a disk may have been full
    if (film.format().adaptive() || !film.complete())
        report_.settings["mean_samples"] = fmt::format("{:.2f}", film.mean_samples());
}

bool RunRecorder::is_written(const std::string& exr) const { return holds(exr, exr_of(picture_now())); }

void RunRecorder::write_report_page(const std::string& html) {
    expect_ours(html, report_page_beginning);
    write_file(html, report_page(*watcher_, steps_.picture(), facts_of(report_, watcher_->at_work())));
}

void RunRecorder::conclude(const Hosts& asked, double exposure) {
    auto layers = film().format().layers;
    layers.insert(layers.end(), film().format().shown.begin(), film().format().shown.end());
    if (film().format().alpha) layers.emplace_back("A");
    if (const auto& error = report_.error)
        say(fmt::format("relMSE to {}: {:g}", error->reference, error->relative_square));
    say(summary_of({report_, layers, asked, last_.brightness, exposure, png_.stops, last_.stops}));
}

void RunRecorder::write_report(const std::string& exr, const std::string& outcome) {
    const auto now = Clock::now();
    end_phase(now);
    progress_.finish(now);
    report_.outcome = outcome;
    report_.peak_memory = peak_memory();
    write_trace();
    report_.counters = counters_.named();
    add_figures(report_, counters_.places);
    report_.counters["repeated_tiles"] = repeated_;
    lightnet::write_report(report_file(exr, outcome), report_);
}

// The report beside a picture tells how that came about: a run that has written none leaves one that is there its own.
// DECISIONS: report-of-what-is-there
std::filesystem::path RunRecorder::report_file(const std::string& exr, const std::string& outcome) const {
    const auto of_failure = failed_report_beside(exr);
    std::error_code ignored;
    if (!written_.contains(exr) && outcome != "done" && std::filesystem::exists(exr, ignored)) return of_failure;
    if (why_not_replaced(of_failure, report_beginning).empty()) std::filesystem::remove(of_failure, ignored);
    return report_beside(exr);
}

// A trace that can't be written is no reason to lose the report.
void RunRecorder::write_trace() {
    if (trace_.empty() || counters_.traces.empty()) return;
    try {
        write_file(trace_, to_trace_json(counters_.traces, graph_nodes_, report_.moves));
        report_.outputs.push_back(trace_);
    } catch (const Error& error) {
        alert(std::string("no trace: ") + error.what());
    }
}

}  // namespace lightnet
