#include "transport/lines/look_first.hpp"

#include <algorithm>

#include "core/base/allowance.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;

constexpr auto longest = 20us;
// A look that ends so late was interrupted, since another program wanted the processor.
constexpr auto late = 3 * longest;
constexpr auto rest = 100ms;
constexpr unsigned most_doublings = 6;

}  // namespace

AwakeThreads& AwakeThreads::of_process() {
    static AwakeThreads awake(usable_cores());
    return awake;
}

bool LookFirst::look(const std::function<bool()>& found) {
    if (to_leave_out_ > 0) return --to_leave_out_, false;
    if (!awake_.has_room()) return false;
    const auto begun = clock_();
    if (begun < none_before_) return false;
    if (look_until(begun, found)) {
        in_vain_ = 0;
        return true;
    }
    in_vain_ = std::min(in_vain_ + 1, most_doublings);
    to_leave_out_ = (1u << in_vain_) - 1;
    return false;
}

bool LookFirst::look_until(Time begun, const std::function<bool()>& found) {
    for (auto now = begun; now - begun < longest;) {
        if (found()) return true;
        if (!awake_.has_room()) return false;
        now = clock_();
        if (now - begun >= late) none_before_ = now + rest;
    }
    return false;
}

}  // namespace lightnet
