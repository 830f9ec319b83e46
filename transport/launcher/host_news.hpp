// News that a host gives of itself with its answers to heartbeats.
#pragma once

#include <cstdint>

#include "core/run/message/figures.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet {

/// How far the clock of a host is ahead of ours, nanoseconds.
struct ClockAhead {
    std::int64_t ahead = 0;
    std::uint64_t error = ~std::uint64_t{0};  // at most

    /// The host read its clock between our question and its answer: what took least time tells most.
    void compare(std::uint64_t asked_at, std::uint64_t its_clock, std::uint64_t now) {
        if (asked_at > now || (now - asked_at) / 2 >= error) return;
        error = (now - asked_at) / 2;
        ahead = static_cast<std::int64_t>(its_clock - (asked_at + error));
    }
};

/// As of the last one.
struct HostNews {
    std::uint64_t progress = 0, pulse = 0;  // see HostLink
    Doings doing;
    HostFigures figures;
    ClockAhead clock;

    void take(const packet::Fields& pong) {
        progress = pong.number("progress");
        pulse = pong.number("pulse");
        doing = doings_from(pong.text("doing"));
        if (auto seen = figures_from(pong.text("figures"))) figures = std::move(*seen);
    }
};

}  // namespace lightnet
