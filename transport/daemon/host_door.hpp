// The sockets of a host: its port, if it has one, and its connection to a launcher that it dialled.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/base/log_entry.hpp"
#include "transport/lines/host_transport.hpp"
#include "transport/lines/paced_line.hpp"
#include "transport/wire/packet.hpp"
#include "transport/wire/pass.hpp"

namespace lightnet {

/// Whatever way a message comes, its first frame is the route on which answers go back. One thread's.
class HostDoor {
public:
    using Time = std::chrono::steady_clock::time_point;
    struct Options {
        std::string listen;  // empty: nobody can call this host
        std::string join;    // of a launcher; empty: none is dialled
        std::string name;    // under which it joins
        std::uint64_t process = 0;
        std::optional<Pass> pass{};          // by which it proves that it belongs there; to be had when it joins
        std::optional<DoorKeys> keys{};      // of its port; none: who comes in is asked for none
        std::optional<LineKeys> launcher{};  // to the launcher that it dials; none: without
        std::chrono::milliseconds line_life = usual_line_life;  // of one with keys
        std::function<void(const LogEntry&)> log = [](const LogEntry&) {};
    };
    /// Throws Error when the port can't be had.
    HostDoor(HostTransport& transport, Options options);

    /// Where it listens, with the port that the system chose; empty: nowhere.
    std::string endpoint() const;
    /// The key, as text, of whom the last message came from; empty: it came without.
    const std::string& key() const { return key_; }
    /// What arrived, if anything.
    std::optional<Frames> receive(Time now);
    void send(const std::string& route, packet::Type type, std::uint64_t run, const packet::Fields& fields);
    /// Route first. What its line has no room for waits; false: nobody is there.
    bool send(Frames& frames);
    /// Sends what waits, as far as there is room.
    void go_on(Time now);
    /// Something waits for room on its line.
    bool waiting() const;
    /// What waits for anybody is of a run that is over.
    void drop_waiting();
    /// Reports to the launcher that was dialled, until it answers and from time to time; dials anew when it is silent.
    void keep_in_touch(Time now);
    /// Lets in who waits, as long as there is room for connections. To be called before receive().
    void let_in();
    /// Messages may be taken by another thread than those who call are looked after by, see Leadership.
    enum class Watched { messages, callers, all };
    void watch(Poll& poll, Watched what) const;

    /// How many messages came and went on the connection to the launcher of the run; see packet::is_counted().
    struct Tally {
        std::uint64_t line = 0;  // another number: another connection, counted from nothing
        std::uint64_t taken = 0, told = 0;
        Time heard{};  // last
    };
    /// From now on this is that connection; `run` is known to those who take part in it.
    void count(const std::string& route, std::uint64_t run);
    const Tally& tally();

private:
    // To whoever has a route to here, and when it was last used.
    struct Line {
        PacedLine line;
        std::uint64_t told_before = 0;  // messages, before they were counted
        Time used{};
    };
    void dial(Time now);
    void take_challenge(const Frames& frames);
    void look_at_handshake();
    void tell_silence();
    std::optional<Frames> from_launcher(Time now);
    std::optional<Frames> from_anyone(Time now);
    std::optional<Frames> take(Frames frames, Time now);
    bool may_come_in_parts(const Frames& frames, const std::string& route) const;
    Line& line_to(const std::string& route, Time now);
    void begin_anew(const std::string& route);
    bool send_at_once(const std::string& route, Frames& frames);

    HostTransport& transport_;
    Options options_;
    std::unique_ptr<HostPort> port_;      // null: nobody can call
    std::unique_ptr<HostLine> launcher_;  // null: none is dialled, or no line could be had
    // Of that launcher.
    struct Known {
        int abandoned = 0;                       // handshakes, in a row
        bool made = false;                       // one, some time
        bool told = false, turned_down = false;  // that it does not let us in
        std::string silence;                     // why it is silent, as was last said
    };
    Known known_;
    std::string challenge_;  // of the launcher that was dialled
    Time heard_{}, dialled_{}, next_join_{};
    std::chrono::milliseconds silence_;  // after which it dials anew
    std::string key_;
    std::map<std::string, Line> lines_;  // by route
    bool gone_ = false;                  // it was, when something was last sent to somebody
    std::uint64_t run_ = 0;
    std::string counted_;  // route
    Tally tally_;
};

}  // namespace lightnet
