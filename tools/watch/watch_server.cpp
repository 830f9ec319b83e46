#include "tools/watch/watch_server.hpp"

#include <utility>  // which Asio forgets

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>

#include "core/base/error.hpp"
#include "core/base/this_machine.hpp"

namespace lightnet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using Fault = boost::system::error_code;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;
using namespace std::chrono_literals;

constexpr auto look_interval = 100ms;           // at the board
constexpr auto request_patience = 5s;           // for a whole request, and for its answer to be taken
constexpr auto last_words = 500ms;              // for those who watch when the run ends
constexpr std::uint32_t most_header = 8192;     // bytes
constexpr std::size_t most_said = 1024;         // bytes of a message from the page
constexpr std::size_t most_pixels = 512 << 10;  // bytes of a frame
constexpr std::size_t most_connections = 256;

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

// What a connection may know.
struct Site {
    const WatchServer::Options& options;
    WatchBoard& board;
    WatchAddress bound;
    std::string machine = machine_name();
    std::atomic<std::size_t> watchers{0}, dropped{0};
    std::size_t connections = 0;
};

// One page that watches. Lives as long as something of it is under way.
class Watching : public std::enable_shared_from_this<Watching> {
public:
    Watching(beast::tcp_stream stream, Site& site) : socket_(std::move(stream)), site_(site) { ++site_.watchers; }
    ~Watching() { --site_.watchers; }
    Watching(const Watching&) = delete;
    Watching& operator=(const Watching&) = delete;

    void begin(const Request& request) {
        socket_.set_option(websocket::stream_base::timeout{request_patience, 30s, true});
        socket_.read_message_max(most_said);
        socket_.auto_fragment(false);
        if (site_.options.send_buffer)
            beast::get_lowest_layer(socket_).socket().set_option(
                asio::socket_base::send_buffer_size(static_cast<int>(site_.options.send_buffer)));
        socket_.async_accept(request, [self = shared_from_this()](Fault fault) {
            if (fault) return;
            self->open_ = true;
            self->texts_.push_back(self->site_.options.hello);
            self->read();
            self->look();
        });
    }

    /// Sends what has changed, if nothing is under way.
    void look() {
        if (!open_) return;
        if (sending_) {
            if (Clock::now() - since_ < std::chrono::seconds(site_.options.slow_seconds)) return;
            ++site_.dropped;
            return close();
        }
        if (!take_text() && !take_pixels()) return;
        sending_ = true;
        since_ = Clock::now();
        socket_.async_write(asio::buffer(message_), [self = shared_from_this()](Fault fault, std::size_t) {
            self->sending_ = false;
            fault ? self->close() : self->look();
        });
    }

    void close() {
        open_ = false;
        beast::get_lowest_layer(socket_).close();
    }
    bool has_all() const { return !open_ || (!sending_ && texts_.empty()); }

private:
    using Clock = std::chrono::steady_clock;

    bool take_text() {
        if (texts_.empty()) {
            if (const auto lines = site_.board.lines_since(seen_); !lines.empty())
                texts_.push_back(
                    nlohmann::json{{"log", lines}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
            if (const auto state = site_.board.state_since(seen_); !state.empty())
                texts_.push_back("{\"state\":" + state + "}");
        }
        if (texts_.empty()) return false;
        message_ = std::move(texts_.front());
        texts_.pop_front();
        socket_.text(true);
        return true;
    }
    bool take_pixels() {
        message_ = site_.board.pixels_since(seen_, most_pixels);
        socket_.binary(true);
        return !message_.empty();
    }
    void read() {
        socket_.async_read(said_, [self = shared_from_this()](Fault fault, std::size_t) {
            if (fault) return self->close();
            const std::string text = beast::buffers_to_string(self->said_.data());
            self->said_.consume(self->said_.size());
            if (!self->obey(text)) return self->close();
            self->look();
            self->read();
        });
    }
    // False: it has no sense.
    bool obey(const std::string& text) {
        const auto said = nlohmann::json::parse(text, nullptr, false);
        const auto word = [&](const char* name) {
            const auto found = said.is_object() ? said.find(name) : said.end();
            return found != said.end() && found->is_string() ? found->get<std::string>() : std::string();
        };
        const auto what = word("do");
        const bool known = what == "check" || what == "end" || what == "write" || what == "drain";
        if (!known || texts_.size() > 16) return false;
        const bool allowed = same_token(word("token"), site_.options.token);
        using What = WatchCommand::What;
        if (allowed && what != "check")
            site_.options.command({what == "end"     ? What::end
                                   : what == "write" ? What::write
                                                     : What::drain,
                                   word("host")});
        texts_.push_back(nlohmann::json{{"done", what}, {"allowed", allowed}}.dump());
        return true;
    }

    websocket::stream<beast::tcp_stream> socket_;
    Site& site_;
    beast::flat_buffer said_;
    WatchBoard::Seen seen_;
    std::deque<std::string> texts_;
    std::string message_;
    bool open_ = false, sending_ = false;
    Clock::time_point since_{};
};

Response answer(http::status status, std::string_view type, std::string body) {
    Response response(status, 11, std::move(body));
    response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("X-Frame-Options", "DENY");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Content-Security-Policy",
                 "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
                 "connect-src 'self' ws: wss:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
    response.keep_alive(false);
    return response;
}
Response refusal(http::status status, const std::string& why) { return answer(status, "text/plain", why + "\n"); }

// One request, and its answer, or a watching page from then on.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    using Adopt = std::function<void(const std::shared_ptr<Watching>&)>;
    Connection(Tcp::socket socket, Site& site, Adopt adopt)
        : stream_(std::move(socket)), site_(site), adopt_(std::move(adopt)) {
        ++site_.connections;
    }
    ~Connection() { --site_.connections; }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void begin() {
        parser_.header_limit(most_header);
        parser_.body_limit(0);
        stream_.expires_after(request_patience);
        http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](Fault fault, std::size_t) {
            if (!fault) return self->respond();
            using Error = http::error;
            if (fault == Error::header_limit)
                self->send(refusal(http::status::request_header_fields_too_large, "that header is too long"));
            else if (fault == Error::body_limit)
                self->send(refusal(http::status::payload_too_large, "nothing is taken here"));
            else if (fault != Error::end_of_stream && fault.category() == http::make_error_code({}).category())
                self->send(refusal(http::status::bad_request, "that is no request: " + fault.message()));
        });
    }

private:
    void respond() {
        const auto& request = parser_.get();
        const auto host = view(request[http::field::host]), origin = view(request[http::field::origin]);
        const auto target = view(request.target());
        const auto path = target.substr(0, target.find('?'));
        if (host.empty()) return send(refusal(http::status::bad_request, "a request names the host that it is for"));
        if (!is_own_host(host, site_.bound, site_.machine))
            return send(refusal(http::status::misdirected_request, "nobody is called so here"));
        if (!is_own_origin(origin, host))
            return send(refusal(http::status::forbidden, "pages of others get nothing here"));
        if (request.method() != http::verb::get && request.method() != http::verb::head)
            return send(refusal(http::status::method_not_allowed, "only GET is understood"));
        if (path == "/live") return watch();
        if (path == "/")
            return send(answer(http::status::ok, "text/html; charset=utf-8", std::string(site_.options.page)));
        if (path == "/state") return send(answer(http::status::ok, "application/json", state()));
        send(refusal(http::status::not_found, "there is only the page, /state and /live"));
    }
    std::string state() {
        site_.board.want();
        const auto now = site_.board.state();
        const auto& hello = site_.options.hello;  // {"hello":{…}}
        return hello.substr(0, hello.rfind('}')) + ",\"state\":" + (now.empty() ? "null" : now) + "}\n";
    }
    void watch() {
        if (!websocket::is_upgrade(parser_.get()))
            return send(refusal(http::status::upgrade_required, "/live is a WebSocket"));
        if (site_.watchers >= site_.options.most_watchers)
            return send(refusal(http::status::service_unavailable, "too many watch already"));
        site_.board.want();
        stream_.expires_never();
        const auto watching = std::make_shared<Watching>(std::move(stream_), site_);
        adopt_(watching);
        watching->begin(parser_.get());
    }
    void send(Response response) {
        const bool head = parser_.get().method() == http::verb::head;
        response_ = std::move(response);
        response_.prepare_payload();
        if (head) response_.body().clear();
        stream_.expires_after(request_patience);
        http::async_write(stream_, response_, [self = shared_from_this()](Fault, std::size_t) {
            Fault ignored;
            self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
        });
    }

    beast::tcp_stream stream_;
    Site& site_;
    Adopt adopt_;
    beast::flat_buffer buffer_{most_header * 2};
    http::request_parser<http::string_body> parser_;
    Response response_;
};

}  // namespace

struct WatchServer::Parts {
    Options options;
    Site site;  // outlives what is under way
    asio::io_context io{1};
    Tcp::acceptor acceptor{io};
    asio::steady_timer timer{io}, retry{io};
    std::set<std::weak_ptr<Watching>, std::owner_less<>> watching;
    std::optional<std::chrono::steady_clock::time_point> ends;
    std::atomic<bool> ending{false};
    std::thread thread;

    Parts(Options given, WatchBoard& board) : options(std::move(given)), site{options, board, options.address} {}
    void listen();
    void accept();
    void look();
    void run();
};

void WatchServer::Parts::listen() try {
    const Tcp::endpoint at(asio::ip::make_address(options.address.host), options.address.port);
    acceptor.open(at.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(at);
    acceptor.listen();
    site.bound.port = acceptor.local_endpoint().port();
} catch (const boost::system::system_error& error) {
    throw Error("--watch", in_url(options.address.host) + ":" + std::to_string(options.address.port) +
                               " can't be listened at: " + error.code().message());
}

void WatchServer::Parts::accept() {
    acceptor.async_accept([this](Fault fault, Tcp::socket socket) {
        if (fault == asio::error::operation_aborted) return;
        if (fault) {  // no descriptors are left, say: others may close theirs
            retry.expires_after(look_interval);
            return retry.async_wait([this](Fault) { accept(); });
        }
        if (site.connections < most_connections) {
            const auto adopt = [this](const std::shared_ptr<Watching>& one) { watching.insert(one); };
            std::make_shared<Connection>(std::move(socket), site, adopt)->begin();
        }
        accept();
    });
}

void WatchServer::Parts::look() {
    const auto now = std::chrono::steady_clock::now();
    bool all = true;
    for (auto one = watching.begin(); one != watching.end();) {
        const auto page = one->lock();
        if (page) page->look(), all = all && page->has_all();
        one = page ? std::next(one) : watching.erase(one);
    }
    if (ending && !ends) ends = now + last_words;
    if (ends && (all || now >= *ends)) return io.stop();
    timer.expires_after(look_interval);
    timer.async_wait([this](Fault) { look(); });
}

void WatchServer::Parts::run() {
    while (!io.stopped()) try {
            io.run();
        } catch (const std::exception&) {  // of one connection, which is gone with it
        }
}

WatchServer::WatchServer(Options options, WatchBoard& board)
    : parts_(std::make_unique<Parts>(std::move(options), board)) {
    parts_->listen();
    parts_->accept();
    parts_->look();
    parts_->thread = std::thread([parts = parts_.get()] { parts->run(); });
}

WatchServer::~WatchServer() {
    parts_->ending = true;
    asio::post(parts_->io, [parts = parts_.get()] { parts->timer.cancel(); });
    parts_->thread.join();
}

std::uint16_t WatchServer::port() const { return parts_->site.bound.port; }
std::string WatchServer::url() const {
    return "http://" + in_url(parts_->options.address.host) + ":" + std::to_string(port()) + "/#" +
           parts_->options.token;
}
std::size_t WatchServer::watchers() const { return parts_->site.watchers; }
std::size_t WatchServer::dropped() const { return parts_->site.dropped; }

}  // namespace lightnet
