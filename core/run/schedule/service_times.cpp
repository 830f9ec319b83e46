#include "core/run/schedule/service_times.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr double fading = 0.8;  // how much of the past a measurement keeps with each new one
// Of the spread: what costs much, as a mesh below a sky, comes now and then.
constexpr double slow_fading = 0.97;
constexpr double most_spread = 16;

}  // namespace

ServiceTimes::Measured& ServiceTimes::at(Replica replica) {
    if (replica >= measured_.size()) measured_.resize(replica + 1);
    return measured_[replica];
}

void ServiceTimes::forget(Replica replica) {
    take_part(replica, 0);
    at(replica) = {};
}

void ServiceTimes::measure(Replica replica, double seconds, std::size_t questions, double reported) {
    auto& measured = at(replica);
    spread_ = std::max(1.0, slow_fading * spread_);
    if (const double mean = of(replica); mean > 0 && questions > 0)
        spread_ = std::max(spread_, std::min(most_spread, seconds / static_cast<double>(questions) / mean));
    measured.seconds = fading * measured.seconds + seconds;
    measured.questions = fading * measured.questions + static_cast<double>(questions);
    if (reported <= 0) return;
    measured.reported = reported;
    said_ = said_ > 0 ? fading * said_ + (1 - fading) * reported : reported;
}

void ServiceTimes::fade(Replica replica) {
    constexpr double kept = 0.1, quicker = 1.0 / 64;
    auto& measured = at(replica);
    measured.seconds *= kept * quicker, measured.questions *= kept;
    measured.reported *= quicker;
}

void ServiceTimes::take_part(Replica replica, std::uint32_t places) {
    auto& measured = at(replica);
    const double service = of(replica);
    if (service <= 0) places = 0;
    const double rate = places > 0 ? places / service : 0;
    known_ = known_ + places - measured.counted_for;
    rate_ = known_ > 0 ? rate_ + rate - measured.counted : 0;
    measured.counted = rate;
    measured.counted_for = places;
}

double ServiceTimes::of(Replica replica) const {
    if (replica >= measured_.size()) return 0;
    const auto& measured = measured_[replica];
    return measured.questions > 0 ? std::max(measured.seconds / measured.questions, measured.reported)
                                  : measured.reported;
}

double ServiceTimes::assumed(Replica replica) const {
    const double known = of(replica);
    if (known != 0) return known;
    return any() ? mean() : unknown;
}

}  // namespace lightnet
