// What `watch` hears from whatever listens where a launcher should: the handshake, then frames of a WebSocket.
#include <utility>  // which Asio forgets

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <thread>

#include "core/base/error.hpp"
#include "tests/fuzz/targets.hpp"
#include "tools/http/live_line.hpp"

namespace lightnet::fuzz {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;
using namespace std::chrono_literals;
using View = std::span<const std::byte>;

// Programs are prepared for too little memory, of which an allocator that checks addresses makes an end.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool too_much_is_the_end = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool too_much_is_the_end = true;
#else
constexpr bool too_much_is_the_end = false;
#endif
#else
constexpr bool too_much_is_the_end = false;
#endif

// Ten digits in a row: an answer that may announce more than there is room for.
bool announces_much(View bytes) {
    int digits = 0;
    for (const std::byte byte : bytes) {
        const char c = static_cast<char>(byte);
        digits = '0' <= c && c <= '9' ? digits + 1 : 0;
        if (digits == 10) return true;
    }
    return false;
}

// Listens for one caller after the other, on one port for all inputs.
struct Listening {
    asio::io_context io;
    tcp::acceptor door{io, {asio::ip::make_address("127.0.0.1"), 0}};

    // Shakes hands as it should, or lets the bytes do it; then says nothing but the bytes, and hangs up.
    void serve(View bytes, bool shakes_hands) {
        boost::system::error_code fault;
        tcp::socket caller(io);
        door.accept(caller, fault);
        if (fault) return;
        beast::websocket::stream<tcp::socket> line(std::move(caller));
        if (shakes_hands) line.accept(fault);
        asio::write(line.next_layer(), asio::buffer(bytes.data(), bytes.size()), fault);
        line.next_layer().shutdown(tcp::socket::shutdown_send, fault);
        std::array<char, 512> rest;
        while (!fault) line.next_layer().read_some(asio::buffer(rest), fault);
    }
};

// The first byte says which of the two.
void read(View bytes) {
    static Listening listening;
    if (bytes.empty() || (too_much_is_the_end && announces_much(bytes))) return;
    const bool shakes_hands = bytes[0] != std::byte{'r'};
    std::jthread server([&] { listening.serve(bytes.subspan(1), shakes_hands); });
    try {
        LiveLine line("127.0.0.1", listening.door.local_endpoint().port(), "/live");
        while (line.next(5s)) line.say("more");
        if (!line.is_over()) throw std::logic_error("it waits for whoever has hung up");
    } catch (const Error&) {
    }
}

std::string frame(char kind, const std::string& text) {
    std::string header{kind};
    if (text.size() < 126)
        header += static_cast<char>(text.size());
    else
        header += {126, static_cast<char>(text.size() >> 8), static_cast<char>(text.size() & 255)};
    return header + text;
}

std::vector<std::string> seeds() {
    const char text = '\x81', binary = '\x82', begin = '\x01', go_on = '\x00', end = '\x80', ping = '\x89',
               close = '\x88';
    return {"s" + frame(text, R"({"hello":{}})") + frame(ping, "here?") + frame(text, std::string(300, 'x')),
            "s" + frame(begin, "a part ") + frame(go_on, "and ") + frame(end, "the rest"),
            "s" + frame(binary, "\xff\xfe") + frame(close, std::string("\x03\xe8", 2) + "bye"),
            "rHTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            "Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n\r\n" +
                frame(text, "too early"),
            "rHTTP/1.1 404 Not Found\r\nContent-Length: 4\r\n\r\ngone"};
}

}  // namespace

Target lines() { return {"lines", read, seeds, 8}; }

}  // namespace lightnet::fuzz
