#include "transport/daemon/background_work.hpp"

#include <algorithm>
#include <chrono>

namespace lightnet {

BackgroundWork::~BackgroundWork() { under_way_.clear(); }

void BackgroundWork::clear() {
    wakeup_.clear();
    std::erase_if(under_way_,
                  [](const auto& one) { return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
}

bool BackgroundWork::done_within(std::chrono::milliseconds most) const {
    const auto end = std::chrono::steady_clock::now() + most;
    return std::all_of(under_way_.begin(), under_way_.end(),
                       [&](const auto& one) { return one.wait_until(end) == std::future_status::ready; });
}

void BackgroundWork::start_thread(std::function<void()> work) {
    under_way_.push_back(std::async(std::launch::async, [this, work = std::move(work)] {
        work();
        wakeup_.notify();
    }));
}

}  // namespace lightnet
