// Background work of a thread that must stay free to listen.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "transport/places/wakeup.hpp"

namespace lightnet {

/// Work in threads of its own, whose ends wake who polls. Used by one thread.
class BackgroundWork {
public:
    /// Throws Error when the system has no more handles.
    BackgroundWork() = default;
    /// Waits until all is done.
    ~BackgroundWork();
    BackgroundWork(const BackgroundWork&) = delete;
    BackgroundWork& operator=(const BackgroundWork&) = delete;

    /// To be polled: readable when a future has become ready since the last clear().
    int handle() const { return wakeup_.handle(); }
    void clear();
    /// Waits until all is done, for so long at most. True if it is.
    bool done_within(std::chrono::milliseconds most) const;

    /// Throws std::system_error when no thread can be had.
    template <class Work>
    std::future<std::invoke_result_t<Work>> start(Work work) {
        auto task = std::make_shared<std::packaged_task<std::invoke_result_t<Work>()>>(std::move(work));
        auto made = task->get_future();
        start_thread([task] { (*task)(); });
        return made;
    }

private:
    void start_thread(std::function<void()> work);

    Wakeup wakeup_;
    std::vector<std::future<void>> under_way_;
};

}  // namespace lightnet
