// The steps of a run, and its distance from a reference at each.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "tools/session/run_recorder.hpp"

namespace lightnet {

void RunRecorder::limit_time(double seconds) {
    if (seconds <= 0) return;
    steps_.limit({std::chrono::duration<double>(seconds), begun_});
    progress_.end_by(*steps_.limit().end());
}

std::optional<std::chrono::milliseconds> RunRecorder::time_left() const {
    const auto end = steps_.limit().end();
    if (!end) return std::nullopt;
    return std::max(std::chrono::ceil<std::chrono::milliseconds>(*end - Pace::Clock::now()),
                    std::chrono::milliseconds(0));
}

void RunRecorder::compare_with(ErrorCurve curve) {
    curve_ = std::move(curve);
    steps_.by_groups();
}

std::vector<Tile> RunRecorder::next_step() {
    const auto now = Pace::Clock::now();
    auto tiles = steps_.next(now);
    note_error(now);
    if (shown_ && !tiles.empty()) write_step();
    steps_.begin(Pace::Clock::now());
    return tiles;
}

void RunRecorder::show_steps(const std::string& exr, std::function<void(const PictureShown&)> shown) {
    steps_.by_groups(true);
    step_exr_ = exr;
    shown_ = std::move(shown);
}

// What is lost of it comes with the next step.
void RunRecorder::write_step() {
    const double samples = steps_.picture().mean_samples();
    if (steps_.picture().covered() < 1 || samples <= last_.step) return;
    last_.step = samples;
    const auto begun = Pace::Clock::now();
    try {
        write_files(step_exr_, true);
        tell_shown(false, seconds_since(begun));
    } catch (const Error& error) {
        alert(std::string("the picture so far isn't shown: ") + error.what());
    }
}

void RunRecorder::tell_shown(bool finished, double writing) {
    if (!shown_) return;
    const Film& film = steps_.picture();
    PictureShown shown{film.mean_samples(), finished, film.format().coarse, report_.warnings, {}};
    for (const auto& phase : report_.phases) shown.took.emplace_back(phase.name, phase.seconds);
    if (phase_begun_) shown.took.back().second = seconds_since(*phase_begun_) - writing;
    if (writing > 0) shown.took.emplace_back("write", writing);
    shown_(shown);
}

// Of the picture that would be written now, unless that has been noted.
void RunRecorder::note_error(Pace::Clock::time_point now) {
    const Film& film = steps_.picture();
    if (!curve_ || film.covered() < 1) return;
    const double samples = film.mean_samples();
    if (report_.error && report_.error->samples == samples) return;
    try {
        curve_->note(samples, std::chrono::duration<double>(now - begun_).count(), film.picture(scale_));
    } catch (const Error& error) {
        alert(std::string("no curve of errors: ") + error.what());
    }
    report_.error = curve_->last();
}

std::string RunRecorder::end_early() {
    const auto wanted = report_.settings["samples"];
    steps_.end();
    note_error(Pace::Clock::now());
    const Film& film = steps_.picture();
    if (film.mean_samples() == 0) return {};
    report_.settings["samples"] = std::to_string(film.format().samples);
    if (film.covered() < 1) return fmt::format("{:.1f} % of the picture", std::floor(1000 * film.covered()) / 10);
    const bool even = film.complete() && !film.format().adaptive();
    const double mean = film.mean_samples();
    return fmt::format("{:.{}g} sample{} per pixel of {}{}", mean, even ? 10 : 4, mean == 1 ? "" : "s", wanted,
                       even ? "" : ", on average");
}

}  // namespace lightnet
