// A name service that knows what a test tells it.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "transport/address/name_service.hpp"

namespace lightnet::test {

/// Any thread. Whoever waits for a silent name is let go at the end.
class FakeNames final : public NameService {
public:
    ~FakeNames() override { end(); }

    void put(const std::string& name, const std::vector<std::string>& addresses) {
        const std::lock_guard lock(mutex_);
        auto& known = names_[name] = {Whereabout::State::found, {}, {}};
        for (const auto& one : addresses) known.addresses.push_back(ip_address(one).value());
    }
    /// Nobody says anything of it.
    void silence(const std::string& name) {
        const std::lock_guard lock(mutex_);
        names_[name] = {Whereabout::State::asked, {}, {}};
    }
    void remove(const std::string& name) {
        const std::lock_guard lock(mutex_);
        names_.erase(name);
    }
    void end() const {
        const std::lock_guard lock(mutex_);
        ended_ = true;
        changed_.notify_all();
    }
    int asked(const std::string& name) const {
        const std::lock_guard lock(mutex_);
        return asked_[name];
    }

    Whereabout look_up(const std::string& name) const override {
        std::unique_lock lock(mutex_);
        ++asked_[name];
        const auto found = names_.find(name);
        if (found == names_.end()) return {Whereabout::State::gone, {}, "no host is called '" + name + "'"};
        if (found->second.state != Whereabout::State::asked) return found->second;
        changed_.wait(lock, [this] { return ended_; });
        return {Whereabout::State::unknown, {}, "nobody says where '" + name + "' is"};
    }

private:
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::map<std::string, Whereabout> names_;
    mutable std::map<std::string, int> asked_;
    mutable bool ended_ = false;
};

}  // namespace lightnet::test
