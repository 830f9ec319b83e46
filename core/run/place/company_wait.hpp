// The patience of questions that wait for others to travel with.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <utility>

namespace lightnet {

/// How long the oldest of some questions has waited for company, by the time that its place has had (OwnTime): while
/// other programs have the processor, nobody can ask what would travel with it. Who waits long for an answer anyway
/// loses little by waiting for company first.
// DECISIONS: three-milliseconds-of-patience
// DECISIONS: patience-by-own-time
class CompanyWait {
public:
    using Clock = std::chrono::steady_clock;
    using Nanoseconds = std::chrono::nanoseconds;
    using OwnClock = std::function<Nanoseconds()>;

    /// `least`: as long any question may wait.
    CompanyWait(Nanoseconds least, OwnClock own) : least_(least), own_(std::move(own)) {}

    /// From now on a question waits, and none that is older.
    void begin(Clock::time_point now) {
        begun_ = own_();
        had_ = Nanoseconds::zero();
        looked_ = now;
    }
    /// The place's time is at most as much as the system's, so that it need not be looked at before this is over, too.
    bool is_over(Clock::time_point now) {
        if (left(now) > Nanoseconds::zero()) return false;
        had_ = own_() - begun_;
        looked_ = now;
        return had_ >= patience();
    }
    /// For so long it can't be over, or longer.
    Nanoseconds left(Clock::time_point now) const { return patience() - had_ - (now - looked_); }

    /// A bundle was answered after `took`, all waiting included.
    void answered(Nanoseconds took) {
        answer_time_ = answer_time_ == answer_time_.zero() ? took : (3 * answer_time_ + took) / 4;
    }

private:
    Nanoseconds patience() const { return std::clamp(answer_time_ / 2, least_, 16 * least_); }

    Nanoseconds least_;
    OwnClock own_;
    Nanoseconds begun_{0}, had_{0};  // by the place's clock
    Clock::time_point looked_{};     // when it had had so much
    Nanoseconds answer_time_{0};     // from sending a bundle to its answer, smoothed
};

}  // namespace lightnet
