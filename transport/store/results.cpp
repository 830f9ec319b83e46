#include "transport/store/results.hpp"

#include <chrono>

#include "core/base/error.hpp"
#include "core/base/spare_threads.hpp"

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

void Results::keep(const Hash& name, Bytes bytes) {
    take(name, bytes);
    const std::lock_guard lock(mutex_);
    std::erase_if(writing_, [](auto& one) {
        return one.second.wait_for(std::chrono::seconds(0)) == std::future_status::ready && one.second.get();
    });
    const auto write = [this, name, bytes = bytes.get()] {
        try {
            cache_.store(name, *bytes);
            return true;
        } catch (const Error&) {
            return false;
        }
    };
    writing_.emplace_back(std::move(bytes), in_background(write));
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
