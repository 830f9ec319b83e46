#include "tools/session/frame_writer.hpp"

#include <utility>

#include "core/base/spare_threads.hpp"

namespace lightnet {

void FrameWriter::begin(std::function<int()> work) {
    wait();
    work_ = std::move(work);
    writing_ = in_background([this] { return std::exchange(work_, nullptr)(); });
}

void FrameWriter::wait() {
    if (!writing_.valid()) return;
    try {
        const int code = writing_.get();
        if (!code_) code_ = code;
    } catch (...) {
        if (!error_) error_ = std::current_exception();
    }
}

int FrameWriter::code() {
    wait();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    return code_;
}

}  // namespace lightnet
