#include "core/run/fiber/fiber_stack.hpp"

#include <atomic>
#include <csignal>
#include <cstring>
#include <mutex>
#include <new>

#include <sys/mman.h>
#include <unistd.h>

namespace lightnet {
namespace {

std::atomic<std::size_t> mapped{0};

thread_local const StackGuard::Running* running_here = nullptr;

std::size_t page_size() {
    static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return size;
}

}  // namespace

StackMemory map_stack(std::size_t size) {
    const std::size_t guard = page_size();
    const std::size_t whole = (size + guard - 1) / guard * guard + guard;
    void* memory =
        mmap(nullptr, whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    auto* lowest = static_cast<std::byte*>(memory);
    if (mprotect(lowest, guard, PROT_NONE) != 0) {
        munmap(memory, whole);
        throw std::bad_alloc();
    }
    mapped.fetch_add(1, std::memory_order_relaxed);
    return {lowest + guard, whole - guard};
}

void unmap_stack(const StackMemory& stack) noexcept {
    munmap(stack.lowest - page_size(), stack.size + page_size());
    mapped.fetch_sub(1, std::memory_order_relaxed);
}

std::size_t stacks_mapped() { return mapped.load(std::memory_order_relaxed); }

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// The sanitizers bring handlers and signal stacks of their own.
StackGuard::StackGuard(const Running& running) { running_here = &running; }
StackGuard::~StackGuard() { running_here = nullptr; }
#else
namespace {

void say(const char* text) { (void)!write(STDERR_FILENO, text, std::strlen(text)); }

// Runs on the signal stack: async-signal-safe calls only.
void on_fault(int signal, siginfo_t* info, void*) {
    const auto* running = running_here;
    const auto* address = static_cast<const std::byte*>(info->si_addr);
    if (running && running->stack.lowest && address < running->stack.lowest &&
        address >= running->stack.lowest - page_size()) {
        say("the stack of node '");
        say(running->owner);
        say("' ran out: it recurses too deeply or keeps large arrays on the stack\n");
    }
    struct sigaction plain {};
    plain.sa_handler = SIG_DFL;
    sigaction(signal, &plain, nullptr);  // the fault happens again and ends the process as it always would
}

void install_handler() {
    static std::once_flag once;
    std::call_once(once, [] {
        struct sigaction action {};
        action.sa_sigaction = on_fault;
        action.sa_flags = SA_SIGINFO | SA_ONSTACK;
        sigaction(SIGSEGV, &action, nullptr);
        sigaction(SIGBUS, &action, nullptr);
    });
}

void use_signal_stack(std::byte* memory, std::size_t size) {
    stack_t stack{};
    stack.ss_sp = memory;
    stack.ss_size = size;
    stack.ss_flags = memory ? 0 : SS_DISABLE;
    sigaltstack(&stack, nullptr);
}

}  // namespace

StackGuard::StackGuard(const Running& running) : signal_stack_(64 * 1024) {
    running_here = &running;
    use_signal_stack(signal_stack_.data(), signal_stack_.size());
    install_handler();
}
StackGuard::~StackGuard() {
    use_signal_stack(nullptr, 0);
    running_here = nullptr;
}
#endif

}  // namespace lightnet
