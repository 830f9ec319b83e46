// Who holds which named lock: the launcher's side, and a place's.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/hash.hpp"
#include "core/network/graph/plan.hpp"
#include "core/network/light/locks.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/message/message.hpp"

namespace lightnet {

/// What a place has to say about a lock, which is named by the hash of its name. Travels as bytes.
struct LockWord {
    enum class Kind : std::uint32_t {
        want,
        release,
        hold,  // said to a launcher that had lost sight of the place
        last = hold
    };
    Kind kind = Kind::want;
    Hash lock{};
    friend bool operator==(const LockWord&, const LockWord&) = default;
};

/// Gives each lock to one place at a time, in the order in which they came.
class LockDesk {
public:
    void hear(const PlaceAt& place, const LockWord& word);
    /// The place is gone: what it held is free.
    void lose(const PlaceAt& place);
    /// Locks that have been granted since the last call.
    std::vector<std::pair<PlaceAt, Hash>> granted();

private:
    void release(const Hash& lock);
    std::map<Hash, std::deque<PlaceAt>> queues_;  // the first holds it
    std::vector<std::pair<PlaceAt, Hash>> granted_;
};

/// The locks of one place. The launcher keeps one step there, `attend`, which is answered when there is something to
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
    void say(LockWord::Kind kind, const Hash& lock);
    void say_all();
    void speak();

    Fibers& fibers_;
    std::function<void(Fibers::Fiber*)> resume_;
    std::function<void(Message)> reply_;
    std::map<Hash, std::deque<Fibers::Fiber*>> waiting_;
    std::map<Hash, std::size_t> held_;  // how often: twice when a grant came twice
    std::vector<LockWord> words_;
    std::optional<Message> attended_;
};

}  // namespace lightnet
