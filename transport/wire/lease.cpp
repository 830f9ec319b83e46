#include "transport/wire/lease.hpp"

#include <algorithm>

namespace lightnet {
namespace {

constexpr int times_later = 4;  // than before he may be
constexpr auto kept_in_mind = std::chrono::seconds(30);

}  // namespace

void Lease::begin(Time now) {
    heard_ = now;
    late_ = {};
}

void Lease::heard(Time now) {
    const auto late = std::max(now - heard_ - interval_, Duration{});
    heard_ = now;
    if (late < late_ && now - late_at_ < kept_in_mind) return;
    late_ = late;
    late_at_ = now;
}

Lease::Duration Lease::length() const { return std::min(shortest_ + times_later * late_, longest_); }

}  // namespace lightnet
