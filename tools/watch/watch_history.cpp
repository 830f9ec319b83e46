#include "tools/watch/watch_history.hpp"

#include <utility>

namespace lightnet {
namespace {

constexpr std::size_t most_states = 240, most_bytes = 1'000'000;

}  // namespace

void WatchHistory::add(const std::string& state, Pace::Clock::time_point now) {
    states_.push_back(state);
    if (states_.size() >= most_states || states_.size() * state.size() > most_bytes) {
        halve();
        period_ *= 2;
        pace_ = Pace(period_, now);
    }
    pace_.put_off(now);
}

void WatchHistory::halve() {
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < states_.size(); i += 2) kept.push_back(std::move(states_[i]));
    states_ = std::move(kept);
}

}  // namespace lightnet
