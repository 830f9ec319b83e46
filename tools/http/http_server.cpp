#include "tools/http/http_server.hpp"

#include <utility>  // which Asio forgets

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>

#include <atomic>
#include <chrono>
#include <exception>
#include <set>
#include <thread>

#include "core/base/error.hpp"
#include "core/base/spare_threads.hpp"

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

constexpr auto look_interval = 100ms;        // at what guests have to say
constexpr auto request_patience = 5s;        // for a whole request, and for its answer to be taken
constexpr auto last_words = 500ms;           // of guests when the server ends
constexpr std::uint32_t most_header = 8192;  // bytes
constexpr std::size_t most_said = 1024;      // bytes of a message to a guest

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

// What a connection may know.
struct HttpSite {
    const HttpServer::Options& options;
    std::atomic<std::size_t> dropped{0};
    std::size_t connections = 0;
};

// A connection that has become a WebSocket. Lives as long as something of it is under way.
class GuestLine : public std::enable_shared_from_this<GuestLine> {
public:
    GuestLine(beast::tcp_stream stream, std::shared_ptr<HttpGuest> guest, HttpSite& site)
        : socket_(std::move(stream)), guest_(std::move(guest)), site_(site) {}

    void begin(const Request& request) {
        socket_.set_option(websocket::stream_base::timeout{request_patience, 30s, true});
        socket_.read_message_max(most_said);
        socket_.auto_fragment(false);
        if (site_.options.send_buffer)
            beast::get_lowest_layer(socket_).socket().set_option(
                asio::socket_base::send_buffer_size(static_cast<int>(site_.options.send_buffer)));
        socket_.async_accept(request, [self = shared_from_this()](Fault fault) {
            if (fault) return self->close();
            self->stage_ = Stage::open;
            self->read();
            self->look();
        });
    }

    /// Sends what there is to say, if nothing is under way.
    void look() {
        if (stage_ != Stage::open) return;
        if (sending_) {
            if (Clock::now() - since_ < std::chrono::seconds(site_.options.slow_seconds)) return;
            ++site_.dropped;
            return close();
        }
        auto message = guest_->next();
        if (!message) return;
        message_ = std::move(message->data);
        socket_.text(message->text);
        sending_ = true;
        since_ = Clock::now();
        socket_.async_write(asio::buffer(message_), [self = shared_from_this()](Fault fault, std::size_t) {
            self->sending_ = false;
            fault ? self->close() : self->look();
        });
    }
    /// After look(): all was said, or can't be.
    bool is_done() const { return stage_ == Stage::closed || (stage_ == Stage::open && !sending_); }

private:
    using Clock = std::chrono::steady_clock;
    enum class Stage { greeting, open, closed };

    void close() {
        stage_ = Stage::closed;
        beast::get_lowest_layer(socket_).close();
    }
    void read() {
        socket_.async_read(said_, [self = shared_from_this()](Fault fault, std::size_t) {
            if (fault) return self->close();
            const std::string text = beast::buffers_to_string(self->said_.data());
            self->said_.consume(self->said_.size());
            if (!self->guest_->hear(text)) return self->close();
            self->look();
            self->read();
        });
    }

    websocket::stream<beast::tcp_stream, false> socket_;  // true could deflate, and takes long to compile
    std::shared_ptr<HttpGuest> guest_;
    HttpSite& site_;
    beast::flat_buffer said_;
    std::string message_;
    Stage stage_ = Stage::greeting;
    bool sending_ = false;
    Clock::time_point since_{};
};

// One request, and its answer, or a WebSocket from then on.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
public:
    using Adopt = std::function<void(const std::shared_ptr<GuestLine>&)>;
    HttpConnection(Tcp::socket socket, HttpSite& site, Adopt adopt)
        : stream_(std::move(socket)), site_(site), adopt_(std::move(adopt)) {
        ++site_.connections;
    }
    ~HttpConnection() { --site_.connections; }
    HttpConnection(const HttpConnection&) = delete;
    HttpConnection& operator=(const HttpConnection&) = delete;

    void begin() {
        parser_.header_limit(most_header);
        parser_.body_limit(0);
        stream_.expires_after(request_patience);
        http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](Fault fault, std::size_t) {
            if (!fault) return self->respond();
            using Error = http::error;
            if (fault == Error::header_limit)
                self->send(refusal(431, "that header is too long"));
            else if (fault == Error::body_limit)
                self->send(refusal(413, "nothing is taken here"));
            else if (fault != Error::end_of_stream && fault.category() == http::make_error_code({}).category())
                self->send(refusal(400, "that is no request: " + fault.message()));
        });
    }

private:
    void respond() {
        const auto& request = parser_.get();
        const auto method = request.method();
        if (method != http::verb::get && method != http::verb::head)
            return send(refusal(405, "only GET is understood"));
        // RFC 9112, section 3.2: whoever believes the one and whoever believes the other would answer differently
        if (request.count(http::field::host) > 1 || request.count(http::field::origin) > 1)
            return send(refusal(400, "a request names one host that it is for, and one page that it is from"));
        const auto target = view(request.target());
        auto answer = site_.options.answer({target.substr(0, target.find('?')), view(request[http::field::host]),
                                            view(request[http::field::origin]), websocket::is_upgrade(request)});
        if (!answer.guest) return send(std::move(answer));
        stream_.expires_never();
        const auto line = std::make_shared<GuestLine>(std::move(stream_), std::move(answer.guest), site_);
        adopt_(line);
        line->begin(request);
    }
    void send(HttpAnswer answer) {
        response_ = Response(http::int_to_status(static_cast<unsigned>(answer.status)), 11, std::move(answer.body));
        response_.set(http::field::content_type, answer.type);
        response_.set(http::field::cache_control, "no-store");
        response_.set("X-Content-Type-Options", "nosniff");
        if (answer.status == 405) response_.set(http::field::allow, "GET, HEAD");
        for (const auto& [name, value] : site_.options.headers) response_.set(name, value);
        response_.keep_alive(false);
        response_.prepare_payload();
        if (parser_.is_header_done() && parser_.get().method() == http::verb::head) response_.body().clear();
        stream_.expires_after(request_patience);
        http::async_write(stream_, response_, [self = shared_from_this()](Fault, std::size_t) {
            Fault ignored;
            self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
        });
    }

    beast::tcp_stream stream_;
    HttpSite& site_;
    Adopt adopt_;
    beast::flat_buffer buffer_{most_header * 2};
    http::request_parser<http::string_body> parser_;
    Response response_;
};

}  // namespace

HttpAnswer refusal(int status, const std::string& why) { return {status, why + "\n"}; }

struct HttpServer::Parts {
    Options options;
    HttpSite site;  // outlives what is under way
    asio::io_context io{1};
    Tcp::acceptor acceptor{io};
    asio::steady_timer timer{io}, retry{io};
    std::set<std::weak_ptr<GuestLine>, std::owner_less<>> guests;
    std::optional<std::chrono::steady_clock::time_point> ends;
    std::atomic<bool> ending{false};
    std::uint16_t port = 0;
    std::thread thread;

    explicit Parts(Options given) : options(std::move(given)), site{options} {}
    void listen();
    void accept();
    void look();
    void run();
};

void HttpServer::Parts::listen() try {
    const Tcp::endpoint at(asio::ip::make_address(options.host), options.port);
    acceptor.open(at.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    if (at.address().is_v6()) acceptor.set_option(asio::ip::v6_only(false));  // "::" is for both families
    acceptor.bind(at);
    acceptor.listen();
    port = acceptor.local_endpoint().port();
} catch (const boost::system::system_error& error) {
    throw Error(options.who, options.host + " port " + std::to_string(options.port) +
                                 " can't be listened at: " + error.code().message());
}

void HttpServer::Parts::accept() {
    acceptor.async_accept([this](Fault fault, Tcp::socket socket) {
        if (fault == asio::error::operation_aborted) return;
        if (fault) {  // no descriptors are left, say: others may close theirs
            retry.expires_after(look_interval);
            return retry.async_wait([this](Fault) { accept(); });
        }
        if (site.connections < options.most_connections) {
            const auto adopt = [this](const std::shared_ptr<GuestLine>& one) { guests.insert(one); };
            std::make_shared<HttpConnection>(std::move(socket), site, adopt)->begin();
        }
        accept();
    });
}

void HttpServer::Parts::look() {
    const auto now = std::chrono::steady_clock::now();
    bool all = true;
    for (auto one = guests.begin(); one != guests.end();) {
        const auto line = one->lock();
        if (line) line->look(), all = all && line->is_done();
        one = line ? std::next(one) : guests.erase(one);
    }
    if (ending && !ends) ends = now + last_words;
    if (ends && (all || now >= *ends)) return io.stop();
    timer.expires_after(look_interval);
    timer.async_wait([this](Fault) { look(); });
}

void HttpServer::Parts::run() {
    while (!io.stopped()) try {
            io.run();
        } catch (const std::exception&) {  // of one connection, which is gone with it
        }
}

HttpServer::HttpServer(Options options) : parts_(std::make_unique<Parts>(std::move(options))) {
    want_threads(1, parts_->options.who);
    parts_->listen();
    parts_->accept();
    parts_->look();
    parts_->thread = std::thread([parts = parts_.get()] { parts->run(); });
}

HttpServer::~HttpServer() {
    parts_->ending = true;
    asio::post(parts_->io, [parts = parts_.get()] { parts->timer.cancel(); });
    parts_->thread.join();
}

std::uint16_t HttpServer::port() const { return parts_->port; }
std::size_t HttpServer::dropped() const { return parts_->site.dropped; }

}  // namespace lightnet
