// One process at a time.
#pragma once

#include <atomic>
#include <string>

namespace lightnet {

/// A lock by name among the processes of this user on this machine. It goes with the process, however that ends.
class SingleInstance {
public:
    /// Waits until no other process has it, or until `stop` is set. Throws Error when no lock can be made.
    SingleInstance(const std::string& name, const std::atomic<bool>& stop);
    ~SingleInstance();
    SingleInstance(const SingleInstance&) = delete;
    SingleInstance& operator=(const SingleInstance&) = delete;

private:
    int file_ = -1;
};

}  // namespace lightnet
