// Processors of a host in a simulation, that its places share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "core/run/forecast/event_queue.hpp"

namespace lightnet {

/// Each piece of work has a processor for itself, or, where there are fewer processors than pieces, an equal share of
/// all (egalitarian processor sharing): as of a control group with a quota, or of threads that are more than cores.
/// One thread's.
class SharedProcessors {
public:
    /// How many, perhaps a part of one; 0: one for each piece. `speed`: of each. `events` outlives it.
    SharedProcessors(EventQueue& events, double processors, double speed = 1)
        : events_(events), processors_(processors), speed_(speed) {}
    SharedProcessors(const SharedProcessors&) = delete;
    SharedProcessors& operator=(const SharedProcessors&) = delete;

    double speed() const { return speed_; }
    /// Begins now, and takes so many seconds where it has a processor of speed 1 for itself.
    void work(double seconds, EventQueue::Happens done) {
        seconds /= speed_;
        if (processors_ <= 0) return events_.at(events_.now() + seconds, std::move(done));
        go_on();
        under_way_.emplace(each_had_ + seconds, std::move(done));
        plan();
    }

private:
    double rate() const { return std::min(1.0, processors_ / double(under_way_.size())); }
    void go_on() {
        if (!under_way_.empty()) each_had_ += (events_.now() - since_) * rate();
        since_ = events_.now();
    }
    // Whenever somebody comes or goes, all others end at another time than was planned.
    void plan() {
        if (under_way_.empty()) return;
        const double left = std::max(0.0, under_way_.begin()->first - each_had_);
        events_.at(since_ + left / rate(), [this, planned = ++planned_] {
            if (planned == planned_) end_first();
        });
    }
    void end_first() {
        go_on();
        auto first = under_way_.extract(under_way_.begin());
        each_had_ = std::max(each_had_, first.key());
        plan();
        first.mapped()();
    }

    EventQueue& events_;
    double processors_, speed_;
    double each_had_ = 0;  // seconds of processor that a piece had which is there from the beginning
    double since_ = 0;
    std::multimap<double, EventQueue::Happens> under_way_;  // by what `each_had_` will be when it is done
    std::uint64_t planned_ = 0;
};

}  // namespace lightnet
