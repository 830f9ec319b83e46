// The lines from one host to the others of a run.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/network/graph/plan.hpp"
#include "transport/zmq/sockets.hpp"

namespace lightnet {

/// One line to each host that is asked, shared by all places of this one. Looks at nothing but addresses. What is for a
/// host that can't be reached goes to the launcher instead, which passes it on. One thread's.
class HostLines {
public:
    using Time = std::chrono::steady_clock::time_point;
    struct Takers {
        std::function<void(const std::string& place, Frames& frames)> reply;  // [header][body], for a place of ours
        std::function<void(const std::string& host)> say_again;               // what was under way to it may be lost
        std::function<void(Frames& frames)> launcher;                         // [place][host][header][body]
    };
    /// `me`: this host, as in plans.
    HostLines(zmq::context_t& context, std::string me, Takers takers);
    ~HostLines();
    HostLines(const HostLines&) = delete;
    HostLines& operator=(const HostLines&) = delete;

    /// [place][host][header][body]
    void ask(Frames frames);
    /// Takes in what has come, and sends what has waited for its line.
    void tick(Time now);
    /// Lines to hosts that are no more are closed.
    void use(const Plan& plan);
    /// Should tick() be called though nothing has come?
    bool due(Time now) const;
    /// Something waits for its line.
    bool waiting() const;
    /// For polling.
    std::vector<zmq::socket_t*> sockets();

private:
    struct Line {
        std::unique_ptr<zmq::socket_t> socket;  // null: none could be had
        bool greeted = false;               // doors greet each connection with an empty message: the first is expected
        bool relayed = false;               // its host can't be reached from here
        std::optional<Time> unreachable{};  // since when
        std::deque<Frames> waiting{};       // as for ask()
    };
    Line& line_to(const std::string& host);
    bool send(Line& line, Frames& frames);
    void take(const std::string& host, Line& line, Frames& frames);
    void look_whether_reachable(const std::string& host, Line& line, Time now);

    zmq::context_t& context_;
    std::string me_;
    Takers takers_;
    std::map<std::string, Line> lines_;  // by host
    Time looked_{};
};

}  // namespace lightnet
