#include "tools/metrics_server.hpp"

#include "core/base/error.hpp"
#include "tools/http/http_server.hpp"
#include "tools/watch/watch_rules.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_scrapers = 32;  // connections at once

WatchAddress metrics_address(const std::string& text) {
    const auto address = watch_address(text);
    if (!address || text.rfind(':') == std::string::npos)
        throw Error("an address is like 127.0.0.1:9100, not '" + text + "'");
    return *address;
}

}  // namespace

MetricsServer::MetricsServer(const std::string& text, std::function<std::string()> figures) {
    const auto address = metrics_address(text);
    HttpServer::Options options;
    options.who = "--metrics";
    options.host = address.host;
    options.port = address.port;
    options.most_connections = most_scrapers;
    options.answer = [figures = std::move(figures)](const HttpRequest& request) -> HttpAnswer {
        if (request.path != "/metrics") return refusal(404, "there is nothing but /metrics");
        return {200, figures(), "text/plain; version=0.0.4; charset=utf-8"};
    };
    server_ = std::make_unique<HttpServer>(std::move(options));
    url_ = "http://" + in_url(address.host) + ":" + std::to_string(server_->port()) + "/metrics";
}

MetricsServer::~MetricsServer() = default;

}  // namespace lightnet
