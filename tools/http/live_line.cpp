#include "tools/http/live_line.hpp"

#include <utility>  // which Asio forgets

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

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
constexpr std::size_t most_heard = 16 << 20;  // bytes of a message

}  // namespace

struct LiveLine::Parts {
    asio::io_context io{1};
    websocket::stream<beast::tcp_stream> socket{io};
    beast::flat_buffer heard;
    bool reading = false, complete = false, over = false;

    // None: it took too long.
    std::optional<Fault> finish(const std::optional<Fault>& done, std::chrono::milliseconds patience) {
        const auto end = std::chrono::steady_clock::now() + patience;
        io.restart();
        while (!done && std::chrono::steady_clock::now() < end && io.run_one_until(end) > 0) {
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
    void must(const std::optional<Fault>& done, const std::string& where) {
        const auto fault = finish(done, line_patience);
        if (fault && !*fault) return;
        beast::get_lowest_layer(socket).close();
        io.restart();
        io.run();  // what refers to `done` is over
        throw Error(where, fault ? fault->message() : "nobody answers");
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
