// A line between programs of this machine on which all bytes take longer, as between machines that are far apart.
#pragma once

#include <chrono>
#include <memory>
#include <string>

namespace lightnet {

/// Has a thread of its own, which passes on what comes. Nobody needs to know of it but whoever hands out its endpoint.
class LatencyProxy {
public:
    /// Listens on a free port of this machine, and calls `endpoint` ("tcp://127.0.0.1:7777") for whoever calls there;
    /// each byte arrives `delay` later than it was sent, in both directions. Throws Error.
    LatencyProxy(const std::string& endpoint, std::chrono::milliseconds delay);
    ~LatencyProxy();
    LatencyProxy(const LatencyProxy&) = delete;
    LatencyProxy& operator=(const LatencyProxy&) = delete;

    /// Where it listens.
    const std::string& endpoint() const { return endpoint_; }

private:
    class Relay;
    std::unique_ptr<Relay> relay_;
    std::string endpoint_;
};

}  // namespace lightnet
