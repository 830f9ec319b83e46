// Many small pieces of work of one node, of which any may wait while others go on.
#pragma once

#include <cstddef>
#include <functional>

namespace lightnet {

/// Does pieces of work concurrently, on one thread. Belongs to one place and is used by its thread only.
class Concurrent {
public:
    /// Is given 0, 1, … count - 1, each once.
    using Work = std::function<void(std::size_t)>;

    virtual ~Concurrent() = default;
    /// Calls `work` for each of `count` pieces; while one waits for an input, others may be begun, at most `at_once` at
    /// a time. Returns when all have ended. Throws what the first of those threw that threw anything, and then begins
    /// no more. `node` names who works.
    virtual void each(const char* node, std::size_t count, std::size_t at_once, const Work& work) = 0;
};

}  // namespace lightnet
