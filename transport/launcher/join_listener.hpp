// The launcher's open port: where hosts dial in, and where anyone may ask how the run is.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "transport/launcher/cluster.hpp"
#include "transport/launcher/host_connection.hpp"
#include "transport/lines/host_transport.hpp"
#include "transport/wire/pass.hpp"
#include "transport/wire/rights.hpp"

namespace lightnet {

/// Lets in hosts that prove that they know the pass of the run's user; a stranger learns nothing but that there is a
/// launcher, and how its hosts are. Knows hosts by the name that they give, made unique, and tells a host that dials in
/// anew from another one. One thread's.
class JoinListener {
public:
    struct Handlers {
        using HostKey = std::optional<PublicKey>;
        std::function<void(const std::string& endpoint, const HostKey&)> call;  // a host that wants to be called
        std::function<void(const std::string& name, std::unique_ptr<JoinedConnection>, const HostKey&)> add;
        std::function<void(const std::string& name, const std::string& why)> lost;  // what was under way to it
        std::function<std::vector<HostState>()> hosts;                              // for those who ask
        std::function<void(const std::string& name, const std::string& address)> turned_down;
    };
    /// Lets in who proves that he knows `pass`.
    JoinListener(HostTransport& transport, const std::string& endpoint, Pass pass);
    /// By keys.
    struct Door {
        KeyPair own;
        JoinKeys keys;
        std::function<void(const std::string&)> say;  // who was turned away, and changes of the list
    };
    /// Lets in whose key is on the list, and takes his name from there; and who has our own key, who may ask how the
    /// run is.
    JoinListener(HostTransport& transport, const std::string& endpoint, Door door);

    std::string endpoint() const { return port_->endpoint(); }
    void watch(Poll& poll) const {
        port_->watch_callers(poll);
        port_->watch(poll);
    }
    /// Takes in what there is, and gives it to the connections. Returns how many packets were damaged.
    std::uint64_t receive(const Handlers& handlers);

private:
    using Time = std::chrono::steady_clock::time_point;
    struct Joined {
        std::uint64_t process = 0;
        std::optional<PublicKey> key{};
        JoinedConnection* connection = nullptr;
        Time heard{};
    };
    // Who sends a message, by his key. Everybody who knows the pass is a host without one.
    struct Sender {
        std::optional<PublicKey> key{};
        std::string listed{};  // name
        Party party = Party::host;
    };
    JoinListener(HostTransport& transport, const std::string& endpoint, std::optional<Pass> pass,
                 std::optional<Door> door);
    std::optional<DoorKeys> keys_of_door();
    std::optional<std::string> listed_name(const PublicKey& key) const;
    Sender who_says_it() const;
    bool may_say(const Sender& sender, const Frames& frames) const;
    void look_at_list(const Handlers& handlers);
    bool control(Frames& frames, const Sender& sender, const Handlers& handlers);
    bool take_join(const std::string& route, const packet::Fields& fields, const std::string& address,
                   const Sender& sender, const Handlers& handlers);
    void challenge(const std::string& route, const packet::Fields& fields, const std::string& address,
                   const Handlers& handlers);
    void join(const std::string& route, const packet::Fields& fields, const Sender& sender, const Handlers& handlers);
    bool is_expected(const packet::Fields& fields) const;
    std::optional<std::string> name_for(std::string wanted, std::uint64_t process);
    void tell_state(const std::string& route, const std::vector<HostState>& hosts, bool all);
    void send(const std::string& route, packet::Type type, const packet::Fields& fields);

    std::optional<Pass> pass_;
    std::optional<Door> door_;
    std::set<PublicKey> told_;  // that they were turned away
    std::unique_ptr<HostPort> port_;
    std::string challenge_ = random_challenge();
    std::map<std::string, Joined> joined_;         // by name
    std::map<std::string, std::string> by_route_;  // names
    std::map<std::uint64_t, Time> rivals_;         // processes that want a name that is taken, since when
};

}  // namespace lightnet
