#include "core/run/place/place_locks.hpp"

namespace lightnet {

void PlaceLocks::take(Message ask) {
    const Step step = std::get<Questions<Step>>(ask.questions)->front();
    if (step.kind == Step::Kind::attend) {
        attended_ = std::move(ask);
        if (step.call) say_all();
        return speak();
    }
    auto& waiting = waiting_[step.data];
    if (waiting.empty()) {  // it was cancelled meanwhile
        say(LockMessage::Kind::release, step.data);
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
    say(LockMessage::Kind::want, lock);
    fibers_.park();
}

void PlaceLocks::give_back(const std::string& name) noexcept {
    const Hash lock = content_hash(name);
    if (const auto held = held_.find(lock); held != held_.end() && --held->second == 0) held_.erase(held);
    say(LockMessage::Kind::release, lock);
}

// The launcher knows nothing of this place, whatever has been said before.
void PlaceLocks::say_all() {
    words_.clear();
    for (const auto& [lock, times] : held_) words_.push_back({LockMessage::Kind::hold, lock});
    for (const auto& [lock, fibers] : waiting_)
        words_.insert(words_.end(), fibers.size(), {LockMessage::Kind::want, lock});
}

void PlaceLocks::say(LockMessage::Kind kind, const Hash& lock) {
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
