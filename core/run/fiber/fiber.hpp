// Fibers: work that may wait without holding up its thread.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/base/unwanted.hpp"

namespace lightnet {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr std::size_t usual_stack_size = 2048 * 1024;  // what a sanitizer puts around each variable takes room
#else
inline constexpr std::size_t usual_stack_size = 512 * 1024;
#endif

class FiberWatcher;

/// The processor's own counter, which says how long fibers run. A program may have another in its place: one whose time
/// is simulated.
[[gnu::weak]] std::uint64_t processor_ticks();

/// All fibers of one thread. Fibers never change threads. Work runs until it parks or ends; then another may run.
class Fibers {
public:
    class Fiber;

    /// Stacks are `stack_size` bytes each, mapped when first used and kept for the next fiber.
    explicit Fibers(std::size_t stack_size = usual_stack_size);
    /// Cancels what still waits.
    ~Fibers();
    Fibers(const Fibers&) = delete;
    Fibers& operator=(const Fibers&) = delete;

    /// Runs `work` in a fiber, at once, until it first parks. `owner` names it if its stack runs out; it must outlive
    /// the fiber. What `work` throws, but for Cancelled, comes out of here or of resume(). Call from outside fibers
    /// only.
    void start(const char* owner, std::function<void()> work);

    /// The fiber that runs now; null outside.
    Fiber* current() const { return current_; }
    /// Parks the current fiber until resume(). Throws Cancelled if cancel_all() ended the wait.
    void park();
    /// Parks the current fiber until resume(). Never throws and is not cancelled: other fibers still use its stack.
    /// Whoever ends the wait calls release() first.
    void park_for_others();
    /// What a fiber in park_for_others() has waited for is there.
    void release(Fiber* fiber);
    /// Continues a parked fiber until it parks again or ends. Call from outside fibers only.
    void resume(Fiber* fiber);
    /// Resumes every parked fiber with Cancelled, until all have unwound.
    void cancel_all();

    /// Fibers that have started and not ended.
    std::size_t alive() const { return alive_; }
    /// How long `fiber` has been running (not waiting) since its start.
    std::chrono::nanoseconds running_time(const Fiber* fiber) const;
    /// Counts the running time of the current fiber as that of `other`: it worked for it.
    void give_time_to(Fiber* other);
    /// Begins to count what fibers run, for stint_over().
    void begin_stint(std::chrono::nanoseconds length);
    /// Have fibers run for as long as the stint lasts? Known without a look at the clock.
    bool stint_over() const;
    /// Names the current fiber anew, should its stack run out. Returns the name that it had.
    const char* rename(const char* owner);
    /// Is told from now on when fibers run; null: nobody is.
    void watch(FiberWatcher* watcher) { watcher_ = watcher; }
    /// `doing` says what this thread is at, for other threads to look at. While a fiber does not run, what it was at is
    /// kept for it; between fibers it is `outside`. It must outlive the fibers.
    void show(std::atomic<std::uint16_t>& doing, std::uint16_t outside);
    /// The current fiber works for `other`, and so is at what that is at.
    void do_as(const Fiber* other);
    /// Is there room for one more fiber, as far as the process is concerned?
    bool roomy() const;

private:
    using Ticks = std::uint64_t;
    void switch_to(Fiber* fiber);
    void leave();
    Ticks ticks_of(const Fiber* fiber) const;
    double ticks_per_nanosecond() const;

    struct Shared;
    std::size_t stack_size_;
    std::unique_ptr<Shared> shared_;
    std::vector<std::unique_ptr<Fiber>> fibers_;
    std::vector<Fiber*> idle_;
    Fiber* current_ = nullptr;
    std::size_t alive_ = 0;
    FiberWatcher* watcher_ = nullptr;
};

/// Is told which fiber runs, on its thread.
class FiberWatcher {
public:
    virtual ~FiberWatcher() = default;
    /// A fiber begins to run, or goes on.
    virtual void enters() = 0;
    /// It has parked, or has `ended`; `owner` is its name.
    virtual void left(const Fibers::Fiber* fiber, const char* owner, bool ended) = 0;
};

}  // namespace lightnet
