// The way out of a process: where its places hand in what is for other hosts, and get the replies.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "transport/zmq/sockets.hpp"

namespace lightnet {

/// Where the places of a run find the way out of their process.
std::string way_out_endpoint(std::uint64_t run);

/// Open for one run. One thread's.
class WayOut {
public:
    WayOut(zmq::context_t& context, std::uint64_t run);
    /// Free for the next at once.
    ~WayOut();
    WayOut(const WayOut&) = delete;
    WayOut& operator=(const WayOut&) = delete;

    /// [place][host][header][body]
    std::optional<Frames> receive();
    /// A reply; false: there is no such place.
    bool pass(const std::string& place, Frames& frames);
    /// Tells all places that what was under way to a host may be lost; "": to any.
    void say_again(const std::string& host);
    zmq::socket_t& socket() { return *socket_; }

private:
    std::string endpoint_;
    std::unique_ptr<zmq::socket_t> socket_;
    std::set<std::string> places_;  // that have asked
};

}  // namespace lightnet
