// Messages on their way from one thread of this process to another.
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

#include "transport/lines/high_water.hpp"
#include "transport/lines/message_frame.hpp"
#include "transport/places/wakeup.hpp"

namespace lightnet {

/// Any thread pushes, one takes. A push costs a call of the system only where the one who takes is asleep; a socket
/// within the process looks at its descriptor before and after each message.
/// DECISIONS: queues-in-memory
class FrameQueue {
public:
    /// False, and the frames are as they were: nobody takes any more, or so many wait that whoever sends them keeps no
    /// rule.
    bool push(Frames& frames) { return put(frames, std::size_t{high_water_mark}); }
    /// However many wait. False: nobody takes any more.
    bool push_always(Frames& frames) { return put(frames, ~std::size_t{0}); }
    /// The oldest; none: there is nothing.
    std::optional<Frames> pop();
    bool empty() const;
    /// From now on a push makes handle() readable. False: there is something already, and nothing to wait for. For the
    /// thread that takes, as all that follows.
    bool fall_asleep();
    void wake_up();
    int handle() const { return wakeup_.handle(); }
    /// Nobody takes any more: what is there is dropped.
    void close();

private:
    bool put(Frames& frames, std::size_t most);

    mutable std::mutex mutex_;
    std::deque<Frames> frames_;
    bool asleep_ = false, woken_ = false, closed_ = false;
    Wakeup wakeup_;
};

}  // namespace lightnet
