// Writes the files of a frame while the next one is rendered.
#pragma once

#include <exception>
#include <functional>
#include <future>

namespace lightnet {

/// Belongs to one thread, and has another for what is written: one frame at a time, so that memory is bounded however
/// slow a disk is.
class FrameWriter {
public:
    /// Begins with it as soon as what came before is done. `work` returns an exit code, or throws; it is gone when that
    /// is done.
    void begin(std::function<int()> work);
    /// Until nothing is being written.
    void wait();
    /// One that had been waited for could not be written.
    bool failed() const { return code_ != 0 || error_; }
    /// Waits. That of the first frame which could not be written; throws what was thrown first.
    int code();

private:
    std::function<int()> work_;
    int code_ = 0;
    std::exception_ptr error_;
    std::future<int> writing_;  // the first to go: waits for the end of the work
};

}  // namespace lightnet
