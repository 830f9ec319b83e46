#include "tools/cli/auto_lighting.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <ostream>
#include <tuple>
#include <utility>

#include "core/base/json.hpp"
#include "core/base/own_process.hpp"
#include "core/base/plain_file.hpp"
#include "core/film/tile.hpp"
#include "core/readers/statistics.hpp"
#include "tools/cli/lightings.hpp"
#include "tools/cli/loading.hpp"
#include "tools/cli/request_of.hpp"
#include "tools/session/run_figures.hpp"
#include "tools/support/run_report.hpp"
#include "tools/trials/trial_laps.hpp"

namespace lightnet {
namespace {

constexpr double trial_samples = 8;
constexpr double part_of_work = 0.0075;                       // of the picture's samples: what a trial has
constexpr double least_pixels = 1024, most_pixels = 48 * 48;  // of a trial

/// How a picture is tried: smaller, and with few samples.
struct TrialSize {
    PictureSize size;
    std::uint32_t samples = 1;
    double shrinks = 1;  // sides are so many times as long
};

TrialSize trial_size(const PictureSize& whole, double pixels, double samples) {
    const double own = std::min(trial_samples, samples);
    const double wanted = std::clamp(part_of_work * pixels * samples / own, least_pixels, most_pixels);
    const double shrinks = std::min(1.0, std::sqrt(wanted / pixels));
    const auto side = [&](std::uint32_t length) {
        return std::max(1u, static_cast<std::uint32_t>(std::lround(shrinks * length)));
    };
    return {{side(whole.width), side(whole.height)}, static_cast<std::uint32_t>(own), shrinks};
}

std::optional<PictureCrop> shrunk(const std::optional<PictureCrop>& crop, const TrialSize& trial) {
    if (!crop) return std::nullopt;
    const auto edge = [&](std::uint32_t place, std::uint32_t most) {
        return std::min(most, static_cast<std::uint32_t>(std::lround(trial.shrinks * place)));
    };
    const auto [width, height] = trial.size;
    PictureCrop made{edge(crop->x0, width), edge(crop->y0, height), edge(crop->x1, width), edge(crop->y1, height)};
    if (made.x0 >= made.x1) made.x0 = std::min(made.x0, width - 1), made.x1 = made.x0 + 1;
    if (made.y0 >= made.y1) made.y0 = std::min(made.y0, height - 1), made.y1 = made.y0 + 1;
    return made;
}

// Nothing but the picture of the trial: no hosts, and nobody is told or shown anything.
RunningOptions running_of_trial(const RunningOptions& whole, const TrialSize& trial) {
    RunningOptions own;
    own.seed = whole.seed;
    own.threads = whole.threads;
    own.tuning = whole.tuning;
    own.tuning.cache = "none";  // what earlier runs have kept would make preparing seem to be free
    own.tuning.verify = 0;
    own.forget = true;
    own.memo = false;
    own.progress = ProgressMode::none;
    own.picture.samples = trial.samples;
    own.picture.size = trial.size;
    own.picture.crop = shrunk(whole.picture.crop, trial);
    own.picture.camera = whole.picture.camera;
    own.picture.output = "trial.exr";
    return own;
}

AskedPicture asked_by(const PictureOptions& picture) {
    const auto& [size, crop] = std::tie(picture.size, picture.crop);
    const double pixels =
        crop ? double(crop->x1 - crop->x0) * (crop->y1 - crop->y0) : double(size->width) * size->height;
    return {pixels, double(picture.samples.value_or(usual_samples))};
}

class Trials {
public:
    Trials(const UnlitPicture& picture, const Launcher& launcher)
        : picture_(picture),
          launcher_(launcher),
          size_(picture.running.picture.size.value()),
          asked_(asked_by(picture.running.picture)) {
        for (const Lighting& lighting : lightings())
            if (lighting.on_trial) add(lighting);
        if (std::all_of(requests_.begin(), requests_.end(), [](const auto& one) { return !one.excluded.empty(); }))
            throw UserError(first_problems_);
    }

    LightingOfRun choose() {
        say();
        TrialCourse course;
        if (picture_.read) course.triangles = double(statistics_of(picture_.read->scene).instanced_triangles);
        requests_.front().request.read = picture_.read;
        course.run = launcher_.try_run;
        course.processor_seconds = processor_seconds;
        course.asked = asked_;
        const auto trials = run_trials(requests_, course);
        auto best = best_lighting(trials, asked_);
        while (!requests_[best].excluded.empty()) ++best;  // no trial came to its end: the first that may run
        return {trials[best].name, words_of_choice(trials, asked_, best)};
    }

private:
    void say() const {
        const auto progress = picture_.running.progress;
        if (progress == ProgressMode::none || progress == ProgressMode::json) return;
        launcher_.err << "trials of " << requests_.size() << " lightings" << std::endl;
    }

    void add(const Lighting& lighting) {
        auto excluded = why_not(lighting);
        const auto trial = trial_size(size_, asked_.pixels, asked_.samples);
        TrialRequest added{lighting.name,
                           request(lighting, running_of_trial(picture_.running, trial), {}),
                           std::move(excluded),
                           lighting.is_biased,
                           lighting.is_biased && lighting.covers != Covers::caustics,
                           known_of(lighting, trial)};
        fit_pixels(trial, added);
        requests_.push_back(std::move(added));
    }

    // What excludes it shows when the whole picture's run is checked: hosts that name other nodes, gains of layers.
    std::string why_not(const Lighting& lighting) {
        try {
            request(lighting, picture_.running, picture_.hosts);
            return {};
        } catch (const UserError& error) {
            if (first_problems_.empty()) first_problems_ = error.problems();
            return error.problems().front().what;
        }
    }

    RunRequest request(const Lighting& lighting, RunningOptions running, const Hosts& hosts) const {
        RenderedScene scene = picture_.scene;
        scene.lighting = lighting.name;
        running.progress = ProgressMode::none;
        RenderGraph made = render_graph(scene);
        return request_of(running, launcher_,
                          validate_job({std::move(made.graph), hosts, std::move(made.problems)}, running.picture,
                                       launcher_.registry));
    }

    LightingTrial known_of(const Lighting& lighting, const TrialSize& trial) const {
        LightingTrial known;
        known.samples = trial.samples;
        known.covers = lighting.covers;
        if (lighting.is_biased) known.preparing_grows = 1 / trial.shrinks;  // records lie along what is seen
        if (lighting.covers == Covers::caustics) {
            known.preparing_grows = std::ceil(asked_.samples / samples_per_block);  // maps of each pass
            known.shared_falls = 2.0 / 3;
        }
        if (lighting.learns)
            known.preparing_grows =
                lessons_of(std::uint64_t(asked_.pixels), std::uint64_t(asked_.samples)) / lessons_of(0, 0);
        return known;
    }

    // A pixel of a trial is as large as one of the picture, and others lie between them: edges would make more noise in
    // large ones.
    static void fit_pixels(const TrialSize& size, TrialRequest& trial) {
        constexpr double half_a_pixel = 0.5;
        for (Node& node : trial.request.graph.nodes)
            if (node.kind == "RayTracer") node.params["filter_radius"].data = half_a_pixel * size.shrinks;
    }

    const UnlitPicture& picture_;
    const Launcher& launcher_;
    const PictureSize size_;
    AskedPicture asked_;
    std::vector<TrialRequest> requests_;
    std::vector<Problem> first_problems_;
};

}  // namespace

LightingOfRun lighting_by_trials_of(const UnlitPicture& picture, const Launcher& launcher) {
    if (!launcher.try_run) throw UserError({"--lighting", 0}, "auto: there are no trials here");
    return Trials(picture, launcher).choose();
}

LightingOfRun lighting_of_earlier(const std::vector<std::string>& pictures) {
    for (const auto& picture : pictures)
        for (const auto& file : {report_beside(picture), failed_report_beside(picture)}) try {
                const Json report = parse_json(PlainFile(file, longest_report).text(), {.depth = 64});
                const Json& settings = report.at("settings");
                if (!settings.has("lighting") || !settings.has("lighting_trials")) continue;
                const auto& name = settings.at("lighting").text();
                if (find_lighting(name))  // an earlier version may have chosen among others
                    return {name, settings.at("lighting_trials").text()};
            } catch (const Error&) {  // there is none, or it is no report: nothing to go on with
            }
    return {};
}

}  // namespace lightnet
