// Fibers: work that may wait without holding up its thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

namespace lightnet {

/// Thrown out of a wait when the work is no longer wanted. Nothing but the fiber's own end should catch it.
struct Cancelled {};

/// All fibers of one thread. Fibers never change threads. Work runs until it parks or ends; then another may run.
class Fibers {
public:
    class Fiber;

    /// Stacks are `stack_size` bytes each, mapped when first used and kept for the next fiber.
    explicit Fibers(std::size_t stack_size = 256 * 1024);
    /// Cancels what still waits.
    ~Fibers();
    Fibers(const Fibers&) = delete;
    Fibers& operator=(const Fibers&) = delete;

    /// Runs `work` in a fiber, at once, until it first parks. `owner` names it if its stack runs out; it must outlive
    /// the fiber. `work` must not throw anything but Cancelled. Call from outside fibers only.
    void start(const char* owner, std::function<void()> work);

    /// The fiber that runs now; null outside.
    Fiber* current() const { return current_; }
    /// Parks the current fiber until resume(). Throws Cancelled if cancel_all() ended the wait.
    void park();
    /// Continues a parked fiber until it parks again or ends. Call from outside fibers only.
    void resume(Fiber* fiber);
    /// Resumes every parked fiber with Cancelled, until all have unwound.
    void cancel_all();

    /// Fibers that have started and not ended.
    std::size_t alive() const { return alive_; }
    /// How long `fiber` has been running (not waiting) since its start.
    std::chrono::nanoseconds running_time(const Fiber* fiber) const;

private:
    void switch_to(Fiber* fiber);

    struct Shared;
    std::size_t stack_size_;
    std::unique_ptr<Shared> shared_;
    std::vector<std::unique_ptr<Fiber>> fibers_;
    std::vector<Fiber*> idle_;
    Fiber* current_ = nullptr;
    std::size_t alive_ = 0;
};

}  // namespace lightnet
