// Memory for the stacks of fibers: committed as it is used, with a guard page that turns an overflow into a message.
#pragma once

#include <cstddef>
#include <vector>

namespace lightnet {

/// The usable part of one stack; the guard page lies below.
struct StackMemory {
    std::byte* lowest = nullptr;
    std::size_t size = 0;
};

/// Maps one stack and its guard page. Throws std::bad_alloc when the system gives no more.
StackMemory map_stack(std::size_t size);
void unmap_stack(const StackMemory& stack) noexcept;

/// Stacks that this process has mapped. Any thread.
std::size_t stacks_mapped();
/// Each stack is two mappings, of the 65,530 that Linux allows a process. What can be done with fewer is done with
/// fewer from here on.
inline constexpr std::size_t most_stacks = 16 * 1024;

/// From now on, a write into the guard page of the stack that `running` names on this thread ends the process with a
/// sentence that says whose stack ran out. `running` must live as long as the guard.
class StackGuard {
public:
    struct Running {
        StackMemory stack;
        const char* owner = "";
    };
    explicit StackGuard(const Running& running);
    ~StackGuard();
    StackGuard(const StackGuard&) = delete;
    StackGuard& operator=(const StackGuard&) = delete;

private:
    std::vector<std::byte> signal_stack_;
};

}  // namespace lightnet
