// A daemon in a thread of this process: its nodes may be those of a test.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>

#include "transport/daemon/host.hpp"

namespace lightnet::test {

/// Serves until it ends. `places` 0: one per core; `cache`: see Host::Options.
class HostThread {
public:
    explicit HostThread(const Registry& kinds, std::uint32_t places = 1, const std::string& cache = "")
        : host_(options(places, cache), kinds) {}
    HostThread(const Registry& kinds, Host::Options options) : host_(std::move(options), kinds) {}
    ~HostThread() { leave(); }
    HostThread(const HostThread&) = delete;
    HostThread& operator=(const HostThread&) = delete;

    /// As SIGTERM does.
    void leave() { stop_ = true; }
    std::string endpoint() const { return host_.endpoint(); }

private:
    static Host::Options options(std::uint32_t places, const std::string& cache) {
        Host::Options options;
        options.places = places;
        options.cache = cache;
        return options;
    }

    Host host_;
    std::atomic<bool> stop_{false};
    std::jthread thread_{[this] { host_.serve(stop_); }};
};

}  // namespace lightnet::test
