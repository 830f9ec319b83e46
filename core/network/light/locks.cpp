#include "core/network/light/locks.hpp"

#include "core/base/error.hpp"

namespace lightnet {

Locks::Held Locks::hold(const std::string& name) {
    if (const auto found = held_.find(worker()); found != held_.end())
        throw Error("it waits for the lock '" + name + "' while it holds '" + found->second + "'");
    wait_for(name);
    held_[worker()] = name;
    return {*this, name};
}

void Locks::check_may_ask() const {
    if (const auto found = held_.find(worker()); found != held_.end())
        throw Error("it asks an input while it holds the lock '" + found->second + "'");
}

void Locks::release(const std::string& name) noexcept {
    held_.erase(worker());
    give_back(name);
}

}  // namespace lightnet
