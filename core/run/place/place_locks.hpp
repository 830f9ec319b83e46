// Named locks, as the nodes of a place take them.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/network/light/locks.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/message/lock_message.hpp"
#include "core/run/message/message.hpp"

namespace lightnet {

/// The master keeps one step there, `attend`, which is answered when there is something to
/// say. Belongs to the place's thread.
class PlaceLocks final : public Locks {
public:
    PlaceLocks(Fibers& fibers, std::function<void(Fibers::Fiber*)> resume, std::function<void(Message)> reply)
        : fibers_(fibers), resume_(std::move(resume)), reply_(std::move(reply)) {}

    /// A step `attend` or `grant`.
    void take(Message ask);

protected:
    const void* worker() const override { return fibers_.current(); }
    void wait_for(const std::string& name) override;
    void give_back(const std::string& name) noexcept override;

private:
    void say(LockMessage::Kind kind, const Hash& lock);
    void say_all();
    void speak();

    Fibers& fibers_;
    std::function<void(Fibers::Fiber*)> resume_;
    std::function<void(Message)> reply_;
    std::map<Hash, std::deque<Fibers::Fiber*>> waiting_;
    std::map<Hash, std::size_t> held_;  // how often: twice when a grant came twice
    std::vector<LockMessage> words_;
    std::optional<Message> attended_;
};

}  // namespace lightnet
