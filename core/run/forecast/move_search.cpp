#include "core/run/forecast/move_search.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace lightnet {
namespace {

constexpr std::size_t most_search_steps = 4e6;  // of all estimates: some hundredths of a second
constexpr double in_transit = 1.25;             // of what a host may keep, while it has what comes and what goes
constexpr double hardly_less = 0.995;           // of the seconds before: less is not worth a step

}  // namespace

MoveSearch::MoveSearch(const RunCosts& costs, const std::vector<ForecastHost>& hosts, const LineCost& launcher,
                       const HeldByHosts& kept)
    : costs_(costs),
      hosts_(hosts),
      kept_(kept),
      options_(costs, hosts, needed_nodes(costs)),
      estimate_(costs, hosts, launcher) {}

double MoveSearch::seconds(const HeldByHosts& holds) {
    steps_ += estimate_.steps();
    return estimate_.seconds(holds);
}

HeldByHosts MoveSearch::better_than(HeldByHosts holds) {
    least_ = seconds(holds);
    busy_ = estimate_.busy();
    busy_.resize(hosts_.size());  // none was estimated where a node is nowhere
    while (step_of_one(holds) || step_of_two(holds)) {
    }
    return holds;
}

// The busiest host first, whom others are to relieve; then those who have least to do.
std::vector<std::size_t> MoveSearch::by_need() const {
    std::vector<std::size_t> order(hosts_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return busy_[a] < busy_[b]; });
    std::rotate(order.begin(), std::prev(order.end()), order.end());
    return order;
}

// Memory allows it; and who holds nothing any more could not go on answering while others prepare what it had.
bool MoveSearch::may_be(std::size_t host, const std::vector<bool>& held) const {
    if (std::find(held.begin(), held.end(), true) == held.end()) return false;
    auto both = held;
    for (std::size_t node = 0; node < both.size(); ++node) both[node] = both[node] || kept_[host][node];
    ForecastHost wide = hosts_[host];
    wide.memory *= in_transit;
    return has_room(costs_, wide, both);
}

bool MoveSearch::takes(HeldByHosts& holds, const HeldByHosts& other) {
    const double found = seconds(other);
    if (!(found < hardly_less * least_)) return false;
    holds = other;
    least_ = found;
    busy_ = estimate_.busy();
    return true;
}

bool MoveSearch::step_of_one(HeldByHosts& holds) {
    bool stepped = false;
    for (const auto host : by_need())
        for (const auto& option : options_.of(host)) {
            if (option == holds[host] || !may_be(host, option)) continue;
            if (steps_ >= most_search_steps) return false;
            auto other = holds;
            other[host] = option;
            stepped = takes(holds, other) || stepped;
        }
    return stepped;
}

// One of them is the busiest: no other pair makes the whole quicker.
bool MoveSearch::step_of_two(HeldByHosts& holds) {
    const auto order = by_need();
    for (std::size_t other = 1; other < order.size(); ++other)
        if (step_with(holds, order.front(), order[other])) return true;
    return false;
}

bool MoveSearch::step_with(HeldByHosts& holds, std::size_t one, std::size_t two) {
    for (const auto& of_two : options_.of(two)) {
        if (of_two == holds[two] || !may_be(two, of_two)) continue;
        for (const auto& of_one : options_.of(one)) {
            if (of_one == holds[one] || !may_be(one, of_one)) continue;
            if (steps_ >= most_search_steps) return false;
            auto other = holds;
            other[one] = of_one, other[two] = of_two;
            if (takes(holds, other)) return true;
        }
    }
    return false;
}

}  // namespace lightnet
