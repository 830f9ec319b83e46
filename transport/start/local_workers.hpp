// Daemons that the launcher starts on its own machine.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "transport/keys/key.hpp"
#include "transport/start/cpu_throttle.hpp"
#include "transport/start/fault_injection.hpp"
#include "transport/start/latency_proxy.hpp"
#include "transport/start/restarts.hpp"

namespace lightnet {

/// Child processes, each a lightnetd on a port of its own. Those that die are started anew on the same port, later and
/// later, and given up when they keep dying before they were of use; so are those that die while they start. They end
/// with this object, and with the launcher, however that ends.
class LocalWorkers {
public:
    using Time = std::chrono::steady_clock::time_point;

    /// By which they and the launcher know each other: other users of the machine can reach their ports, too.
    struct Keys {
        KeyPair workers = KeyPair::random();
        PublicKey launcher;
    };
    /// Starts `count` daemons of `places` places each, and waits until each says where it listens. Without `keys` they
    /// ask for none. `cache`: the folder for their files; "": the usual one. Throws Error when none does: one that ends
    /// by itself, or stays silent, is given up. No more than a few for each core start at a time.
    LocalWorkers(std::string program, std::uint32_t count, std::uint32_t places,
                 std::optional<Keys> keys = std::nullopt, FaultInjection troubles = {}, std::string cache = {});
    /// SIGTERM, then, after a second, SIGKILL.
    ~LocalWorkers();
    LocalWorkers(const LocalWorkers&) = delete;
    LocalWorkers& operator=(const LocalWorkers&) = delete;

    /// Where others reach those that have started.
    std::vector<std::string> endpoints() const;
    /// How many have not, and are given up.
    std::size_t missing() const;

    /// What look_after() tells and asks.
    struct Handlers {
        std::function<void(const std::string& endpoint)> ended;   // its process has
        std::function<bool(const std::string& endpoint)> of_use;  // it serves the run
        std::function<void(const std::string& text)> say;
        std::function<double()> done = [] { return 0.0; };  // share of the picture that is there
    };
    /// Starts those anew whose process has ended, and kills those whose time to be lost has come. Returns at once.
    void look_after(Time now, const Handlers& handlers);

private:
    struct Worker {
        std::string listens;   // where it does; "": it has never started
        std::string endpoint;  // where others reach it
        int process = 0;       // 0: has ended
        bool was_of_use = false;
        Restarts restarts{};
        std::unique_ptr<LatencyProxy> line = nullptr;
        std::unique_ptr<CpuThrottle> slow = nullptr;
    };
    void start_all(std::uint32_t count);
    bool await_start(Worker& worker, int out);
    void kill_all();
    void begin_troubles();
    void slow_down(Worker& worker);
    void lose(double done, const Handlers& handlers);
    void died(Worker& worker, Time now, const Handlers& handlers);
    int start(const std::string& listen, int* out) const;

    std::string program_;
    std::uint32_t places_;
    std::optional<Keys> keys_;
    FaultInjection troubles_;
    std::string cache_;
    std::vector<Worker> workers_;
};

}  // namespace lightnet
