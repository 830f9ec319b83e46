// What takes time, done beside a thread that must stay free to listen.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace lightnet {

/// Work in threads of its own, whose ends wake who polls. Used by one thread.
class Beside {
public:
    /// Throws Error when the system has no more handles.
    Beside();
    /// Waits until all is done.
    ~Beside();
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;

    /// To be polled: readable when a future has become ready since the last clear().
    int handle() const { return handle_; }
    void clear();

    template <class Work>
    std::future<std::invoke_result_t<Work>> start(Work work) {
        auto task = std::make_shared<std::packaged_task<std::invoke_result_t<Work>()>>(std::move(work));
        auto made = task->get_future();
        start_thread([task] { (*task)(); });
        return made;
    }

private:
    void start_thread(std::function<void()> work);

    int handle_;
    std::vector<std::future<void>> under_way_;
};

}  // namespace lightnet
