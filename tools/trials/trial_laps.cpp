#include "tools/trials/trial_laps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/base/json.hpp"
#include "core/base/plain_file.hpp"
#include "core/base/temporary_folder.hpp"
#include "core/film/exr.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/run_report.hpp"
#include "tools/support/signals.hpp"
#include "tools/trials/trial_errors.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;
constexpr double for_ever = 1e9;
constexpr std::uint64_t seeds_of_pair = std::tuple_size_v<PicturePair>;
constexpr double most_of_sample = 0.5;  // what one takes between records, beside path tracing's
constexpr double looks_of_first = 0.4;  // part of its samples that tell which light paths make the error

/// What phases of a run took, by its report: seconds on the clock.
struct Phases {
    double all = 0, preparing = 0, rendering = 0;
};

// The part of preparing that goes into records along what is seen, by what nodes said of it.
double part_of_records(const Json& report) {
    if (!report.has("preparing")) return 0;
    std::set<std::string> of_records;
    for (const auto& node : report.at("nodes").list())
        if (node.at("kind").text() == "IrradianceCache") of_records.insert(node.at("name").text());
    double records = 0, all = 0;
    for (const auto& step : report.at("preparing").list()) {
        const double seconds = step.at("seconds").number();
        all += seconds;
        if (of_records.contains(step.at("node").text())) records += seconds;
    }
    return all > 0 ? records / all : 0;
}

Phases phases_of(const Json& report) {
    Phases phases;
    for (const auto& phase : report.at("phases").list()) {
        const double seconds = phase.at("seconds").number();
        phases.all += seconds;
        if (phase.at("name").text() == "prepare") phases.preparing += seconds;
        if (phase.at("name").text() == "render") phases.rendering += seconds;
    }
    return phases;
}

void take_noise(const Json& report, LightingTrial& figures) {
    if (!report.has("noise")) return;
    const Json& noise = report.at("noise");
    figures.own_error = noise.at("relmse").number();
    for (const auto& paths : noise.at("paths").list())
        for (std::size_t kind = 0; kind < path_kinds; ++kind)
            if (paths.at("word").text() == word_of(static_cast<PathKind>(kind)))
                figures.parts[kind] = paths.at("part").number();
}

class Laps {
public:
    explicit Laps(const TrialCourse& course) : course_(course) {}

    /// Adds what it took; preparing is that of the last lap. None: its time was over.
    std::optional<Picture> run(const TrialRequest& trial, std::uint64_t lap, LightingTrial& figures, double most) {
        RunRequest request = trial.request;
        const auto file = fs::path(folder_.path()) / "trial.exr";
        request.output = file.string();
        if (lap > 0) request.read.reset();  // the first has taken it away
        request.looks = lap == 0 ? looks_of_first : 0;
        // None of the picture that is asked for; but what nodes prepare is for that, too.
        if (lap < seeds_of_pair) request.seed += 1 + lap;
        const double before = course_.processor_seconds();
        const int code = course_.run(request, most);
        const double used = course_.processor_seconds() - before;
        if (code != exit_code::done) used_ += used;
        if (code == exit_code::interrupted) {
            if (watch_signals().any) throw TrialInterrupted{};
            return std::nullopt;
        }
        if (code != exit_code::done) throw Error(trial.name, "its trial ended with code " + std::to_string(code));
        const Json report = parse_json(PlainFile(report_beside(file), longest_report).text(), {.depth = 64});
        const auto [all, preparing, rendering] = phases_of(report);
        const double processors = used / std::max(1e-9, all);
        const double prepared = preparing * processors, rendered = rendering * processors;
        // The first of all laps loads the scene and builds it for all.
        used_ += used_ > 0 ? used : rendered;
        figures.preparing = prepared, figures.rendering += rendered;
        // What is none of the records is there already when the picture wants it.
        if (trial.records) figures.preparing *= part_of_records(report);
        take_noise(report, figures);
        Picture picture = read_exr(file);
        figures.pixels = double(picture.beauty.size());
        return picture;
    }
    /// Seconds of all so far.
    double used() const { return used_; }

private:
    const TrialCourse& course_;
    TemporaryFolder folder_{"trials"};
    double used_ = 0;
};

// DECISIONS: lighting-by-trials
class TrialSeries {
public:
    TrialSeries(const std::vector<TrialRequest>& requests, const TrialCourse& course)
        : requests_(requests), course_(course), laps_(course) {}

    std::vector<LightingTrial> run() {
        run_first();
        promise_ = promise_of(trials_.front(), course_.asked, course_.triangles);
        if (!is_allowed(promise_.covers)) promise_.covers = instead();
        for (std::size_t i = 1; i < requests_.size(); ++i) {
            LightingTrial figures = beginning(requests_[i]);
            figures.failed = requests_[i].excluded;
            if (figures.failed.empty()) look_at(requests_[i], figures);
            trials_.push_back(std::move(figures));
        }
        if (promise_.else_learns && best_lighting(trials_, course_.asked) == 0) let_learn();
        return trials_;
    }

private:
    static LightingTrial beginning(const TrialRequest& request) {
        LightingTrial figures = request.known;
        figures.name = request.name;
        return figures;
    }
    bool is_allowed(Covers covers) const {
        return std::any_of(requests_.begin(), requests_.end(), [&](const TrialRequest& request) {
            return request.excluded.empty() && request.known.covers == covers;
        });
    }
    // Where hosts, or options of the picture, exclude what was promised, or path tracing itself.
    Covers instead() const {
        if (promise_.covers != Covers::soft && promise_.covers != Covers::all)
            if (is_allowed(Covers::nothing)) return Covers::nothing;
        for (const Covers other : {Covers::soft, Covers::all, Covers::narrow})
            if (is_allowed(other)) return other;
        return Covers::nothing;
    }

    void run_first() {
        LightingTrial figures = beginning(requests_.front());
        pair_[0] = laps_.run(requests_.front(), 0, figures, for_ever).value();
        figures.failed = requests_.front().excluded;
        trials_.push_back(std::move(figures));
    }
    // Only where another is to be judged.
    void complete_pair() {
        if (!pair_[1].beauty.empty()) return;
        LightingTrial& first = trials_.front();
        pair_[1] = laps_.run(requests_.front(), 1, first, for_ever).value();
        first.rendering /= 2;
        first.own_error = errors_of(pair_, {}).front().own;
    }

    void look_at(const TrialRequest& request, LightingTrial& figures) {
        const bool learns = promise_.covers == Covers::narrow;  // and finds out by itself whether that pays
        if (promise_.covers == Covers::nothing || request.known.covers != promise_.covers) {
            figures.failed = "not tried";
        } else if (learns || promise_.is_clear) {
            figures.foretold = promise_.why;
        } else {
            try {
                run_other(request, figures);
            } catch (const std::runtime_error& error) {  // Error and UserError
                figures.failed = error.what();
            }
        }
    }

    void let_learn() {
        for (std::size_t i = 1; i < requests_.size(); ++i)
            if (requests_[i].excluded.empty() && requests_[i].known.covers == Covers::narrow)
                trials_[i].foretold = promise_.why, trials_[i].failed.clear();
    }

    void run_other(const TrialRequest& request, LightingTrial& figures) {
        complete_pair();
        const auto best = forecast_of(trials_[best_lighting(trials_, course_.asked)], course_.asked);
        // The more it promises, the longer it may take.
        const double part = std::clamp(course_.part_of_promise * promise_.times, course_.least_part, course_.most_part);
        const double most = part * best.seconds - laps_.used();
        if (most < course_.least_seconds) {
            figures.failed = "not tried, as trials have taken their part of the time";
            return;
        }
        const auto picture = laps_.run(request, pair_.size(), figures, most);
        if (!picture) {
            figures.failed = fmt::format("its trial takes more than {:.2g} s", most);
            return;
        }
        // Pixels of a small picture lie farther from records than those of the whole: more of them are made on the way.
        if (request.records)
            figures.rendering = std::min(figures.rendering, most_of_sample * trials_.front().rendering);
        const auto [own, shared] = errors_of(pair_, {*picture}).back();
        if (request.is_biased)
            figures.own_error = own, figures.shared_error = shared;
        else
            figures.own_error = own + shared;
    }

    const std::vector<TrialRequest>& requests_;
    const TrialCourse& course_;
    Laps laps_;
    PicturePair pair_;  // the second once another is to be judged
    LightingPromise promise_;
    std::vector<LightingTrial> trials_;
};

}  // namespace

std::vector<LightingTrial> run_trials(const std::vector<TrialRequest>& requests, const TrialCourse& course) {
    return TrialSeries(requests, course).run();
}

}  // namespace lightnet
