// Service times of each replica, and of all together.
#pragma once

#include <cstddef>
#include <vector>

#include "core/run/schedule/schedule_ids.hpp"

namespace lightnet {

/// Keeps a service time (seconds per question of one place) for each replica, as a mean in which the past fades: what
/// the asker sees of it, with all waiting of its own, or what it says of itself, whichever is more.
class ServiceTimes {
public:
    using Replica = ScheduleIds::Replica;

    /// What an unmeasured replica counts as: it looks fast, so that it gets work, and is measured.
    static constexpr double unknown = 1e-6;

    /// The number belongs to another replica from now on, of which nothing is known.
    void forget(Replica replica);
    /// It has spent so many seconds on so many questions; `reported`: seconds per question by its own account, 0: it
    /// said nothing.
    void measure(Replica replica, double seconds, std::size_t questions, double reported);
    /// What is known of it is old: it may be far quicker by now, and what comes next is
    /// what counts.
    void fade(Replica replica);
    /// How many places of it are a part of the rate of all; 0: none.
    void take_part(Replica replica, std::uint32_t places);

    /// How much more than its replica's mean a piece took lately, at the most: 1 where all take the same.
    double spread() const { return spread_; }
    /// Seconds per question; 0: not known.
    double of(Replica replica) const;
    /// Seconds per question: its own, or the mean of the others where that is not known.
    double assumed(Replica replica) const;
    /// Seconds per question that those who answered lately say they worked on it, all waiting left out; 0: nobody has.
    double said() const { return said_; }
    /// Does any replica that takes part have a known rate?
    bool any() const { return rate_ > 0; }
    /// Of those that take part, on average; 0: not known.
    double mean() const { return any() ? static_cast<double>(known_) / rate_ : 0; }
    /// Questions per second of all that take part; 0: not known.
    double rate() const { return rate_; }

private:
    struct Measured {
        double seconds = 0, questions = 0;  // recent ones
        double reported = 0;
        double counted = 0;             // its part in rate_
        std::uint32_t counted_for = 0;  // places
    };
    Measured& at(Replica replica);

    std::vector<Measured> measured_;  // by replica
    double said_ = 0;
    double spread_ = 1;
    double rate_ = 0;
    std::size_t known_ = 0;  // places that have a part in rate_
};

}  // namespace lightnet
