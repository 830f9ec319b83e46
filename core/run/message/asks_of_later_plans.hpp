// Asks of those who go by a plan that is not known here yet.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "core/run/message/message.hpp"

namespace lightnet {

/// Keeps them until that plan is there. Lines don't wait for each other, so an ask may overtake the plan. By the one
/// before, copies of nodes would be asked that have been taken from their places: nobody collects what these note in a
/// rehearsal, and when it is over they still answer as in one. So all that an ask leads to goes by its plan, or by a
/// later one. The launcher brings each plan to all, so nothing waits for long. One thread's.
class AsksOfLaterPlans {
public:
    /// More than wait for one plan, of hosts that keep to their credit: what others send beyond is dropped.
    static constexpr std::size_t most = 1 << 14;

    /// True: it has been kept, as its plan is none of those up to `edition`.
    bool keep(Message& ask, std::uint32_t edition) {
        if (ask.edition <= edition) return false;
        if (kept_.size() < most) kept_.push_back(std::move(ask));
        return true;
    }
    /// Those that need not wait any more, as they came.
    std::vector<Message> due(std::uint32_t edition) {
        const auto later = std::stable_partition(kept_.begin(), kept_.end(),
                                                 [&](const Message& ask) { return ask.edition <= edition; });
        std::vector<Message> due(std::make_move_iterator(kept_.begin()), std::make_move_iterator(later));
        kept_.erase(kept_.begin(), later);
        return due;
    }

private:
    std::vector<Message> kept_;
};

}  // namespace lightnet
