// How much may be under way to one place: flow control by credit.
#pragma once

#include <cstddef>

namespace lightnet {

/// What an asker may have under way to one place, for one node. It keeps room for as much of replies, and gets credit
/// back with each reply. So a place holds at most (askers × nodes asked × this, and one bundle each beyond it), and an
/// asker at most (nodes asked × replicas × the same), whatever the network does; ZeroMQ's queues are never the limit.
struct Credit {
    std::size_t bundles = 8;
    std::size_t questions = 8192;
    std::size_t bytes = std::size_t{8} << 20;  // of questions and of the room for their answers
    friend bool operator==(const Credit&, const Credit&) = default;
};

}  // namespace lightnet
