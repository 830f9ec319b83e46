// One end of a line between two processes that never has more to carry than it can.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "transport/lines/message_frame.hpp"
#include "transport/wire/line_pace.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet {

/// Sends messages in their order, large ones in parts, as fast as the line takes them (see LinePace), and puts together
/// what comes in parts. Heartbeats and the like pass what waits. Messages are frames without a route. One thread's.
class PacedLine {
public:
    using Time = LinePace::Time;
    /// Hands frames to a socket. False: it refuses, and they are as they were.
    using Send = std::function<bool(Frames&)>;

    /// Sends it, or keeps it until its turn comes. False: the socket refuses, and it is as it was.
    bool send(Frames& frames, Time now, const Send& socket);
    /// Keeps it until its turn comes, whatever the socket does.
    void put(Frames frames);
    /// Sends of what waits as much as there is room for.
    void go_on(Time now, const Send& socket);
    /// What has come: the message, if it is one or completes one.
    std::optional<Frames> take(Frames frames, Time now, const Send& socket);

    bool waiting() const { return !waiting_.empty(); }
    /// There was room on the line, but the socket would not.
    bool refused() const { return refused_; }
    /// Messages sent as a whole that both ends count, see packet::is_counted().
    std::uint64_t counted() const { return counted_; }
    /// Bytes of a message that has come in part.
    std::size_t incomplete() const { return arriving_.size(); }
    void forget_incomplete() { arriving_ = {}; }
    /// How many bytes may be under way: the more, the faster the line was seen to be.
    std::size_t window() const { return pace_.window(); }
    /// How long what is under way may still take, as far as is known.
    std::chrono::milliseconds expected() const { return pace_.expected(); }
    /// Another connection: what is half sent is sent from its beginning.
    void restart();
    /// What waits is not to be sent any more.
    void drop_waiting() { waiting_.clear(); }

private:
    struct Waiting {
        Frames frames;
        std::uint32_t size = 0;  // as bytes
        std::uint32_t offset = 0;
    };
    bool send_whole(Frames& frames, Time now, const Send& socket);
    bool send_part(Waiting& message, std::size_t size, Time now, const Send& socket);
    bool waits_already(const Frames& ask) const;
    void ask_how_far(Time now, bool blocked, const Send& socket);
    std::optional<Frames> add(const packet::Header& header, std::span<const std::byte> body);

    LinePace pace_;
    std::deque<Waiting> waiting_;
    std::vector<std::byte> arriving_;
    std::uint64_t counted_ = 0;
    bool refused_ = false;
    bool unpaced_ = false;  // by the other end's wish
};

}  // namespace lightnet
