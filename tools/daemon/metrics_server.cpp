#include "tools/daemon/metrics_server.hpp"

#include "core/base/error.hpp"
#include "tools/http/http_server.hpp"
#include "tools/http/watch_rules.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_scrapers = 32;  // connections at once

WatchAddress metrics_address(const std::string& text) {
    const auto address = watch_address(text);
    if (!address || text.rfind(':') == std::string::npos)
        throw Error("an address is like 127.0.0.1:9100 or [::1]:9100, not '" + text + "'");
    return *address;
}

}  // namespace

MetricsServer::MetricsServer(const std::string& text, std::function<std::string()> metrics,
                             std::function<std::string()> unfit) {
    const auto address = metrics_address(text);
    HttpServer::Options options;
    options.who = "--metrics";
    options.host = address.host;
    options.port = address.port;
    options.most_connections = most_scrapers;
    options.answer = [this, metrics = std::move(metrics),
                      unfit = std::move(unfit)](const HttpRequest& request) -> HttpAnswer {
        if (request.host.empty()) return refusal(400, "a request names the host that it is for");
        if (!is_called(request.host)) return refusal(421, "nobody is called so here");
        if (!is_own_origin(request.origin, request.host)) return refusal(403, "pages of others get nothing here");
        if (request.path == "/metrics") return {200, metrics(), "text/plain; version=0.0.4; charset=utf-8"};
        if (request.path != "/healthz") return refusal(404, "there is nothing but /metrics and /healthz");
        const auto why = unfit();
        return {why.empty() ? 200 : 503, (why.empty() ? "ok" : why) + "\n"};
    };
    address_ = address;
    server_ = std::make_unique<HttpServer>(std::move(options));
    port_ = server_->port();
    url_ = "http://" + in_url(address.host) + ":" + std::to_string(server_->port()) + "/metrics";
}

MetricsServer::~MetricsServer() = default;

// A page of others, whose name leads to this machine by now, would read what is meant for this machine alone. What
// others reach they may call as they like.
bool MetricsServer::is_called(std::string_view host) const {
    return !address_.stays_here() || is_own_host(host, {address_.host, port_}, "");
}

}  // namespace lightnet
