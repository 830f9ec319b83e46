// Named locks for what there is little of: a licence, a device, a file that one alone may write.
#pragma once

#include <map>
#include <string>
#include <utility>

namespace lightnet {

/// One node's access to the locks of the run. At most one call in the whole run holds a lock of a name, on whatever
/// host it runs; the others wait. Asking an input while holding one is an error, as it could make places wait for each
/// other. What a lock protects must not decide what is answered.
class Locks {
public:
    /// Releases when it goes out of scope.
    class Held {
    public:
        Held(Locks& locks, std::string name) : locks_(&locks), name_(std::move(name)) {}
        Held(Held&& other) noexcept : locks_(std::exchange(other.locks_, nullptr)), name_(std::move(other.name_)) {}
        Held& operator=(Held&&) = delete;
        ~Held() {
            if (locks_) locks_->release(name_);
        }

    private:
        Locks* locks_;
        std::string name_;
    };

    virtual ~Locks() = default;
    /// Waits for the lock. Throws Error when the calling work holds one already: nobody may wait with a lock in hand.
    [[nodiscard]] Held hold(const std::string& name);
    /// Throws Error when the work that runs now holds a lock.
    void check_may_ask() const;

protected:
    /// What runs now: any number that tells pieces of work apart.
    virtual const void* worker() const = 0;
    virtual void wait_for(const std::string& name) = 0;
    virtual void give_back(const std::string& name) noexcept = 0;

private:
    void release(const std::string& name) noexcept;
    std::map<const void*, std::string> held_;
};

/// For a run of one thread: there is nobody else.
class NoLocks final : public Locks {
protected:
    const void* worker() const override { return nullptr; }
    void wait_for(const std::string&) override {}
    void give_back(const std::string&) noexcept override {}
};

}  // namespace lightnet
