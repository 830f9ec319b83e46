#include "core/run/master/lock_server.hpp"

#include <algorithm>

namespace lightnet {

void LockServer::hear(const PlaceAt& place, const LockMessage& word) {
    if (word.kind == LockMessage::Kind::want) {
        auto& queue = queues_[word.lock];
        queue.push_back(place);
        if (queue.size() == 1) granted_.emplace_back(place, word.lock);
    } else if (word.kind == LockMessage::Kind::hold) {
        // Somebody else may have been given it while this place was out of sight; nothing can be done about that now.
        auto& queue = queues_[word.lock];
        if (queue.empty()) queue.push_back(place);
    } else if (const auto found = queues_.find(word.lock); found != queues_.end() && found->second.front() == place) {
        release(word.lock);
    }
}

void LockServer::release(const Hash& lock) {
    auto& queue = queues_[lock];
    queue.pop_front();
    if (queue.empty())
        queues_.erase(lock);
    else
        granted_.emplace_back(queue.front(), lock);
}

void LockServer::lose(const PlaceAt& place) {
    std::erase_if(granted_, [&](const auto& grant) { return grant.first == place; });
    std::vector<Hash> held;
    for (auto& [lock, queue] : queues_) {
        const bool holds = queue.front() == place;
        queue.erase(std::remove_if(queue.begin() + 1, queue.end(), [&](const auto& who) { return who == place; }),
                    queue.end());
        if (holds) held.push_back(lock);
    }
    for (const auto& lock : held) release(lock);
}

std::vector<std::pair<PlaceAt, Hash>> LockServer::granted() { return std::exchange(granted_, {}); }

}  // namespace lightnet
