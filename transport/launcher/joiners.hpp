// The launcher's open port: where hosts dial in, and where anyone may ask how the run is.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "transport/launcher/host_connection.hpp"
#include "transport/wire/pass.hpp"
#include "transport/zmq/doorkeeper.hpp"

namespace lightnet {

struct HostState;

/// Lets in hosts that prove that they know the pass of the run's user; a stranger learns nothing but that there is a
/// launcher, and how its hosts are. Knows hosts by the name that they give, made unique, and tells a host that dials in
/// anew from another one. One thread's.
class Joiners {
public:
    struct Handlers {
        std::function<void(const std::string& endpoint)> call;  // a host that wants to be called
        std::function<void(const std::string& name, std::unique_ptr<JoinedConnection>)> add;
        std::function<void(const std::string& name, const std::string& why)> lost;  // what was under way to it
        std::function<std::vector<HostState>()> hosts;                              // for those who ask
        std::function<void(const std::string& name, const std::string& address)> turned_down;
    };
    /// Lets in who proves that he knows `pass`.
    Joiners(const SocketContext& context, const std::string& endpoint, Pass pass);

    std::string endpoint() const { return socket_.endpoint(); }
    void watch(Poll& poll) const;
    /// Takes in what there is, and gives it to the connections. Returns how many packets were damaged.
    std::uint64_t receive(const Handlers& handlers);

private:
    using Time = std::chrono::steady_clock::time_point;
    struct Joined {
        std::uint64_t process = 0;
        JoinedConnection* connection = nullptr;
        Time heard{};
    };
    bool control(Frames& frames, const Handlers& handlers);
    void join(const std::string& route, const packet::Fields& fields, const Handlers& handlers);
    bool is_expected(const packet::Fields& fields) const;
    std::optional<std::string> name_for(std::string wanted, std::uint64_t process);
    void tell_state(const std::string& route, const std::vector<HostState>& hosts);
    void send(const std::string& route, packet::Type type, const packet::Fields& fields);

    Doorkeeper keeper_;
    Socket socket_;
    Pass pass_;
    std::string challenge_ = random_challenge();
    std::map<std::string, Joined> joined_;         // by name
    std::map<std::string, std::string> by_route_;  // names
    std::map<std::uint64_t, Time> rivals_;         // processes that want a name that is taken, since when
};

}  // namespace lightnet
