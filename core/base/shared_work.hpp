// Results that several share as long as any of them is in use, each worked out once.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace lightnet {

/// Scenes of one process that follow each other have much in common: what one still holds, the next takes. Any thread.
template <class Key, class Made>
class SharedWork {
public:
    /// What `make` gives for that key, or gave.
    template <class Make>
    std::shared_ptr<const Made> get(const Key& key, const Make& make) {
        {
            const std::lock_guard lock(mutex_);
            if (const auto known = known_.find(key); known != known_.end())
                if (auto made = known->second.lock()) return made;
        }
        std::shared_ptr<const Made> made = make();
        const std::lock_guard lock(mutex_);
        std::erase_if(known_, [](const auto& one) { return one.second.expired(); });
        known_[key] = made;
        return made;
    }

private:
    std::mutex mutex_;
    std::map<Key, std::weak_ptr<const Made>> known_;
};

}  // namespace lightnet
