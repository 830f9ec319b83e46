// The connection between the launcher and one host, whoever opened it.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "transport/lines/host_transport.hpp"

namespace lightnet {

/// Carries messages (frames without a route) to one host and back. One thread's.
class HostConnection {
public:
    virtual ~HostConnection() = default;
    /// `files`: may wait behind other files, and must not make anything else wait. False: can't be sent now.
    virtual bool send(Frames& frames, bool files) = 0;
    /// One message, if there is one. An empty one says that what was under way may be lost.
    virtual std::optional<Frames> receive() = 0;
    /// Nothing that was meant for the host before may reach it from now on.
    virtual void renew() = 0;
    /// From now on it is called at another port; else as renew().
    virtual void call_at(std::uint16_t) {}
    /// A second line to the same host is opened, beside the first.
    virtual void open_next() {}
    /// Sends this on it, as soon as it is there: false before. From then on it is the line; what is under way on the
    /// old one still arrives, for a while.
    virtual bool send_on_next(Frames&) { return false; }
    /// The old one is still looked at. `now`: of the steady clock.
    virtual bool has_old(std::chrono::steady_clock::time_point) { return false; }
    /// What became of its handshakes, the last one since the last call; none: there was none.
    virtual std::optional<Handshake> look_at_handshake() { return std::nullopt; }
    /// Whom it expects at the other end, and who we are there; none: neither has a key.
    virtual std::optional<LineKeys> keys() const { return std::nullopt; }
    /// Calls anew where it is time to. To be called several times a second.
    virtual void tick(std::chrono::steady_clock::time_point) {}
    /// Why the host can't even be called, as far as that is known; "": nothing is known.
    virtual std::string trouble() const { return {}; }
    /// Where the host answers, in numbers; "": it doesn't, or isn't called.
    virtual std::string answering_at() const { return {}; }
    /// Adds the sockets of its own.
    virtual void watch(Poll& poll) const = 0;
};

/// The launcher calls the host at its endpoint. Of several addresses, all lines go to the one that answers first.
class CalledConnection final : public HostConnection {
public:
    /// Throws LineError.
    CalledConnection(HostTransport& transport, std::string endpoint, std::optional<LineKeys> keys);
    bool send(Frames& frames, bool files) override;
    std::optional<Frames> receive() override;
    void renew() override;
    void call_at(std::uint16_t port) override;
    void watch(Poll& poll) const override;
    std::optional<Handshake> look_at_handshake() override;
    void open_next() override;
    bool send_on_next(Frames& frames) override;
    bool has_old(std::chrono::steady_clock::time_point now) override;
    std::optional<LineKeys> keys() const override { return keys_; }
    void tick(std::chrono::steady_clock::time_point now) override;
    std::string answering_at() const override { return work_.line ? work_.line->answering_at() : std::string(); }
    std::string trouble() const override { return work_.line ? work_.line->trouble() : std::string(); }

private:
    // Doors greet each connection with an empty message: the first is expected, others tell of a cut.
    struct Lane {
        std::unique_ptr<HostLine> line{};  // none: the system had none to give; tried again when it is needed
        bool greeted = false;
        std::optional<Frames> receive();
    };
    bool open(Lane& lane);
    std::string endpoint_of(const Lane& lane) const;
    HostTransport& transport_;
    std::string endpoint_;
    std::optional<LineKeys> keys_;
    Lane work_, files_, next_, old_;
    std::chrono::steady_clock::time_point old_since_{};
};

/// The host has dialled in at the launcher's port, and everything goes over that one connection.
class JoinedConnection final : public HostConnection {
public:
    /// `door` is the launcher's port and must outlive it; `route` leads to the host.
    JoinedConnection(HostPort& door, std::string route) : door_(door), route_(std::move(route)) {}
    bool send(Frames& frames, bool files) override;
    std::optional<Frames> receive() override;
    void renew() override;
    void watch(Poll&) const override {}

    const std::string& route() const { return route_; }
    /// The host has dialled in anew.
    void use(std::string route);
    /// What came from the host, without the route.
    void arrived(Frames frames);

private:
    HostPort& door_;
    std::string route_;
    std::deque<Frames> arrived_;
};

}  // namespace lightnet
