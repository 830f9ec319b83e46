// The connection between the launcher and one host, whoever opened it.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "transport/zmq/sockets.hpp"

namespace lightnet {

/// Carries messages (frames without a route) to one host and back. One thread's.
class HostLine {
public:
    virtual ~HostLine() = default;
    /// `files`: may wait behind other files, and must not make anything else wait. False: can't be sent now.
    virtual bool send(Frames& frames, bool files) = 0;
    /// One message, if there is one. An empty one says that what was under way may be lost.
    virtual std::optional<Frames> receive() = 0;
    /// Nothing that was meant for the host before may reach it from now on.
    virtual void renew() = 0;
    /// Sockets of its own, for polling.
    virtual std::vector<zmq::socket_t*> sockets() = 0;
};

/// The launcher calls the host at its endpoint.
class CalledLine final : public HostLine {
public:
    CalledLine(zmq::context_t& context, std::string endpoint);
    ~CalledLine() override;
    bool send(Frames& frames, bool files) override;
    std::optional<Frames> receive() override;
    void renew() override;
    std::vector<zmq::socket_t*> sockets() override;

private:
    // Doors greet each connection with an empty message: the first is expected, others tell of a cut.
    struct Lane {
        std::unique_ptr<zmq::socket_t> socket{};  // null: the system had none to give; tried again when it is needed
        bool greeted = false;
        std::optional<Frames> receive();
    };
    bool open(Lane& lane);
    zmq::context_t& context_;
    std::string endpoint_;
    Lane work_, files_;
};

/// The host has dialled in at the launcher's port, and everything goes over that one connection.
class JoinedLine final : public HostLine {
public:
    /// `door` is the launcher's socket and must outlive the line; `route` leads to the host.
    JoinedLine(zmq::socket_t& door, std::string route);
    ~JoinedLine() override;
    bool send(Frames& frames, bool files) override;
    std::optional<Frames> receive() override;
    void renew() override;
    std::vector<zmq::socket_t*> sockets() override { return {}; }

    const std::string& route() const { return route_; }
    /// The host has dialled in anew.
    void use(std::string route);
    /// What came from the host, without the route.
    void arrived(Frames frames);

private:
    zmq::socket_t& door_;
    std::string route_;
    std::deque<Frames> arrived_;
};

}  // namespace lightnet
