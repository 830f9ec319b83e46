#include "tools/session/picture_so_far.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/base/error.hpp"

namespace lightnet {

void PictureSoFar::preview(const std::string& exr, double seconds) {
    preview_ = Preview{exr, Pace(std::chrono::duration<double>(seconds), Pace::Clock::now())};
}

void PictureSoFar::look() {
    if (preview_ && preview_->pace.due(Pace::Clock::now()) && !steps_.finished()) write_preview();
}

std::string PictureSoFar::preview_now(const std::string& exr) {
    const auto usual = std::exchange(preview_, Preview{exr, Pace(std::chrono::seconds(0), Pace::Clock::now())});
    auto why_not = write_preview();
    preview_ = usual;
    return why_not;
}

std::string PictureSoFar::write_preview() {
    const auto begun = Pace::Clock::now();
    std::string why_not;
    try {
        files_.write(preview_->exr);
        is_preview_ = true;
        RunReport report = account_.report();
        report.outcome = "preview";
        report.settings["done"] = fmt::format("{:.4f}", steps_.done());
        report.settings["mean_samples"] = fmt::format("{:.2f}", steps_.picture().mean_samples());
        write_report(report_beside(preview_->exr), report);
        if (!std::exchange(preview_->said, true)) account_.say(preview_->exr + " shows the picture so far");
    } catch (const Error& error) {
        account_.alert(why_not = std::string("no preview: ") + error.what());
    }
    // Writing takes at most a tenth of the time, however large the picture.
    const auto now = Pace::Clock::now();
    preview_->pace.put_off(now, 9 * (now - begun));
    return why_not;
}

void PictureSoFar::show_steps(const std::string& exr, std::function<void(const PictureShown&)> shown) {
    step_exr_ = exr;
    shown_ = std::move(shown);
}

// What is lost of it comes with the next step.
void PictureSoFar::step() {
    const double samples = steps_.picture().mean_samples();
    if (!shown_ || steps_.picture().covered() < 1 || samples <= step_) return;
    step_ = samples;
    const auto begun = Pace::Clock::now();
    try {
        files_.write(step_exr_, true);
        tell_shown(false, seconds_since(begun));
    } catch (const Error& error) {
        account_.alert(std::string("the picture so far isn't shown: ") + error.what());
    }
}

void PictureSoFar::tell_shown(bool finished, double writing) {
    if (!shown_) return;
    const Film& film = steps_.picture();
    const RunReport& report = account_.report();
    PictureShown shown{film.mean_samples(), finished, film.format().coarse, report.warnings, {}};
    if (shown.coarse) shown.without = without_;
    for (const auto& phase : report.phases) shown.took.emplace_back(phase.name, phase.seconds);
    if (const auto begun = account_.phases().begun()) shown.took.back().second = seconds_since(*begun) - writing;
    if (writing > 0) shown.took.emplace_back("write", writing);
    shown_(shown);
}

}  // namespace lightnet
