// Waiting at several sockets at once.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "transport/lines/frame_queue.hpp"

struct pollfd;

namespace lightnet {

/// What can be waited at by its descriptor, and may hold more than that tells.
class Waitable {
public:
    virtual ~Waitable() = default;
    /// Is there something?
    virtual bool readable() const = 0;
    /// There was nothing when it was last looked at, and nothing was done with it since: descriptor() is readable when
    /// there may be something again.
    virtual bool quiet() const = 0;
    /// To wait at. Only what is quiet tells by it.
    virtual int descriptor() const = 0;
};

/// What one thread waits for: sockets, queues and descriptors, numbered in the order in which they were added. Made
/// anew for each wait; they must live as long. Looking into an empty socket costs a call of the system, so who waits
/// had better look only where something is readable.
class Poll {
public:
    Poll();
    ~Poll();
    Poll(const Poll&) = delete;
    Poll& operator=(const Poll&) = delete;

    void add(const Waitable& socket);
    /// Of which this thread takes.
    void add(FrameQueue& queue);
    void add(int descriptor);
    std::size_t size() const { return items_.size(); }
    /// Returns when something is readable, or after `most`, or when the process was sent a signal. Throws LineError
    /// when something is wrong with what it waits for.
    void wait(std::chrono::milliseconds most);
    /// Does as wait(), but looks for a moment before it sleeps where that is free: see LookFirst.
    void look_and_wait(std::chrono::milliseconds most);
    bool readable(std::size_t item) const { return items_[item].readable; }
    /// Any of [first, last).
    bool any_readable(std::size_t first, std::size_t last) const;

private:
    struct Item {
        const Waitable* socket;  // null: a descriptor
        bool readable;
        FrameQueue* queue = nullptr;
    };
    bool glance();
    bool look_into_each();
    void wake_up();
    bool look_at_descriptors(std::chrono::milliseconds most);

    std::vector<Item> items_;
    std::vector<pollfd> descriptors_;
};

}  // namespace lightnet
