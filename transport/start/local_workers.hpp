// Daemons that the launcher starts on its own machine.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "transport/keys/key.hpp"

namespace lightnet {

/// Child processes, each a lightnetd on a port of its own. Those that die are started anew on the same port, later and
/// later, and given up when they keep dying before they were of use. They end with this object, and with the launcher,
/// however that ends.
class LocalWorkers {
public:
    using Time = std::chrono::steady_clock::time_point;

    /// By which they and the launcher know each other: other users of the machine can reach their ports, too.
    struct Keys {
        KeyPair workers = KeyPair::random();
        PublicKey launcher;
    };
    /// Starts `count` daemons of `places` places each, and waits until each says where it listens. Without `keys` they
    /// ask for none. Throws Error when one does not.
    LocalWorkers(std::string program, std::uint32_t count, std::uint32_t places,
                 std::optional<Keys> keys = std::nullopt);
    /// SIGTERM, then, after a second, SIGKILL.
    ~LocalWorkers();
    LocalWorkers(const LocalWorkers&) = delete;
    LocalWorkers& operator=(const LocalWorkers&) = delete;

    std::vector<std::string> endpoints() const;

    /// What look_after() tells and asks.
    struct Handlers {
        std::function<void(const std::string& endpoint)> ended;   // its process has
        std::function<bool(const std::string& endpoint)> of_use;  // it serves the run
        std::function<void(const std::string& text)> say;
    };
    /// Starts those anew whose process has ended. Returns at once.
    void look_after(Time now, const Handlers& handlers);

private:
    struct Worker {
        std::string endpoint;
        int process = 0;         // 0: has ended
        int useless_deaths = 0;  // in a row
        bool was_of_use = false;
        Time next_start{};
    };
    void died(Worker& worker, Time now, const Handlers& handlers);
    int start(const std::string& listen, int* out) const;

    std::string program_;
    std::uint32_t places_;
    std::optional<Keys> keys_;
    std::vector<Worker> workers_;
};

}  // namespace lightnet
