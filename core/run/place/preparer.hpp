// The preparing nodes of one place, led by the launcher step by step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/run/assembly/assembly.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/message/message.hpp"

namespace lightnet {

/// Runs each node's prepare() in a fiber of its own, which waits wherever the node calls a service, until the launcher
/// brings the result. Belongs to a place, and to its thread.
class Preparer {
public:
    /// What its place does for it.
    struct PlaceHooks {
        std::string name;
        std::function<void(Fibers::Fiber*)> resume;  // as soon as the place gets to it
        std::function<void(Message)> reply;
        std::function<void()> look;                          // throws Cancelled when the place is to stop; any thread
        std::function<bool(std::size_t node)> owes_answers;  // what was asked of it before waits, or is at work
    };
    Preparer(const Network& network, Assembly& assembly, Fibers& fibers, PlaceHooks place);
    ~Preparer();

    /// A step of any kind but shards. A node that is to leave does so when it has answered what it was asked before,
    /// and what is to be done with it afterwards waits for that.
    void take(Message ask);
    /// Begins one prepare() that has been asked for, or lets go of a node. Outside fibers only. False: there is none.
    bool start_next();
    /// Does shards, in a fiber of the node: the first, and as many more of them as take little time and room; whoever
    /// asked hands out the others again. Throws Error when the node does not wait for them.
    Bytes shards(std::size_t node, const Step& step);
    /// Has the node left the place, and not come back? It can't be asked, then.
    bool has_left(std::size_t node) const { return left_.contains(node); }
    /// What all its nodes have been given so far.
    std::uint64_t result_bytes() const;
    /// Of one node, so far.
    struct Spent {
        std::uint64_t shards = 0;  // that its calls have, for all copies together
        std::uint64_t rounds = 0;  // calls for which all copies waited for each other
        std::uint64_t ns = 0;      // running in prepare(), beside the shards
        std::uint64_t bytes = 0;   // of results that it was given
    };
    /// By node.
    const std::map<std::size_t, Spent>& spent() const { return spent_; }

private:
    class Node;

    const Network& network_;
    Assembly& assembly_;
    Fibers& fibers_;
    PlaceHooks place_;
    std::map<std::size_t, std::shared_ptr<Node>> nodes_;  // as they prepare for the latest pass
    std::deque<std::shared_ptr<Node>> to_start_;
    void leave(Message ask);
    bool let_go();

    std::set<std::size_t> left_;     // nodes
    std::deque<Message> to_let_go_;  // the steps that say so, each with those behind it for its node
    std::map<std::size_t, Spent> spent_;
};

}  // namespace lightnet
