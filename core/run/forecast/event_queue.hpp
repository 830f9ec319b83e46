// Events of a simulation, in the order of time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace lightnet {

/// A clock that goes on from event to event. Events of the same time happen in the order in which they were planned.
/// One thread's.
class EventQueue {
public:
    using Happens = std::function<void()>;
    static constexpr double never = std::numeric_limits<double>::infinity();

    /// Seconds: of the event that happens now, or happened last.
    double now() const { return now_; }
    /// When the next one is due; never: there is none.
    double next() const { return heap_.empty() ? never : heap_.front().time; }
    void at(double time, Happens happens) {
        heap_.push_back({std::max(time, now_), order_++, std::move(happens)});
        std::push_heap(heap_.begin(), heap_.end(), later);
    }
    /// Makes the next one happen. Only where there is one.
    void step() {
        std::pop_heap(heap_.begin(), heap_.end(), later);
        const Event event = std::move(heap_.back());
        heap_.pop_back();
        now_ = event.time;
        event.happens();
    }

private:
    struct Event {
        double time;
        std::uint64_t order;
        Happens happens;
    };
    static bool later(const Event& a, const Event& b) { return a.time != b.time ? a.time > b.time : a.order > b.order; }

    std::vector<Event> heap_;
    double now_ = 0;
    std::uint64_t order_ = 0;
};

/// One way of a connection: what is sent waits for what was sent before.
class SimulatedLine {
public:
    explicit SimulatedLine(double bytes_per_second = 0) : rate_(bytes_per_second) {}
    /// When the last byte has left, of what is sent at `time`.
    double pass(double time, double bytes) {
        if (rate_ <= 0) return time;  // within a process
        free_ = std::max(free_, time) + bytes / rate_;
        busy_ += bytes / rate_;
        return free_;
    }
    /// Seconds in which something was on it.
    double busy() const { return busy_; }

private:
    double rate_ = 0, free_ = 0, busy_ = 0;
};

}  // namespace lightnet
