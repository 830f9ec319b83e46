// Work on all cores that may lack memory.
#pragma once

#include <atomic>
#include <cstddef>
#include <new>

#include "core/base/thread_pool.hpp"

namespace lightnet::cleaning {

/// parallel_for() of work that takes memory. Throws std::bad_alloc, when all pieces have ended, if there was none for
/// one.
template <class Work>
void in_large_pieces(std::size_t count, const Work& work, std::size_t piece) {
    std::atomic<bool> lacks_memory{false};
    parallel_for(
        count,
        [&](std::size_t first, std::size_t last) {
            try {
                work(first, last);
            } catch (const std::bad_alloc&) {
                lacks_memory = true;
            }
        },
        piece);
    if (lacks_memory) throw std::bad_alloc();
}

}  // namespace lightnet::cleaning
