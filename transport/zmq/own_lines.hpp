// The lines that a place has to other hosts by itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "transport/lines/line_book.hpp"
#include "transport/lines/message_frame.hpp"
#include "transport/lines/paced_line.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {

/// A socket that is looked into until it is dry, as looking into an empty one costs a call of the system.
struct Source {
    Socket socket;
    bool dry = false;

    /// The next message, if there is one.
    std::optional<Frames> receive() {
        auto frames = dry ? std::nullopt : socket.receive();
        dry = !frames;
        return frames;
    }
};

/// One line to each host of the LineBook. A packet over one of them goes from thread to thread six times there and
/// back where the other place idles (see Leadership), and ten times by way of the hosts. One is used as soon as the
/// host has greeted it, for as many bytes as the book has room for: then nothing need wait its turn, nor be marked,
/// which a place that computes could not answer in time. One thread's.
class OwnLines {
public:
    /// `book` null: there are none.
    OwnLines(const SocketContext& context, std::shared_ptr<const LineBook> book);

    /// Sends a packet of `bytes`, header and body. False: it has to go another way.
    bool send(const std::string& host, Frames& packet, std::size_t bytes);
    /// What was sent so is under way no more.
    void settled(const std::string& host, std::size_t bytes);
    /// What came from whom: a packet.
    std::optional<std::pair<std::string, Frames>> receive();
    /// Looks whether the book has changed. `waits_for`: is something of this host under way?
    void look_into_book(const std::function<bool(const std::string& host)>& waits_for);
    /// Hosts whose lines are others than before, since the last call: what was under way may be lost.
    std::vector<std::string> cut() { return std::exchange(cut_, {}); }
    /// To be waited at.
    std::vector<Source*> sources();

private:
    struct Line {
        Source source;
        LineBook::Entry entry;
        PacedLine paced{};  // puts together what comes in parts, until the host knows that it need not
        bool greeted = false, wanted = true;
        std::size_t under_way = 0;  // bytes
    };
    void use(const std::string& host, const LineBook::Entry& entry);
    std::optional<Frames> take(const std::string& host, Line& line, Frames frames);
    void greeted(const std::string& host, Line& line);

    const SocketContext& context_;
    std::shared_ptr<const LineBook> book_;
    std::uint64_t edition_ = 0;  // of it, that was read last
    std::map<std::string, Line> lines_;
    std::vector<std::string> cut_;
};

}  // namespace lightnet
