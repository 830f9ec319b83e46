#include "tools/http/live_line.hpp"

#include <utility>  // which Asio forgets

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/rate_policy.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <limits>
#include <new>

#include "core/base/error.hpp"
#include "core/base/ip_address.hpp"
#include "tools/http/byte_line.hpp"

namespace lightnet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Fault = boost::system::error_code;
using namespace std::chrono_literals;

constexpr auto line_patience = 5s;
constexpr bool uncompressed = false;              // streams that could deflate take long to compile
constexpr std::size_t most_heard = 16 << 20;      // bytes of a message
constexpr std::size_t longest_answer = 64 << 10;  // to the first request

// The library keeps what it is answered at first, however much it is: until that is over, few bytes are let in.
class FewAtFirst {
public:
    bool used_up() const { return left_ == 0; }
    void let_all_in() { left_ = all; }

private:
    friend class beast::rate_policy_access;
    static constexpr auto all = std::numeric_limits<std::size_t>::max();
    std::size_t available_read_bytes() const { return left_; }
    std::size_t available_write_bytes() const { return all; }
    void transfer_read_bytes(std::size_t bytes) {
        if (left_ != all) left_ -= std::min(left_, bytes);
    }
    void transfer_write_bytes(std::size_t) {}
    void on_timer() {}

    std::size_t left_ = longest_answer;
};
using Line = beast::basic_stream<asio::ip::tcp, asio::any_io_executor, FewAtFirst>;

}  // namespace

struct LiveLine::Parts {
    asio::io_context io{1};
    websocket::stream<Line, uncompressed> socket{io};
    beast::flat_buffer heard;
    bool reading = false, complete = false, over = false;

    FewAtFirst& let_in() { return beast::get_lowest_layer(socket).rate_policy(); }
    // None: it took too long, or more was said than is listened to.
    std::optional<Fault> finish(const std::optional<Fault>& done, std::chrono::milliseconds patience) {
        const auto end = std::chrono::steady_clock::now() + patience;
        io.restart();
        while (!done && !let_in().used_up() && std::chrono::steady_clock::now() < end && io.run_one_until(end) > 0) {
        }
        return done;
    }
    // To the first address that answers.
    void connect(const ByteTarget& target, const std::string& where) {
        const auto addresses = target.addresses();
        std::string trouble = target.trouble();
        for (const auto& address : addresses) {
            std::optional<Fault> done;
            auto& line = beast::get_lowest_layer(socket);
            line.async_connect(asio::ip::tcp::endpoint(asio::ip::make_address(address), target.port()),
                               [&](Fault fault) { done = fault; });
            const auto fault = finish(done, address == addresses.back() ? line_patience : one_of_several);
            if (fault && !*fault) return;
            trouble = fault ? fault->message() : "nobody answers";
            line.close();
            io.restart();
            io.run();  // what refers to `done` is over
        }
        throw Error(where, trouble.empty() ? "nobody answers" : trouble);
    }
    // What shakes hands with somebody who may be no launcher.
    void must(const std::optional<Fault>& done, const std::string& where) try {
        const auto fault = finish(done, line_patience);
        if (fault && !*fault) return let_in().let_all_in();
        const bool long_winded = let_in().used_up();
        beast::get_lowest_layer(socket).close();
        let_in().let_all_in();
        io.restart();
        io.run();  // what refers to `done` is over
        throw Error(where, long_winded ? "what answers there is no launcher"
                           : fault     ? fault->message()
                                       : "nobody answers");
    } catch (const std::bad_alloc&) {  // it announced an answer of that size
        throw Error(where, "what answers there is no launcher");
    }
};

LiveLine::LiveLine(const std::string& host, std::uint16_t port, const std::string& path)
    : parts_(std::make_unique<Parts>()) {
    const ByteTarget target(host, port);
    const std::string name = before_port(host) + ":" + std::to_string(port);
    std::optional<Fault> accepted;
    parts_->connect(target, name);
    parts_->socket.read_message_max(most_heard);
    parts_->socket.async_handshake(name, path, [&](Fault fault) { accepted = fault; });
    parts_->must(accepted, name + path);
}

LiveLine::~LiveLine() {
    beast::get_lowest_layer(parts_->socket).close();
    parts_->io.restart();
    parts_->io.run();
}

bool LiveLine::is_over() const { return parts_->over; }

std::optional<std::string> LiveLine::next(std::chrono::milliseconds patience) {
    auto& p = *parts_;
    if (p.over) return std::nullopt;
    if (!p.reading) {
        p.reading = true;
        p.complete = false;
        p.socket.async_read(p.heard, [&p](Fault fault, std::size_t) {
            p.reading = false;
            (fault ? p.over : p.complete) = true;
        });
    }
    const auto end = std::chrono::steady_clock::now() + patience;
    p.io.restart();
    while (p.reading && p.io.run_one_until(end) > 0) {
    }
    if (!p.complete) return std::nullopt;
    p.complete = false;
    auto text = beast::buffers_to_string(p.heard.data());
    p.heard.consume(p.heard.size());
    return text;
}

void LiveLine::say(const std::string& text) {
    auto& p = *parts_;
    if (p.over) return;
    std::optional<Fault> done;
    p.socket.text(true);
    p.socket.async_write(asio::buffer(text), [&](Fault fault, std::size_t) { done = fault; });
    const auto fault = p.finish(done, line_patience);
    if (fault && !*fault) return;
    p.over = true;
    beast::get_lowest_layer(p.socket).close();
    p.io.restart();
    p.io.run();
}

}  // namespace lightnet
