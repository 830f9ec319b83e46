#include "tools/support/time_limit.hpp"

#include <algorithm>

#include "core/film/tile.hpp"

namespace lightnet {
namespace {

constexpr double safe_part = 0.9;            // of the time that is left: what is begun should be finished
constexpr std::uint32_t parts_of_limit = 4;  // of it, of which one is taken by a step of several blocks
constexpr std::uint32_t times = 4;  // the last step, as what little of it was seen may have been quick by chance
constexpr std::uint32_t whole_group = samples_per_block * blocks_per_group;
constexpr double most_samples = 1u << 28;

}  // namespace

std::optional<std::chrono::milliseconds> TimeLimit::left(Time now) const {
    if (!end_) return std::nullopt;
    return std::max(std::chrono::ceil<std::chrono::milliseconds>(*end_ - now), std::chrono::milliseconds(0));
}

void TimeLimit::took(std::uint32_t samples, std::chrono::duration<double> time) {
    if (samples == 0) return;
    seconds_per_sample_ = std::max(time.count(), 1e-9) / samples;
    last_ = samples;
}

std::uint32_t TimeLimit::next(std::uint32_t there, std::uint32_t wanted, Time now) const {
    if (over(now) || there >= wanted) return 0;
    if (!end_) return wanted;
    if (!seconds_per_sample_) return there + 1;
    const double left = safe_part * std::chrono::duration<double>(*end_ - now).count();
    const auto fitting = static_cast<std::uint32_t>(std::min(left / *seconds_per_sample_, most_samples));
    const std::uint32_t base = there / samples_per_block * samples_per_block;
    std::uint32_t more = fitting;
    if (fitting >= samples_per_block) {
        const std::uint32_t most = std::min(fitting / parts_of_limit, times * last_);
        more = std::max(most, samples_per_block) / samples_per_block * samples_per_block;
        if (more >= whole_group) more -= (base + more) % whole_group;
    }
    const std::uint32_t next = std::min(more, wanted - base) + base;
    return next > there ? next : 0;
}

}  // namespace lightnet
