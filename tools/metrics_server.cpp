#include "tools/metrics_server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include <charconv>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using Tcp = asio::ip::tcp;
using Text = std::function<std::string()>;

constexpr auto patience = std::chrono::seconds(5);  // with whoever asks
constexpr std::uint32_t longest_header = 8192;      // bytes
constexpr int most_sessions = 32;
constexpr auto accept_again = std::chrono::milliseconds(100);

/// One connection: one question, one answer.
class MetricsSession : public std::enable_shared_from_this<MetricsSession> {
public:
    MetricsSession(Tcp::socket socket, const Text& text, int& open)
        : stream_(std::move(socket)), text_(text), open_(open) {
        ++open_;
        parser_.header_limit(longest_header);
        parser_.body_limit(0);
    }
    ~MetricsSession() { --open_; }
    MetricsSession(const MetricsSession&) = delete;
    MetricsSession& operator=(const MetricsSession&) = delete;

    void begin() {
        stream_.expires_after(patience);
        http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](beast::error_code wrong, std::size_t) {
            if (!wrong)
                self->answer();
            else if (wrong != http::error::end_of_stream && wrong != beast::error::timeout)
                self->send(http::status::bad_request, "this is no request for /metrics\n");
        });
    }

private:
    void answer() {
        const auto& asked = parser_.get();
        if (asked.method() != http::verb::get && asked.method() != http::verb::head)
            return send(http::status::method_not_allowed, "only GET\n");
        if (asked.target() != "/metrics") return send(http::status::not_found, "there is nothing but /metrics\n");
        send(http::status::ok, text_());
    }

    void send(http::status status, std::string body) {
        response_ = {status, 11};
        response_.set(http::field::content_type, "text/plain; version=0.0.4; charset=utf-8");
        if (status == http::status::method_not_allowed) response_.set(http::field::allow, "GET, HEAD");
        const auto size = body.size();
        if (parser_.is_header_done() && parser_.get().method() == http::verb::head) body.clear();
        response_.body() = std::move(body);
        response_.content_length(size);
        response_.keep_alive(false);
        stream_.expires_after(patience);
        http::async_write(stream_, response_, [self = shared_from_this()](beast::error_code, std::size_t) {
            beast::error_code ignored;
            self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
        });
    }

    beast::tcp_stream stream_;
    beast::flat_buffer buffer_{longest_header};
    http::request_parser<http::empty_body> parser_;
    http::response<http::string_body> response_;
    const Text& text_;
    int& open_;
};

Tcp::endpoint endpoint_of(const std::string& address) {
    const auto colon = address.rfind(':');
    unsigned short port = 0;
    boost::system::error_code wrong;
    const auto host = asio::ip::make_address(address.substr(0, colon), wrong);
    const char* end = address.data() + address.size();
    if (colon == std::string::npos || wrong) throw Error("an address is like 127.0.0.1:9100, not '" + address + "'");
    const auto [last, fault] = std::from_chars(address.data() + colon + 1, end, port);
    if (fault != std::errc{} || last != end) throw Error("an address is like 127.0.0.1:9100, not '" + address + "'");
    return {host, port};
}

}  // namespace

struct MetricsServer::Server {
    Server(const std::string& address, Text given) : text(std::move(given)), acceptor(context, endpoint_of(address)) {
        accept();
        thread = std::jthread([this] { context.run(); });
    }
    ~Server() { context.stop(); }

    void accept() {
        acceptor.async_accept([this](boost::system::error_code wrong, Tcp::socket socket) {
            if (wrong == asio::error::operation_aborted) return;
            if (wrong) {  // no descriptors are left, say: others may close theirs
                retry.expires_after(accept_again);
                return retry.async_wait([this](boost::system::error_code) { accept(); });
            }
            if (open < most_sessions) std::make_shared<MetricsSession>(std::move(socket), text, open)->begin();
            accept();
        });
    }

    Text text;
    int open = 0;  // sessions
    asio::io_context context{1};
    Tcp::acceptor acceptor;
    asio::steady_timer retry{context};
    std::jthread thread;
};

MetricsServer::MetricsServer(const std::string& address, std::function<std::string()> text) try
    : server_(std::make_unique<Server>(address, std::move(text))) {
} catch (const boost::system::system_error& error) {
    throw Error("metrics at " + address, error.code().message());
}

MetricsServer::~MetricsServer() = default;

std::string MetricsServer::url() const {
    const auto at = server_->acceptor.local_endpoint();
    return "http://" + at.address().to_string() + ":" + std::to_string(at.port()) + "/metrics";
}

}  // namespace lightnet
