// Credit: the bound on what is under way to one place (flow control).
#pragma once

#include <cstddef>

namespace lightnet {

/// What an asker may have under way to one place, for one node; to a host, as many times that as it has places for the
/// node. It keeps room for as much of replies, and gets credit back with each reply. So a place holds at most (askers
/// × nodes asked × this, and one bundle each beyond it), where the places of other hosts are one asker, their
/// dispatcher; a dispatcher holds at most (askers × nodes asked × places × this), and an asker (nodes asked × places ×
/// this), whatever the network does; ZeroMQ's queues are never the limit.
struct Credit {
    std::size_t bundles = 0, questions = 0;    // how many a place is given: Tuning
    std::size_t bytes = std::size_t{8} << 20;  // of questions and of the room for their answers
    friend bool operator==(const Credit&, const Credit&) = default;
};

}  // namespace lightnet
