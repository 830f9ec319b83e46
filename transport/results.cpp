#include "transport/results.hpp"

namespace lightnet {

void Results::take(const Hash& name, Bytes bytes) {
    const std::lock_guard lock(mutex_);
    all_[name] = bytes;
    latest_bytes_ += bytes->size();
    latest_.push_back(std::move(bytes));
    while (latest_bytes_ > most_bytes_ && latest_.size() > 1) {
        latest_bytes_ -= latest_.front()->size();
        latest_.pop_front();
    }
}

bool Results::in_memory(const Hash& name) const {
    const std::lock_guard lock(mutex_);
    const auto found = all_.find(name);
    return found != all_.end() && !found->second.expired();
}

Bytes Results::find(const Hash& name) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = all_.find(name);
        if (found == all_.end()) return nullptr;
        if (auto bytes = found->second.lock()) return bytes;
    }
    auto bytes = cache_.read(name);
    if (bytes) take(name, bytes);
    return bytes;
}

}  // namespace lightnet
