// Tells what becomes of the frames of a sequence: in lines, in its report, and to those who watch.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include "tools/request/run_request.hpp"
#include "tools/request/sequence.hpp"
#include "tools/session/sequence_report.hpp"
#include "tools/support/progress.hpp"

namespace lightnet {

/// Any thread's. Frames are named by their position in the sequence.
class SequenceBook {
public:
    explicit SequenceBook(const Sequence& sequence);

    /// Where a frame stands among all as it begins. `watched`: with what became of these.
    FrameOfSequence place_of(std::size_t frame, bool watched) const;
    /// It is rendered, and being written while the next one begins.
    void rendered(std::size_t frame);
    /// As reports have it: "done", "there", "elsewhere", "failed", "cancelled". Says so, and writes the report.
    void ended(std::size_t frame, const std::string& outcome, double seconds);
    bool is_elsewhere(std::size_t frame) const;
    /// The sequence ends with that exit code, which the last words tell.
    void close(int code);
    /// It ends with an error, which others tell.
    void fail(std::size_t frame);

private:
    void say(const FrameReport& frame) const;
    void write(const std::string& outcome);

    const std::string file_;  // of the report; "": none
    const ProgressMode progress_;
    const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    mutable std::mutex book_mutex_;  // of all below
    SequenceReport report_;
    std::optional<std::size_t> being_written_;  // frame
    bool complained_ = false;
};

}  // namespace lightnet
