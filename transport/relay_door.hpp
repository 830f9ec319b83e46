// Where the places of one process hand in what is for hosts that they can't call.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "transport/sockets.hpp"

namespace lightnet {

/// Open for one run. One thread's.
class RelayDoor {
public:
    RelayDoor(zmq::context_t& context, std::uint64_t run);
    /// Free for the next at once.
    ~RelayDoor();
    RelayDoor(const RelayDoor&) = delete;
    RelayDoor& operator=(const RelayDoor&) = delete;

    /// [place][host][header][body]
    std::optional<Frames> receive();
    /// A reply; false: there is no such place.
    bool pass(const std::string& place, Frames& frames);
    /// Tells all places that what was under way may be lost.
    void say_again();
    zmq::socket_t& socket() { return *socket_; }

private:
    std::string endpoint_;
    std::unique_ptr<zmq::socket_t> socket_;
    std::set<std::string> places_;  // that have asked
};

}  // namespace lightnet
