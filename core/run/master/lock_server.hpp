// Named locks, and which places hold them or wait for them.
#pragma once

#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "core/network/graph/plan.hpp"
#include "core/run/message/lock_message.hpp"

namespace lightnet {

/// Gives each lock to one place at a time, in the order in which they came.
class LockServer {
public:
    void hear(const PlaceAt& place, const LockMessage& word);
    /// The place is gone: what it held is free.
    void lose(const PlaceAt& place);
    /// Locks that have been granted since the last call.
    std::vector<std::pair<PlaceAt, Hash>> granted();

private:
    void release(const Hash& lock);
    std::map<Hash, std::deque<PlaceAt>> queues_;  // the first holds it
    std::vector<std::pair<PlaceAt, Hash>> granted_;
};

}  // namespace lightnet
