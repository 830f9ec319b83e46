// Leadership over the sockets of a host: its own thread reads them, or one of its places.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>

#include "transport/lines/frame_queue.hpp"
#include "transport/lines/poll.hpp"
#include "transport/places/wakeup.hpp"

namespace lightnet {

/// Who leads has the sockets of a host to himself: the host's own thread, or a place that has nothing else to do, which
/// then takes what is for it with no thread between (Leader/Followers: Schmidt et al. 2000). A place leads only while
/// it would sleep. Where none has for a millisecond, the host's thread does, so heartbeats never wait for a place.
/// DECISIONS: who-idles-leads
class Leadership {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// What is led. Called by who leads.
    class Led {
    public:
        virtual ~Led() = default;
        virtual void watch(Poll& poll) const = 0;
        /// Takes in some of what has come. False: the next, or what has come instead, is for the host's own thread.
        virtual bool take_in() = 0;
        /// Sends what places have answered.
        virtual void send() = 0;
    };
    /// `led` outlives all use of this but its end.
    explicit Leadership(Led& led) : led_(led) {}
    Leadership(const Leadership&) = delete;
    Leadership& operator=(const Leadership&) = delete;

    /// One wait of a place, during which it leads if nobody else does.
    class Turn {
    public:
        /// `leadership` null: there is nothing to lead. `replies`: of all places of the host.
        Turn(Leadership* leadership, FrameQueue* replies);
        ~Turn();
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;
        /// Adds to what the place waits for.
        void watch(Poll& poll);
        /// After the wait: takes in what has come.
        void look(const Poll& poll);

    private:
        Leadership* const leadership_;  // null: another leads
        FrameQueue* const replies_;
        std::size_t first_ = 0;     // of what is led, in the poll
        bool is_for_host_ = false;  // what comes next
    };
    /// Sends what a place has answered, unless who leads does. Any place.
    void send(FrameQueue& replies);

    /// For the host's own thread, as all that follows: has it lead. Waits until a place that leads has given it back.
    void take();
    /// A place would have led since the host's thread last rested, and that would not be called again at once.
    bool wanted(Time now) const { return wanted_ && now >= no_rest_before_; }
    /// How a rest has ended.
    enum class Rest {
        lapsed,  // no place leads any more
        called,  // there is something to be done
        over     // `most` has passed
    };
    /// Leaves it to places, and leads again when it returns. `others`: what else the host's thread waits for.
    Rest rest(const std::function<void(Poll&)>& others, FrameQueue& replies, std::chrono::milliseconds most);
    /// Places don't lead any more.
    void give_back() { mutex_.unlock(); }

private:
    bool lead();
    void end(bool is_for_host) noexcept;
    Rest wait_while_led(const std::function<void(Poll&)>& others, std::chrono::milliseconds most);

    Led& led_;
    std::mutex mutex_;                 // of who leads
    Wakeup interrupt_;                 // of a place that leads
    Wakeup call_;                      // of the host's thread that rests
    std::atomic<bool> called_{false};  // the host's thread, by a place
    std::atomic<bool> comes_{false};   // the host's thread, to lead
    std::atomic<bool> wanted_{false};
    std::atomic<bool> is_led_{false};      // by a place
    std::atomic<bool> sleeps_{false};      // the host's thread, longer than a millisecond
    std::atomic<std::uint64_t> turns_{0};  // of places, so far
    Time no_rest_before_{};
};

}  // namespace lightnet
