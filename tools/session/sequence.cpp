#include "tools/session/sequence.hpp"

#include <chrono>
#include <exception>
#include <functional>
#include <iostream>
#include <optional>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/words_of.hpp"
#include "tools/pictures/picture_lock.hpp"
#include "tools/session/frame_scenes.hpp"
#include "tools/session/frame_writer.hpp"
#include "tools/session/handover.hpp"
#include "tools/session/run.hpp"
#include "tools/session/sequence_book.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/pace.hpp"
#include "tools/support/signals.hpp"
#include "tools/watch/watch_page.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

// DECISIONS: frames-alone-are-frames
class SequenceRun {
public:
    SequenceRun(Sequence sequence, const Registry& registry)
        : sequence_(std::move(sequence)), registry_(registry), scenes_(registry, watch_signals()), book_(sequence_) {}

    int perform() {
        open_to_watchers();
        const int code = render_all();
        const int of_files = writer_.code();
        const int first = of_files != exit_code::done ? of_files : code;
        book_.close(first);
        return first;
    }

private:
    // One page for all frames, which stays until the sequence ends.
    void open_to_watchers() {
        const auto& watch = sequence_.frames.front().watch;
        if (!watch) return;
        WatchServer::Options options{*watch, new_token(), watch_page()};
        options.end = ask_to_stop;
        server_.emplace(std::move(options), stage_before_runs());
        handover_.server = &*server_;
        std::cerr << "watch it at " << server_->url() << std::endl;
    }

    int render_all() {
        const auto frames = sequence_.frames.size();
        for (std::size_t i = 0; i < frames && !writer_.failed(); ++i)
            if (const int code = render(i, i + 1 < frames); code != exit_code::done) return code;
        for (std::size_t i = 0; i < frames && !writer_.failed(); ++i) {  // whose run may have ended without them
            if (!book_.is_elsewhere(i)) continue;
            sequence_.frames[i].resume = true;
            if (const int code = render(i, false); code != exit_code::done) return code;
        }
        return exit_code::done;
    }

    int render(std::size_t i, bool goes_on) {
        RunRequest& request = sequence_.frames[i];
        request.frame = book_.place_of(i, server_.has_value());
        const auto begun = Clock::now();
        bool left = false;  // to the writer
        handover_.write_beside = nullptr;
        if (goes_on)
            handover_.write_beside = [&](std::function<int()> write) {
                left = true;
                write_beside(i, begun, std::move(write));
            };
        handover_.loaded = nullptr;
        if (goes_on) handover_.loaded = [this, i] { scenes_.read_ahead(sequence_.frames[i + 1], handover_); };
        std::optional<int> code;
        try {
            scenes_.settle(request);
            handover_.was_there = false;
            code = run(request, registry_, &handover_);
        } catch (const PictureTaken&) {
        } catch (...) {
            give_up(i);
            throw;
        }
        if (!left) end(i, code, begun);
        request.read.reset();
        return code.value_or(exit_code::done);
    }

    // None: another run is at it. The frames before have the first word.
    void end(std::size_t i, std::optional<int> code, Clock::time_point begun) {
        writer_.wait();
        const std::string outcome = code && handover_.was_there ? "there" : outcome_of(code);
        book_.ended(i, outcome, seconds_since(begun));
    }

    static std::string outcome_of(std::optional<int> code) {
        return !code                             ? "elsewhere"
               : *code == exit_code::interrupted ? "cancelled"
               : *code != exit_code::done        ? "failed"
                                                 : "done";
    }

    // Whoever tells of this error can tell of no other.
    void give_up(std::size_t i) {
        try {
            writer_.code();
        } catch (const std::exception& error) {
            std::cerr << std::string("lightnet: ") + words_of(error) + '\n';
        }
        book_.fail(i);
    }

    // A frame that can't be written ends the sequence, and the frame that is rendered meanwhile as a signal would: it
    // can be gone on with.
    void write_beside(std::size_t i, Clock::time_point begun, std::function<int()> write) {
        writer_.wait();
        book_.rendered(i);
        writer_.begin([this, i, begun, write = std::move(write)]() mutable {
            try {
                const int code = std::exchange(write, nullptr)();
                if (code != exit_code::done) ask_to_stop();
                book_.ended(i, outcome_of(code), seconds_since(begun));
                return code;
            } catch (...) {
                ask_to_stop();
                book_.fail(i);
                throw;
            }
        });
    }

    Sequence sequence_;
    const Registry& registry_;
    FrameScenes scenes_;
    std::optional<WatchServer> server_;  // of the page, if there is one
    Handover handover_;
    SequenceBook book_;
    FrameWriter writer_;  // the first to go
};

}  // namespace

int run_sequence(Sequence sequence, const Registry& registry) {
    return SequenceRun(std::move(sequence), registry).perform();
}

}  // namespace lightnet
