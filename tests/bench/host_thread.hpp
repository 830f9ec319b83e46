// A daemon in a thread of the benchmark.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "transport/host.hpp"

namespace lightnet::bench {

/// Offers one place.
class HostThread {
public:
    explicit HostThread(const Registry& kinds) : host_(one_place(), kinds) {}
    ~HostThread() { stop_ = true; }
    HostThread(const HostThread&) = delete;
    HostThread& operator=(const HostThread&) = delete;
    std::string endpoint() const { return host_.endpoint(); }

private:
    static Host::Options one_place() {
        Host::Options options;
        options.places = 1;
        return options;
    }

    Host host_;
    std::atomic<bool> stop_{false};
    std::jthread thread_{[this] { host_.serve(stop_); }};
};

}  // namespace lightnet::bench
