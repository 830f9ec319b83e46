// What other places take off one that has more to do than they.
#include <algorithm>
#include <utility>

#include "core/run/runtime/place.hpp"

namespace lightnet {
namespace {

constexpr double enough = 0.05;       // seconds of work for each helper: it is asked again long before they are over
constexpr std::size_t at_first = 64;  // questions, as long as nobody knows how long they take
constexpr auto judged_every = std::chrono::milliseconds(10);
constexpr double lessened = 0.85, raised = 1.03;  // times what they got before
constexpr double least_part = 0.01;         // so that it is tried again

}  // namespace

bool Place::called_here(std::size_t node) const { return tuning_.call_own_nodes && holds(node); }

// Other places that hold the node, but not all that this one holds: such have as much to do as this one.
std::vector<std::uint32_t> Place::helpers(std::size_t node) const {
    const auto& holders = plan_.places_of[node];
    std::vector<std::uint32_t> helpers;
    for (const auto place : holders) {
        const auto lacks_one = [&](const std::vector<std::uint32_t>& held_by) {
            return std::find(held_by.begin(), held_by.end(), place) == held_by.end() &&
                   std::any_of(held_by.begin(), held_by.end(), [&](auto i) { return plan_.places[i] == me_; });
        };
        if (plan_.places[place] != me_ && std::any_of(plan_.places_of.begin(), plan_.places_of.end(), lacks_one))
            helpers.push_back(place);
    }
    return helpers;
}

// Who is asked by bundles: where this place holds the node, its helpers, and it itself in reserve.
Plan Place::plan_for(std::size_t node) const {
    if (!called_here(node)) return plan_;
    Plan plan = plan_;
    const auto others = helpers(node);
    std::erase_if(plan.places_of[node], [&](auto place) {
        return plan.places[place] != me_ && std::find(others.begin(), others.end(), place) == others.end();
    });
    return plan;
}

void Place::use(std::size_t node, std::size_t width, PlannedPort& port) {
    port.use(called_here(node));
    const auto count = called_here(node) ? helpers(node).size() : 0;
    if (count == 0) return;
    // Others that hold what this one does give to the same helpers.
    const auto holders = static_cast<double>(plan_.places_of[node].size()), help = static_cast<double>(count);
    relieved_.push_back({node, width, &port, count, help / holders, help / (help + 1)});
}

// Who waits has given away too much; who never does may give more.
void Place::judge(Relieved& relieved, Clock::time_point now) {
    if (now - relieved.judged < judged_every) return;
    relieved.judged = now;
    const double next = relieved.part * (std::exchange(relieved.idled, false) ? lessened : raised);
    relieved.part = std::clamp(next, least_part, relieved.most);
}

// At first an ask is shared evenly among all who hold the node. Helpers are given no more than they answer in a moment,
// and no more than a few bundles.
// DECISIONS: relief-by-the-idle
void Place::relieve(Clock::time_point now, bool idle) {
    for (auto& relieved : relieved_) {
        const auto found = remotes_.find({relieved.node, relieved.width});
        const auto* bundles = found == remotes_.end() ? nullptr : found->second.port.get();
        const std::size_t under_way = bundles ? bundles->unanswered() : 0;
        const double seconds = bundles ? bundles->seconds_of_one() : 0;  // of all together
        const double most = double(relieved.helpers * tuning_.eager * tuning_.bundle);
        const auto room = static_cast<std::size_t>(seconds > 0 ? std::clamp(enough / seconds, 1.0, most)
                                                               : double(relieved.helpers * at_first));
        relieved.idled |= idle && under_way > 0;
        judge(relieved, now);
        relieved.port->relieve({room > under_way ? room - under_way : 0, relieved.part});
    }
}

}  // namespace lightnet
