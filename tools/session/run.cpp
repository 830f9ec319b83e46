#include "tools/session/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "core/base/atomic_file.hpp"
#include "core/base/error.hpp"
#include "core/base/own_files.hpp"
#include "core/base/unwanted.hpp"
#include "core/base/words_of.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/readers/statistics.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "core/scene/camera_in.hpp"
#include "tools/pictures/clean.hpp"
#include "tools/pictures/output_file.hpp"
#include "tools/pictures/picture_lock.hpp"
#include "tools/pictures/picture_recipe.hpp"
#include "tools/request/run_settings.hpp"
#include "tools/session/delivery.hpp"
#include "tools/session/film_memo.hpp"
#include "tools/session/first_look.hpp"
#include "tools/session/handover.hpp"
#include "tools/session/kept_files.hpp"
#include "tools/session/rendering.hpp"
#include "tools/session/run_recorder.hpp"
#include "tools/session/run_scene.hpp"
#include "tools/session/run_trace.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/signals.hpp"
#include "tools/watch/parts_to_edit.hpp"
#include "tools/watch/report_page.hpp"

namespace lightnet {
namespace {

std::optional<Progress::Series> series_of(const RunRequest& request) {
    if (!request.frame) return std::nullopt;
    const auto& [number, index, count, begun, all] = *request.frame;
    return Progress::Series{number, index, count, begun};
}

// Once, of a sequence with its first frame. "": somebody has named it.
std::string words_of_lighting(const RunRequest& request) {
    const auto& [name, trials] = request.lighting;
    if (trials.empty() || (request.frame && request.frame->index > 0)) return {};
    return "lighting by " + name + ", by trials: " + trials + "; --lighting " + name + " gives the same picture";
}

/// `one_of_several`: they have one page.
WatchedRun watched_run(const RunRequest& request, const Registry& registry, const FilmFormat& format,
                       bool one_of_several) {
    WatchedRun watched{request.graph, registry, format, request.output, one_of_several && !request.frame};
    if (request.frame && one_of_several) watched.frames = {request.frame->number, request.frame->all};
    return watched;
}

// Nothing of others is replaced.
void check_files(const RunRequest& request, const FilmFormat& format) {
    check_output(request.output);
    if (format.halves()) check_picture(clean_beside(request.output));
    if (!request.trace.empty())
        if (const auto why = why_not_replaced(request.trace, trace_beginning); !why.empty())
            throw UserError({request.trace, 0}, why);
    if (!request.arrays.empty()) check_arrays(request.arrays);
    if (!request.arrays.empty() && format.halves()) check_arrays(clean_beside(request.arrays));
    if (!request.report.empty()) check_report(request.report);
}

// Known once the scene is read: textures and skies are pictures, too.
void check_inputs(const RunRequest& request, const Job& job, const FilmFormat& format) {
    std::vector<std::string> inputs{request.reference};
    for (const auto& file : job.files) inputs.push_back(file.path);
    check_inputs_stay(request.output, inputs);
    if (format.halves()) check_inputs_stay(clean_beside(request.output), inputs);
}

// What is there becomes the picture, whatever it is; its checkpoint first, as that is what costs most to lose. In
// words.
std::string write_what_is_there(RunRecorder& book, const RunRequest& request,
                                std::optional<std::chrono::duration<double>> most, const std::string& outcome) {
    const bool kept = book.save_checkpoint(most);
    const std::string goes_on = kept ? "; --resume goes on from here" : "";
    const auto there = book.end_early();
    std::string written = there.empty() ? "no picture was written" : there + ", in " + request.output;
    try {
        if (!there.empty()) book.write_picture(request.output);
    } catch (const std::exception& error) {
        written = std::string("no picture was written: ") + words_of(error);
    }
    book.write_report(request.output, outcome, request.trace);
    return written + goes_on;
}

// Of layers that lack light.
void alert_of_lost(RunAccount& account, const Film& film) {
    const auto lost = film.lost();
    for (std::size_t layer = 0; layer < lost.size(); ++layer)
        if (lost[layer])
            account.alert(fmt::format("{} colours of layer '{}' were not finite and count as black", lost[layer],
                                      film.format().name_of(layer)));
}

// False: it came too soon for a picture that is one.
bool end_in_time(RunRecorder& book, const RunRequest& request) {
    const Film& film = book.steps().picture();
    if (film.covered() < 1 || film.format().coarse) {
        const auto there = write_what_is_there(book, request, {}, "preview");
        std::cerr << "lightnet: the time was over before every pixel had a sample: " << there << '\n';
        return false;
    }
    book.account().say("the time is over: " + book.end_early() +
                       (book.keeps_checkpoint() ? "; --resume goes on from here" : ""));
    return true;
}

// One run of a checked graph, from its scene to its files. One thread's at a time: another may write the files.
class Run {
public:
    Run(const RunRequest& request, const Registry& registry, Handover* handover, const Signals& signals)
        : request_(request),
          registry_(registry),
          handover_(handover),
          signals_(signals),
          format_(film_format(request, registry)),
          book_(format_, request.progress, request.tuning.tile, first_page(request, registry, format_),
                series_of(request)),
          scene_(request, registry, format_, handover) {}

    /// None: all samples are there, and the files are still to be written.
    std::optional<int> render();
    /// From now on another thread has the run.
    void stand_aside() { book_.account().stand_aside(); }
    int write();

private:
    std::optional<int> render_film();
    LoadedScene load();
    bool look_first(const Job& job, const MadeFrom& made, LoadedScene& scene);
    int write_files();
    int cancelled();
    void open_to_watchers();
    std::optional<int> watched(const std::function<std::optional<int>()>& work);
    std::optional<int> reported(const std::function<std::optional<int>()>& work);
    bool show_outcome(const std::string& outcome);
    Graph take_up_checkpoint(const LoadedScene& scene, const MadeFrom& made);
    void report_failure();

    const RunRequest& request_;
    const Registry& registry_;
    Handover* handover_;
    const Signals& signals_;
    FilmFormat format_;
    RunRecorder book_;
    std::optional<LiveExplainer> explainer_;
    std::optional<Watcher> watcher_;
    RunScene scene_;
    std::optional<PictureLock> lock_;  // until all is written
};

// Returns what is still to be rendered, if anything is.
Graph Run::take_up_checkpoint(const LoadedScene& scene, const MadeFrom& made) {
    auto recipe = picture_recipe(scene_.job(), registry_, format_, request_.tuning.tile);
    const auto film = film_recipe(scene_.job(), registry_, format_, request_.tuning.tile, made);
    auto lights = request_.memo ? light_recipes(scene_.job(), registry_, format_, request_.tuning.tile, made)
                                : std::vector<LightRecipe>();
    const CameraData camera =
        scene.built ? scene.built->seen_from() : camera_in(scene.data, format_.width, format_.height);
    if (watcher_ && request_.shown)
        watcher_->look_from(
            viewpoint_of(camera, scene.built ? scene.built->bounds() : statistics_of(scene.data).bounds),
            parts_to_edit(request_.graph, registry_, data_of(scene)));
    auto words = words_of(request_.graph, registry_, format_, recipe, data_of(scene), camera);
    if (const auto& name = request_.lighting.name; !name.empty()) words.notes.texts["lighting"] = name;
    book_.files().describe(std::move(words));
    book_.keep_checkpoint(
        request_.output, std::move(recipe), std::chrono::seconds(request_.tuning.checkpoint),
        memo_for(request_, registry_, film, std::move(lights), [this](const auto& why) { book_.account().warn(why); }));
    return book_.take_up_checkpoint(request_.resume, scene_.job().graph, registry_);
}

// Who edits what is at work waits for the next picture.
LoadedScene Run::load() {
    const LookingAt looking(request_.shown ? &signals_.superseded : nullptr);
    return scene_.load(book_);
}

// True: somebody who waits has been shown what is there before nodes prepare, and the scene was left to the next.
bool Run::look_first(const Job& job, const MadeFrom& made, LoadedScene& scene) {
    if (!request_.shown || !handover_) return false;
    const auto look = first_look(request_, registry_, job, made);
    if (!look) return false;
    book_.so_far().look_without(look->without);
    const MadeFrom nothing = made_from(look->job);
    const KeptFiles none(look->job.graph, registry_, data_of(scene));
    Rendering({request_, registry_, look->job, format_, none, nothing, handover_, true}, book_, signals_)
        .perform(std::move(scene), scene_.files());
    return true;
}

std::optional<int> Run::render_film() {
    if (const auto words = words_of_lighting(request_); !words.empty()) book_.account().say(words);
    book_.account().phase("load");
    LoadedScene scene = load();
    check_inputs(request_, scene_.job(), format_);
    if (scene_.was_there(scene, book_)) return exit_code::done;
    MadeFrom made = scene_.made_from(scene);
    const KeptFiles to_keep(request_.graph, registry_, data_of(scene));
    book_.expose(scene.built ? scene.built->film().scale : scene.data.film.scale);
    book_.limit_time(request_.time_limit);
    if (!request_.reference.empty()) {
        const Window wanted = format_.crop.value_or(Window{0, 0, format_.width, format_.height});
        book_.compare_with({request_.reference, request_.curve, wanted.width, wanted.height});
    }
    book_.files().show_png({request_.png, scene_overrides(request_.graph, registry_).exposure != 0});
    book_.files().keep_arrays(request_.arrays);
    if (request_.shown) book_.show_steps(request_.output, request_.shown);
    if (request_.preview > 0) book_.so_far().preview(request_.output, request_.preview);
    Job job = scene_.job();
    job.graph = take_up_checkpoint(scene, made);
    if (leaves_out(job.graph)) made = made_from(job, registry_, scene);
    if (book_.steps().finished() && request_.resume && book_.files().is_there(request_.output)) {
        book_.account().say(request_.output + " is finished: nothing to do; ask for more with --samples");
        return exit_code::done;
    }
    if (book_.steps().finished() && request_.resume)
        book_.account().say(request_.output + " is finished but for its file");
    if (!book_.steps().finished() && look_first(job, made, scene)) scene = load();
    if (signals_.any) return cancelled();
    if (book_.steps().finished() && handover_)
        handover_->leave(scene);
    else if (!book_.steps().finished())
        Rendering({request_, registry_, job, format_, to_keep, made, handover_}, book_, signals_)
            .perform(std::move(scene), scene_.files());
    if (signals_.any) return cancelled();
    if (!book_.steps().finished() && !end_in_time(book_, request_)) return exit_code::failed;
    return std::nullopt;
}

int Run::write_files() {
    book_.account().phase("write");
    alert_of_bad_light(book_.account(), scene_.job().graph);
    alert_of_lost(book_.account(), book_.steps().picture());
    const int code = finish_run(book_, request_, scene_overrides(request_.graph, registry_).exposure, signals_.any);
    if (code == exit_code::done) book_.so_far().tell_shown(true);
    return code;
}

int Run::cancelled() {
    if (signals_.superseded) return book_.end_checkpoint(false), exit_code::interrupted;
    const auto there = write_what_is_there(book_, request_, time_to_end(signals_), "cancelled");
    std::cerr << "cancelled: " << there << '\n';
    return exit_code::interrupted;
}

void Run::open_to_watchers() {
    if (!request_.watch && !request_.viewer && request_.report.empty()) return;
    if (request_.watch) explainer_.emplace(request_, registry_, format_);
    WatchServer* const server = handover_ ? handover_->server : nullptr;
    watcher_.emplace(Watcher::Options{request_.watch, request_.viewer, !request_.report.empty(), ask_to_stop,
                                      explainer_ ? &*explainer_ : nullptr, server},
                     watched_run(request_, registry_, format_, server != nullptr));
    book_.account().show_to(&*watcher_);
    // Whoever asks for it wants to know, however little else is said.
    if (request_.watch && !server) std::cerr << "watch it at " << watcher_->url() << std::endl;
}

std::optional<int> Run::render() {
    check_files(request_, format_);
    lock_.emplace(request_.output);
    open_to_watchers();
    return watched([this]() -> std::optional<int> {
        try {
            return render_film();
        } catch (const Cancelled&) {  // while its scene was read or built
            return cancelled();
        }
    });
}

int Run::write() {
    return watched([this] { return write_files(); }).value();
}

// Those who watch are shown how it ends, if it does.
std::optional<int> Run::watched(const std::function<std::optional<int>()>& work) {
    try {
        const auto code = reported(work);
        if (!code) return code;
        if (signals_.superseded && *code == exit_code::interrupted) return code;  // the next is shown at once
        const bool told = show_outcome(*code == exit_code::done          ? "done"
                                       : *code == exit_code::interrupted ? "cancelled"
                                                                         : "failed");
        return told || *code != exit_code::done ? *code : exit_code::failed;
    } catch (...) {
        show_outcome("failed");
        throw;
    }
}

// A report that can't be written takes nothing from the picture, but whoever asked for it has to know: false.
bool Run::show_outcome(const std::string& outcome) {
    if (!watcher_) return true;
    const bool alone = !request_.frame && !(handover_ && handover_->server);
    const bool foreseen = outcome == "done" && alone && watcher_->wanted();
    watcher_->progress(book_.steps().done(), {}, book_.account().report().moves);
    watcher_->finish(book_.steps().picture(), outcome,
                     foreseen ? curve_of_run(report_beside(request_.output), registry_) : ForecastCurve{});
    if (request_.report.empty()) return true;
    const auto complain = [&](const std::string& why) {
        std::cerr << "lightnet: there is no report: " << why << '\n';
        return false;
    };
    try {
        expect_ours(request_.report, report_page_beginning);
        const auto facts = facts_of(book_.account().report(), watcher_->at_work());
        write_file(request_.report, report_page(*watcher_, book_.steps().picture(), facts));
        return true;
    } catch (const std::bad_alloc&) {
        return complain("there is not enough memory for it");
    } catch (const std::exception& error) {
        return complain(words_of(error));
    }
}

std::optional<int> Run::reported(const std::function<std::optional<int>()>& work) {
    try {
        return work();
    } catch (const UserError&) {
        throw;
    } catch (const NoWorker& error) {
        report_failure();
        std::cerr << "lightnet: " << error.what() << '\n';
        return dynamic_cast<const NobodyKnown*>(&error) ? exit_code::unknown_key : exit_code::no_worker;
    } catch (...) {
        report_failure();
        throw;
    }
}

// What went wrong is said anyhow; a report that can't be written must not hide it.
void Run::report_failure() {
    try {
        if (book_.save_checkpoint()) book_.account().say("what is there is kept: --resume goes on from here");
        book_.write_report(request_.output, "failed", request_.trace);
    } catch (const std::exception& error) {
        book_.account().alert(std::string("there is no report of it: ") + words_of(error));
    }
}

// Memory has no words of its own when it is short.
template <class Work>
auto short_of_memory_in_words(const RunRequest& request, const Registry& registry, const Work& work) try {
    return work();
} catch (const std::bad_alloc&) {
    const auto film = film_of(request.graph, registry);
    throw Error(
        fmt::format("there is not enough memory for {}x{} pixels of '{}'; a smaller --size or --crop takes less",
                    film.width, film.height, request.scene));
}

}  // namespace

int run(const RunRequest& request, const Registry& registry, Handover* handover, const Signals& signals) {
    std::shared_ptr<Run> run;
    const auto code = short_of_memory_in_words(request, registry, [&] {
        run = std::make_shared<Run>(request, registry, handover, signals);
        return run->render();
    });
    if (code) return *code;
    const bool beside = handover && handover->write_beside;
    if (beside) run->stand_aside();
    auto write = [run = std::move(run), &request, &registry] {
        return short_of_memory_in_words(request, registry, [&] { return run->write(); });
    };
    if (!beside) return write();
    handover->write_beside(std::move(write));
    return exit_code::done;
}

}  // namespace lightnet
