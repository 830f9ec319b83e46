#include "core/run/prepare/lock_desk.hpp"

#include <algorithm>

namespace lightnet {

void LockDesk::hear(const PlaceAt& place, const LockWord& word) {
    if (word.kind == LockWord::Kind::want) {
        auto& queue = queues_[word.lock];
        queue.push_back(place);
        if (queue.size() == 1) granted_.emplace_back(place, word.lock);
    } else if (word.kind == LockWord::Kind::hold) {
        // Somebody else may have been given it while this place was out of sight; nothing can be done about that now.
        auto& queue = queues_[word.lock];
        if (queue.empty()) queue.push_back(place);
    } else if (const auto found = queues_.find(word.lock); found != queues_.end() && found->second.front() == place) {
        release(word.lock);
    }
}

void LockDesk::release(const Hash& lock) {
    auto& queue = queues_[lock];
    queue.pop_front();
    if (queue.empty())
        queues_.erase(lock);
    else
        granted_.emplace_back(queue.front(), lock);
}

void LockDesk::lose(const PlaceAt& place) {
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

std::vector<std::pair<PlaceAt, Hash>> LockDesk::granted() { return std::exchange(granted_, {}); }

void PlaceLocks::take(Message ask) {
    const Step step = std::get<Questions<Step>>(ask.questions)->front();
    if (step.kind == Step::Kind::attend) {
        attended_ = std::move(ask);
        if (step.call) say_all();
        return speak();
    }
    auto& waiting = waiting_[step.data];
    if (waiting.empty()) {  // it was cancelled meanwhile
        say(LockWord::Kind::release, step.data);
    } else {
        resume_(waiting.front());
        waiting.pop_front();
        ++held_[step.data];
    }
    auto reply = reply_to(ask);
    reply.data = std::make_shared<const std::vector<std::byte>>();
    reply_(std::move(reply));
}

void PlaceLocks::wait_for(const std::string& name) {
    const Hash lock = content_hash(name);
    waiting_[lock].push_back(fibers_.current());
    say(LockWord::Kind::want, lock);
    fibers_.park();
}

void PlaceLocks::give_back(const std::string& name) noexcept {
    const Hash lock = content_hash(name);
    if (const auto held = held_.find(lock); held != held_.end() && --held->second == 0) held_.erase(held);
    say(LockWord::Kind::release, lock);
}

// The launcher knows nothing of this place, whatever has been said before.
void PlaceLocks::say_all() {
    words_.clear();
    for (const auto& [lock, times] : held_) words_.push_back({LockWord::Kind::hold, lock});
    for (const auto& [lock, fibers] : waiting_)
        words_.insert(words_.end(), fibers.size(), {LockWord::Kind::want, lock});
}

void PlaceLocks::say(LockWord::Kind kind, const Hash& lock) {
    words_.push_back({kind, lock});
    speak();
}

void PlaceLocks::speak() {
    if (!attended_ || words_.empty()) return;
    auto reply = reply_to(*attended_);
    reply.data = bytes_of(words_);
    words_.clear();
    attended_.reset();
    reply_(std::move(reply));
}

}  // namespace lightnet
