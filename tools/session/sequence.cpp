#include "tools/session/sequence.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/json_tree.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "tools/pictures/picture_lock.hpp"
#include "tools/session/handover.hpp"
#include "tools/session/run.hpp"
#include "tools/session/sequence_report.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/pace.hpp"
#include "tools/watch/watch_page.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

/// Does a scene move? It does where its file holds animations.
class Motion {
public:
    explicit Motion(const Registry& registry) : registry_(registry) {}

    /// Takes times out of what is asked for where nothing hangs on them, so that all frames ask for the same.
    void settle(RunRequest& request) {
        Node& scene = request.graph.nodes[place_of(request.graph)];
        if (!scene.params.contains("time") || moves(request, scene)) return;
        scene.params.erase("time");
        for (const char* frame : {"previous", "next"})
            if (const auto beside = scene.params.find(frame); beside != scene.params.end())
                if (!std::get<Table>(beside->second.data).named.contains("file")) scene.params.erase(beside);
    }

private:
    std::size_t place_of(const Graph& graph) const {
        const Node& scene = scene_of(graph, registry_);
        return graph.find(scene.name).value();
    }
    bool moves(RunRequest& request, const Node& scene) {
        const auto* format = scene_format_of(request.scene);
        if (!format || !format->moves) return false;
        auto constants = scene_constants(request.graph, scene);
        for (const auto name : {time_constant, previous_constant, next_constant}) constants.erase(std::string(name));
        const auto [known, fresh] = known_.try_emplace({request.scene, std::move(constants)}, false);
        if (!fresh) return known->second;
        if (!request.read) {  // it is at this time already
            auto read = std::make_shared<ReadScene>();
            read->scene = read_scene(read->files, request.scene, scene_constants(request.graph, scene));
            request.read = std::move(read);
        }
        return known->second = !request.read->scene.animations.empty();
    }

    const Registry& registry_;
    std::map<std::pair<std::string, SceneConstants>, bool> known_;
};

// DECISIONS: frames-alone-are-frames
class SequenceRun {
public:
    SequenceRun(Sequence sequence, const Registry& registry)
        : sequence_(std::move(sequence)), registry_(registry), motion_(registry) {
        report_.graph = sequence_.frames.front().graph.file;
        for (const auto& frame : sequence_.frames) report_.frames.push_back({frame.frame->number, frame.output});
    }

    int perform() {
        open_to_watchers();
        for (std::size_t i = 0; i < sequence_.frames.size(); ++i)
            if (const int code = render(i); code != exit_code::done) return end(code);
        for (std::size_t i = 0; i < sequence_.frames.size(); ++i)  // whose run may have ended without them
            if (report_.frames[i].outcome == "elsewhere")
                if (const int code = render_after_others(i); code != exit_code::done) return end(code);
        return end(exit_code::done);
    }

private:
    // One page for all frames, which stays until the sequence ends.
    void open_to_watchers() {
        const auto& watch = sequence_.frames.front().watch;
        if (!watch) return;
        server_.emplace(WatchServer::Options{*watch, new_token(), watch_page()}, stage_before_runs());
        handover_.server = &*server_;
        std::cerr << "watch it at " << server_->url() << std::endl;
    }
    std::vector<std::pair<int, std::string>> outcomes() const {
        std::vector<std::pair<int, std::string>> all;
        for (const auto& frame : report_.frames)
            all.emplace_back(frame.frame, frame.outcome == "waiting" ? "" : frame.outcome);
        return all;
    }

    int render(std::size_t i) {
        RunRequest& request = sequence_.frames[i];
        FrameReport& report = report_.frames[i];
        request.frame->index = report_.count("done");
        request.frame->count = report_.frames.size() - report_.count("there") - report_.count("elsewhere");
        request.frame->begun = begun_;
        if (server_) request.frame->all = outcomes();
        const auto begun = Clock::now();
        int code = exit_code::done;
        try {
            motion_.settle(request);
            handover_.was_there = false;
            code = run(request, registry_, &handover_);
            report.outcome = code == exit_code::interrupted ? "cancelled"
                             : code != exit_code::done      ? "failed"
                             : handover_.was_there          ? "there"
                                                            : "done";
        } catch (const PictureTaken&) {
            report.outcome = "elsewhere";
        } catch (...) {
            report.outcome = "failed";
            write("failed");
            throw;
        }
        report.seconds = report.outcome == "there" ? 0 : seconds_since(begun);
        request.read.reset();
        say(report);
        write("going");
        return code;
    }

    // If nobody is at it any more, and it isn't there.
    int render_after_others(std::size_t i) {
        sequence_.frames[i].resume = true;
        return render(i);
    }

    // A line of each frame.
    void say(const FrameReport& frame) const {
        const auto progress = sequence_.frames.front().progress;
        if (progress == ProgressMode::none) return;
        const auto finished = report_.count("done") + report_.count("there");
        if (progress == ProgressMode::json) {
            const JsonTree line{{"event", "frame"},
                                {"frame", frame.frame},
                                {"outcome", frame.outcome},
                                {"file", frame.file},
                                {"seconds", frame.seconds},
                                {"frames_done", finished},
                                {"frames", report_.frames.size()}};
            std::cerr << to_text(line) << std::endl;
            return;
        }
        std::cerr << fmt::format("frame {}: {}, {} of {}\n", frame.frame, in_words(frame), finished,
                                 report_.frames.size())
                  << std::flush;
    }
    static std::string in_words(const FrameReport& frame) {
        if (frame.outcome == "there") return frame.file + " is there";
        if (frame.outcome == "elsewhere") return "another run is at it";
        return fmt::format("{} is {}, {:.1f} s", frame.file, frame.outcome, frame.seconds);
    }

    int end(int code) {
        write(code == exit_code::done ? "done" : code == exit_code::interrupted ? "cancelled" : "failed");
        const auto& request = sequence_.frames.front();
        if (request.progress == ProgressMode::none || request.progress == ProgressMode::json) return code;
        std::string text = fmt::format("{} frames in {:.1f} s: {} rendered", report_.frames.size(),
                                       seconds_since(begun_), report_.count("done"));
        if (const auto there = report_.count("there")) text += fmt::format(", {} were there", there);
        if (const auto others = report_.count("elsewhere")) text += fmt::format(", {} are left to other runs", others);
        if (const auto waiting = report_.count("waiting") + report_.count("cancelled"))
            text += fmt::format(", {} are left: --resume goes on with them", waiting);
        std::cerr << text << std::endl;
        return code;
    }

    // A report that can't be written is no reason to lose frames, which have their own.
    void write(const std::string& outcome) {
        report_.outcome = outcome;
        report_.seconds = seconds_since(begun_);
        if (sequence_.report.empty()) return;
        try {
            write_report(sequence_.report, report_);
        } catch (const Error& error) {
            if (!std::exchange(complained_, true))
                std::cerr << "lightnet: there is no report of the sequence: " << error.what() << '\n';
        }
    }

    Sequence sequence_;
    const Registry& registry_;
    Motion motion_;
    std::optional<WatchServer> server_;  // of the page, if there is one
    Handover handover_;
    SequenceReport report_;
    Clock::time_point begun_ = Clock::now();
    bool complained_ = false;
};

}  // namespace

int run_sequence(Sequence sequence, const Registry& registry) {
    return SequenceRun(std::move(sequence), registry).perform();
}

}  // namespace lightnet
