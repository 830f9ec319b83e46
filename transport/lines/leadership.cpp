#include "transport/lines/leadership.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto lapse = 1ms;
constexpr auto short_rest = 2ms, pause = 20ms;  // what calls the host's thread at once is likely to go on
constexpr int still_ticks = 8;  // of a millisecond in which nothing came, before the host's thread sleeps longer

}  // namespace

Leadership::Turn::Turn(Leadership* leadership, FrameQueue* replies)
    : leadership_(leadership && leadership->lead() ? leadership : nullptr), replies_(replies) {}

Leadership::Turn::~Turn() {
    if (leadership_) leadership_->end(is_for_host_);
}

void Leadership::Turn::watch(Poll& poll) {
    if (!leadership_) return;
    poll.add(leadership_->interrupt_.handle());
    first_ = poll.size();
    poll.add(*replies_);
    leadership_->led_.watch(poll);
}

void Leadership::Turn::look(const Poll& poll) {
    if (!leadership_) return;
    is_for_host_ = poll.any_readable(first_ + 1, poll.size()) && !leadership_->led_.take_in();
    leadership_->led_.send();
}

bool Leadership::lead() {
    if (called_ || comes_ || !mutex_.try_lock()) {
        wanted_ = true;
        return false;
    }
    is_led_ = true;
    ++turns_;
    return true;
}

// The host's thread sets `sleeps_` before it looks at `is_led_`, and here it is the other way round: one of them sees
// it.
void Leadership::end(bool is_for_host) noexcept {
    if (is_for_host) called_ = true;
    is_led_ = false;
    mutex_.unlock();
    if (is_for_host || sleeps_.exchange(false)) call_.notify();
}

// Who leads looks once more after giving it back, so that nothing stays that was put there meanwhile.
void Leadership::send(FrameQueue& replies) {
    while (!replies.empty() && !called_ && !comes_ && mutex_.try_lock()) {
        const std::lock_guard lock(mutex_, std::adopt_lock);
        led_.send();
    }
}

void Leadership::take() {
    if (!mutex_.try_lock()) {
        comes_ = true;
        interrupt_.notify();
        mutex_.lock();
        interrupt_.clear();
    }
    comes_ = false;
}

Leadership::Rest Leadership::rest(const std::function<void(Poll&)>& others, FrameQueue& replies,
                                  std::chrono::milliseconds most) {
    const auto begun = Clock::now();
    wanted_ = false;
    mutex_.unlock();
    auto how = Rest::lapsed;
    {
        struct Back {
            Leadership& its;
            ~Back() {
                its.sleeps_ = false;
                its.take();
            }
        } const back{*this};
        send(replies);
        how = wait_while_led(others, most);
    }
    if (called_.exchange(false)) how = Rest::called;
    const auto now = Clock::now();
    if (how == Rest::called && now - begun < short_rest) no_rest_before_ = now + pause;
    return how;
}

Leadership::Rest Leadership::wait_while_led(const std::function<void(Poll&)>& others, std::chrono::milliseconds most) {
    const auto end = Clock::now() + most;
    auto seen = turns_.load();
    int still = 0;
    while (!called_) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
        if (left <= 0ms) return Rest::over;
        sleeps_ = still >= still_ticks;
        if (!is_led_) sleeps_ = false;
        Poll poll;
        poll.add(call_.handle());
        others(poll);
        poll.wait(sleeps_ ? left : std::min<std::chrono::milliseconds>(left, lapse));
        if (poll.readable(0)) call_.clear();
        if (poll.any_readable(1, poll.size())) return Rest::called;
        const auto now = turns_.load();
        if (now == seen && !is_led_) return Rest::lapsed;
        still = now == seen ? still + 1 : 0;
        seen = now;
    }
    return Rest::called;
}

}  // namespace lightnet
