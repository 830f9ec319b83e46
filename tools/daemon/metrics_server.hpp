// Lets Prometheus ask how a daemon does.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "tools/http/watch_rules.hpp"

namespace lightnet {

class HttpServer;

/// Answers GET /metrics, and GET /healthz (200, or 503 and why not), on an address of its own, in a thread of its own
/// (HttpServer), which serves some dozen connections at once and closes those that are slow. Everything else gets a
/// 4xx, and so does who calls an address of this machine alone by a name that isn't its own.
class MetricsServer {
public:
    /// `address`: "127.0.0.1:9100"; port 0: the system chooses. `metrics` gives the
    /// text, `unfit` why the daemon can take no work ("": it can); both are called by the server's thread. Throws Error
    /// when the address can't be had.
    MetricsServer(const std::string& address, std::function<std::string()> metrics, std::function<std::string()> unfit);
    ~MetricsServer();
    MetricsServer(const MetricsServer&) = delete;
    MetricsServer& operator=(const MetricsServer&) = delete;

    /// "http://127.0.0.1:9100/metrics"
    const std::string& url() const { return url_; }

private:
    bool is_called(std::string_view host) const;

    std::string url_;
    WatchAddress address_;
    std::atomic<std::uint16_t> port_{0};  // at which it listens
    std::unique_ptr<HttpServer> server_;
};

}  // namespace lightnet
