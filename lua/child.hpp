// Does a piece of work in a process of its own, which can be killed when it takes too much.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace lightnet::lua {

/// What the child may take.
struct Budget {
    double cpu_seconds = 2;
    double wall_seconds = 10;
    std::size_t memory = std::size_t{512} << 20;  // bytes, beside what its parent has
    std::size_t output = std::size_t{16} << 20;   // bytes
};

/// Forks, runs `work` in the child and returns its text. The child has no open file but two pipes to us, can't write to
/// files, and dies with its parent. What it writes to standard error comes out of ours, up to 64 KiB of it. Throws
/// Error that says why there is no answer. Call it while there are no other threads: of them the child would have only
/// the locks.
std::string in_child(const Budget& budget, const std::function<std::string()>& work);

}  // namespace lightnet::lua
