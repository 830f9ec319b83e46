#include "tools/session/sequence_book.hpp"

#include <fmt/format.h>

#include <iostream>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/json_tree.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/pace.hpp"

namespace lightnet {
namespace {

std::string in_words(const FrameReport& frame) {
    if (frame.outcome == "there") return frame.file + " is there";
    if (frame.outcome == "elsewhere") return "another run is at it";
    return fmt::format("{} is {}, {:.1f} s", frame.file, frame.outcome, frame.seconds);
}

}  // namespace

SequenceBook::SequenceBook(const Sequence& sequence)
    : file_(sequence.report), progress_(sequence.frames.front().progress) {
    report_.graph = sequence.frames.front().graph.file;
    for (const auto& frame : sequence.frames) report_.frames.push_back({frame.frame->number, frame.output});
}

FrameOfSequence SequenceBook::place_of(std::size_t frame, bool watched) const {
    const std::lock_guard lock(book_mutex_);
    FrameOfSequence place{report_.frames[frame].frame, report_.count("done") + (being_written_ ? 1 : 0),
                          report_.frames.size() - report_.count("there") - report_.count("elsewhere"), begun_};
    if (!watched) return place;
    for (std::size_t i = 0; i < report_.frames.size(); ++i) {
        const auto& [number, file, outcome, seconds] = report_.frames[i];
        place.all.emplace_back(number, i == being_written_ ? "done" : outcome == "waiting" ? "" : outcome);
    }
    return place;
}

void SequenceBook::rendered(std::size_t frame) {
    const std::lock_guard lock(book_mutex_);
    being_written_ = frame;
}

void SequenceBook::ended(std::size_t frame, const std::string& outcome, double seconds) {
    const std::lock_guard lock(book_mutex_);
    if (being_written_ == frame) being_written_.reset();
    FrameReport& report = report_.frames[frame];
    report.outcome = outcome;
    report.seconds = outcome == "there" ? 0 : seconds;
    say(report);
    write("going");
}

bool SequenceBook::is_elsewhere(std::size_t frame) const {
    const std::lock_guard lock(book_mutex_);
    return report_.frames[frame].outcome == "elsewhere";
}

void SequenceBook::fail(std::size_t frame) {
    const std::lock_guard lock(book_mutex_);
    report_.frames[frame].outcome = "failed";
    write("failed");
}

// A line of each frame.
void SequenceBook::say(const FrameReport& frame) const {
    if (progress_ == ProgressMode::none) return;
    const auto finished = report_.count("done") + report_.count("there");
    std::string line =
        fmt::format("frame {}: {}, {} of {}", frame.frame, in_words(frame), finished, report_.frames.size());
    if (progress_ == ProgressMode::json)
        line = to_text(JsonTree{{"event", "frame"},
                                {"frame", frame.frame},
                                {"outcome", frame.outcome},
                                {"file", frame.file},
                                {"seconds", frame.seconds},
                                {"frames_done", finished},
                                {"frames", report_.frames.size()}});
    const auto style = Progress::style_of_stderr(progress_);
    std::cerr << fmt::format("{}{}\n", room_for_line(style.mode, style.terminal), line) << std::flush;
}

void SequenceBook::close(int code) {
    const std::lock_guard lock(book_mutex_);
    write(code == exit_code::done ? "done" : code == exit_code::interrupted ? "cancelled" : "failed");
    if (progress_ == ProgressMode::none || progress_ == ProgressMode::json) return;
    std::string text = fmt::format("{} frames in {:.1f} s: {} rendered", report_.frames.size(), seconds_since(begun_),
                                   report_.count("done"));
    if (const auto there = report_.count("there")) text += fmt::format(", {} were there", there);
    if (const auto others = report_.count("elsewhere")) text += fmt::format(", {} are left to other runs", others);
    if (const auto waiting = report_.count("waiting") + report_.count("cancelled"))
        text += fmt::format(", {} are left: --resume goes on with them", waiting);
    std::cerr << text << std::endl;
}

// A report that can't be written is no reason to lose frames, which have their own. What has failed stays so.
void SequenceBook::write(const std::string& outcome) {
    if (report_.outcome != "failed") report_.outcome = outcome;
    report_.seconds = seconds_since(begun_);
    if (file_.empty()) return;
    try {
        write_report(file_, report_);
    } catch (const Error& error) {
        if (!std::exchange(complained_, true))
            std::cerr << std::string("lightnet: there is no report of the sequence: ") + error.what() + '\n';
    }
}

}  // namespace lightnet
