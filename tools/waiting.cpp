#include "tools/waiting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace lightnet {

std::optional<std::string> why_it_waits(const std::string& state) {
    constexpr std::string_view waits = "waits: ";
    return state.starts_with(waits) ? std::optional(state.substr(waits.size())) : std::nullopt;
}

std::optional<std::string> Waiting::words(const std::vector<HostState>& hosts, Time now) {
    if (now < next_) return std::nullopt;
    pause_ = std::min(longest, 2 * pause_);
    next_ = now + pause_;
    std::string text;
    for (const auto& host : hosts)
        if (const auto why = why_it_waits(host.state)) text += "\n  " + host.name + " is busy: " + *why;
    if (text.empty()) return std::nullopt;
    const auto waited = std::chrono::duration_cast<std::chrono::seconds>(now - begun_).count();
    return fmt::format("waiting for {} s:{}", waited, text);
}

}  // namespace lightnet
