#include "transport/lines/frame_queue.hpp"

#include <utility>

namespace lightnet {

bool FrameQueue::put(Frames& frames, std::size_t most) {
    bool asleep = false;
    {
        const std::lock_guard lock(mutex_);
        if (closed_ || frames_.size() >= most) return false;
        frames_.push_back(std::move(frames));
        asleep = std::exchange(asleep_, false);
        woken_ |= asleep;
    }
    if (asleep) wakeup_.notify();
    return true;
}

std::optional<Frames> FrameQueue::pop() {
    const std::lock_guard lock(mutex_);
    if (frames_.empty()) return std::nullopt;
    auto next = std::move(frames_.front());
    frames_.pop_front();
    return next;
}

bool FrameQueue::empty() const {
    const std::lock_guard lock(mutex_);
    return frames_.empty();
}

bool FrameQueue::fall_asleep() {
    const std::lock_guard lock(mutex_);
    asleep_ = frames_.empty() && !closed_;
    return asleep_;
}

// Who was not woken needs not take note of it, which would be a call of the system.
void FrameQueue::wake_up() {
    {
        const std::lock_guard lock(mutex_);
        asleep_ = false;
        if (!std::exchange(woken_, false)) return;
    }
    wakeup_.clear();
}

void FrameQueue::close() {
    std::deque<Frames> dropped;
    const std::lock_guard lock(mutex_);
    closed_ = true;
    dropped.swap(frames_);
}

}  // namespace lightnet
