// Daemons that the launcher starts on its own machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lightnet {

/// Child processes, each a lightnetd on a port of its own. They end with this object, and with the launcher, however
/// that ends.
class LocalWorkers {
public:
    /// Starts `count` daemons of `places` places each, and waits until each says where it listens. Throws Error when
    /// one does not.
    LocalWorkers(const std::string& program, std::uint32_t count, std::uint32_t places);
    /// SIGTERM, then, after a second, SIGKILL.
    ~LocalWorkers();
    LocalWorkers(const LocalWorkers&) = delete;
    LocalWorkers& operator=(const LocalWorkers&) = delete;

    const std::vector<std::string>& endpoints() const { return endpoints_; }
    /// Those whose process has ended since the last call.
    std::vector<std::string> ended();

private:
    std::vector<std::string> endpoints_;
    std::vector<int> processes_;  // 0: has ended
};

}  // namespace lightnet
