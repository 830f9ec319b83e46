#include "core/run/fiber/fiber.hpp"

#include <boost/context/fiber.hpp>
#include <boost/context/preallocated.hpp>

#include <cxxabi.h>
#include <x86intrin.h>
#include <cassert>
#include <exception>
#include <utility>

#include "core/run/fiber/fiber_stack.hpp"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace lightnet {

// Reading the clock costs as much as the switch itself, so the switches count the processor's own ticks; the clock says
// how long one is.
std::uint64_t processor_ticks() { return __rdtsc(); }

namespace {

using Clock = std::chrono::steady_clock;

// The counters of two processors may differ by a little.
std::uint64_t ticks_since(std::uint64_t then) {
    const auto now = processor_ticks();
    return now > then ? now - then : 0;
}

// What the C++ runtime keeps per thread about exceptions in flight, and must be kept per fiber: a fiber that parks
// inside a catch block would else have its exception rethrown in another one.
struct ExceptionState {
    void* caught = nullptr;
    unsigned int uncaught = 0;

    static ExceptionState& here() { return *reinterpret_cast<ExceptionState*>(abi::__cxa_get_globals()); }
};

// Tells the sanitizers which stack runs.
class SanitizerView {
public:
#if defined(__SANITIZE_ADDRESS__)
    void leave(const void* lowest, std::size_t size, bool for_ever = false) {
        __sanitizer_start_switch_fiber(for_ever ? nullptr : &fake_stack_, lowest, size);
    }
    void entered(const void** from = nullptr, std::size_t* size = nullptr) {
        __sanitizer_finish_switch_fiber(fake_stack_, from, size);
    }

private:
    void* fake_stack_ = nullptr;
#else
    void leave(const void*, std::size_t, bool = false) {}
    void entered(const void** = nullptr, std::size_t* = nullptr) {}
#endif
};

// Stacks are mapped and unmapped by us; Boost only builds its frame on them.
struct BorrowedStack {
    boost::context::stack_context allocate() { return {}; }
    void deallocate(boost::context::stack_context&) noexcept {}
};

}  // namespace

class Fibers::Fiber {
public:
    explicit Fiber(std::size_t stack_size) : stack(map_stack(stack_size)) {
#if defined(__SANITIZE_THREAD__)
        tsan = __tsan_create_fiber(0);
#endif
    }
    ~Fiber() {
#if defined(__SANITIZE_THREAD__)
        __tsan_destroy_fiber(tsan);
#endif
        inside = {};
        unmap_stack(stack);
    }

    StackMemory stack;
    boost::context::fiber inside;  // the fiber while it does not run
    std::function<void()> work;
    const char* owner = "";
    bool parked = false, cancelled = false, retiring = false, used_by_others = false;
    ExceptionState exceptions;
    SanitizerView view;
    Ticks entered = 0, ran = 0;
    std::uint16_t doing = 0;
    [[maybe_unused]] void* tsan = nullptr;
};

// The thread's own side of each switch.
struct Fibers::Shared {
    StackGuard::Running running;
    StackGuard guard{running};
    boost::context::fiber outside;
    std::exception_ptr failure;  // of the fiber that has just run
    ExceptionState exceptions;
    SanitizerView view;
    const void* outside_lowest = nullptr;
    std::size_t outside_size = 0;
    const Clock::time_point began = Clock::now();
    const Ticks began_ticks = processor_ticks();
    Ticks stint = 0, stint_ran = 0;
    std::atomic<std::uint16_t>* doing = nullptr;
    std::uint16_t outside_doing = 0;
    [[maybe_unused]] void* tsan = nullptr;
};

Fibers::Fibers(std::size_t stack_size) : stack_size_(stack_size), shared_(std::make_unique<Shared>()) {}

Fibers::~Fibers() {
    cancel_all();
    for (auto* fiber : std::exchange(idle_, {})) {  // let each loop end, so that no stack is dropped half way
        fiber->retiring = true;
        switch_to(fiber);
    }
}

void Fibers::start(const char* owner, std::function<void()> work) {
    assert(!current_ && "fibers are started from the thread's own stack");
    if (idle_.empty()) {
        auto* fresh = fibers_.emplace_back(std::make_unique<Fiber>(stack_size_)).get();
        boost::context::stack_context context;
        // Stacks begin at different distances from the ends of their pages, or all would want the same cache lines.
        const std::size_t colour = fibers_.size() % 16 * 192;
        context.size = fresh->stack.size - colour;
        context.sp = fresh->stack.lowest + context.size;
        fresh->inside =
            boost::context::fiber(std::allocator_arg, boost::context::preallocated(context.sp, context.size, context),
                                  BorrowedStack{}, [this, fresh](boost::context::fiber&& outside) {
                                      shared_->outside = std::move(outside);
                                      fresh->view.entered(&shared_->outside_lowest, &shared_->outside_size);
                                      while (!fresh->retiring) {
                                          try {
                                              fresh->work();
                                          } catch (const Cancelled&) {
                                          } catch (const boost::context::detail::forced_unwind&) {
                                              throw;
                                          } catch (...) {  // Boost would end the process
                                              shared_->failure = std::current_exception();
                                          }
                                          fresh->work = nullptr;
                                          fresh->cancelled = false;
                                          --alive_;
                                          idle_.push_back(fresh);
                                          leave();
                                      }
                                      fresh->view.leave(shared_->outside_lowest, shared_->outside_size, true);
#if defined(__SANITIZE_THREAD__)
                                      __tsan_switch_to_fiber(shared_->tsan, 0);
#endif
                                      return std::move(shared_->outside);
                                  });
        idle_.push_back(fresh);
    }
    auto* fiber = idle_.back();
    idle_.pop_back();
    fiber->owner = owner;
    fiber->work = std::move(work);
    fiber->cancelled = false;
    fiber->ran = 0;
    fiber->doing = shared_->outside_doing;
    ++alive_;
    switch_to(fiber);
}

void Fibers::switch_to(Fiber* fiber) {
    if (watcher_) watcher_->enters();
    current_ = fiber;
    fiber->parked = false;
    shared_->running = {fiber->stack, fiber->owner};
    if (shared_->doing) shared_->doing->store(fiber->doing, std::memory_order_relaxed);
    const Ticks began = fiber->entered = processor_ticks();
    shared_->exceptions = std::exchange(ExceptionState::here(), fiber->exceptions);
    shared_->view.leave(fiber->stack.lowest, fiber->stack.size);
#if defined(__SANITIZE_THREAD__)
    shared_->tsan = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(fiber->tsan, 0);
#endif
    fiber->inside = std::move(fiber->inside).resume();
    shared_->view.entered();
    fiber->exceptions = std::exchange(ExceptionState::here(), shared_->exceptions);
    const Ticks ended =
        std::max(processor_ticks(), fiber->entered);  // the counters of two processors may differ by a little
    fiber->ran += ended - fiber->entered;
    shared_->stint_ran += ended - std::min(began, ended);
    if (shared_->doing) {  // nobody else writes it, so no exchange is needed, which would cost more
        fiber->doing = shared_->doing->load(std::memory_order_relaxed);
        shared_->doing->store(shared_->outside_doing, std::memory_order_relaxed);
    }
    shared_->running = {};
    current_ = nullptr;
    if (watcher_) watcher_->left(fiber, fiber->owner, !fiber->work);
    if (shared_->failure) std::rethrow_exception(std::exchange(shared_->failure, nullptr));
}

void Fibers::park() {
    if (current_ && current_->cancelled) throw Cancelled{};
    auto* const fiber = current_;
    leave();
    if (fiber->cancelled && fiber->work) throw Cancelled{};
}

void Fibers::park_for_others() {
    assert(current_ && "only a fiber can park");
    current_->used_by_others = true;
    leave();
}

// Back to the thread's own stack, until somebody switches here again.
void Fibers::leave() {
    auto* const fiber = current_;
    assert(fiber && "only a fiber can park");
    fiber->parked = true;
    fiber->view.leave(shared_->outside_lowest, shared_->outside_size);
#if defined(__SANITIZE_THREAD__)
    __tsan_switch_to_fiber(shared_->tsan, 0);
#endif
    shared_->outside = std::move(shared_->outside).resume();
    fiber->view.entered(&shared_->outside_lowest, &shared_->outside_size);
}

void Fibers::release(Fiber* fiber) { fiber->used_by_others = false; }

void Fibers::resume(Fiber* fiber) {
    assert(!current_ && fiber->parked && "only a parked fiber can be resumed, from the thread's own stack");
    switch_to(fiber);
}

void Fibers::cancel_all() {
    while (alive_ > 0) {
        const std::size_t before = alive_;
        for (std::size_t i = 0; i < fibers_.size(); ++i) {
            auto* fiber = fibers_[i].get();
            if (!fiber->work || !fiber->parked || fiber->used_by_others) continue;
            fiber->cancelled = true;
            try {
                switch_to(fiber);
            } catch (...) {  // nobody waits for what it was at
            }
        }
        assert(alive_ < before && "a cancelled fiber must unwind");
        if (alive_ >= before) break;
    }
}

Fibers::Ticks Fibers::ticks_of(const Fiber* fiber) const {
    return fiber == current_ ? fiber->ran + ticks_since(fiber->entered) : fiber->ran;
}

double Fibers::ticks_per_nanosecond() const {
    const auto elapsed = std::chrono::duration<double, std::nano>(Clock::now() - shared_->began);
    return static_cast<double>(ticks_since(shared_->began_ticks)) / std::max(elapsed.count(), 1.0);
}

std::chrono::nanoseconds Fibers::running_time(const Fiber* fiber) const {
    const double rate = ticks_per_nanosecond();
    return std::chrono::nanoseconds(rate > 0 ? static_cast<std::int64_t>(static_cast<double>(ticks_of(fiber)) / rate)
                                             : 0);
}

void Fibers::begin_stint(std::chrono::nanoseconds length) {
    shared_->stint = static_cast<Ticks>(static_cast<double>(length.count()) * ticks_per_nanosecond());
    shared_->stint_ran = 0;
}

bool Fibers::stint_over() const { return shared_->stint_ran >= shared_->stint; }

void Fibers::give_time_to(Fiber* other) {
    other->ran += ticks_of(current_);
    current_->ran = 0;
    current_->entered = processor_ticks();
}

void Fibers::show(std::atomic<std::uint16_t>& doing, std::uint16_t outside) {
    shared_->doing = &doing;
    shared_->outside_doing = outside;
}

void Fibers::do_as(const Fiber* other) {
    if (shared_->doing) shared_->doing->store(other->doing, std::memory_order_relaxed);
}

const char* Fibers::rename(const char* owner) {
    assert(current_ && "only a fiber has a name");
    shared_->running.owner = owner;
    return std::exchange(current_->owner, owner);
}

bool Fibers::roomy() const { return !idle_.empty() || stacks_mapped() < most_stacks; }

}  // namespace lightnet
