#include <stdexcept>
#include <string>

#include "tests/fuzz/targets.hpp"
#include "tests/watch/visitor.hpp"
#include "tools/watch/watch_server.hpp"

namespace lightnet::fuzz {
namespace {

// One server for all: that it still answers the next one is part of what is tested.
struct WatchedBoard {
    std::shared_ptr<WatchBoard> board = std::make_shared<WatchBoard>(Window{0, 0, 40, 40}, 2);
    WatchServer server{{{}, "right", "<p>the page</p>", [](const std::string&) {}},
                       {R"({"hello":{}})", board, [](const WatchCommand&) {}}};
    WatchedBoard() {
        const Tile whole{0, 0, 40, 40};
        board->show(whole, std::vector<Rgb>(whole.pixels() * 2, Rgb{1, 1, 1}));
        board->say("a line");
        board->tell("{}");
    }
};

void read(std::span<const std::byte> bytes) {
    static WatchedBoard watched;
    test::Visitor visitor(watched.server.port());
    if (!visitor.connected()) throw std::runtime_error("nobody listens any more");
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string any = "PORT";
    for (auto at = text.find(any); at != text.npos; at = text.find(any))
        text.replace(at, any.size(), std::to_string(watched.server.port()));
    visitor.send(text);
    visitor.end();
    visitor.all();
}

std::vector<std::string> seeds() {
    const std::string host = "Host: 127.0.0.1:PORT\r\n";
    const std::string upgrade = "GET /live HTTP/1.1\r\n" + host +
                                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
    const std::string said = R"({"do":"edit","edit":{"set":{}},"token":"right"})";
    return {"GET / HTTP/1.1\r\n" + host + "\r\n",
            "POST /state HTTP/1.1\r\n" + host + "Origin: http://127.0.0.1:PORT\r\nContent-Length: 2\r\n\r\nab",
            "GET /state HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\n2\r\nab\r\n0\r\n\r\n",
            upgrade + "\x81" + static_cast<char>(0x80 | said.size()) + std::string(4, '\0') + said};
}

}  // namespace

Target watched() { return {"watched", read, seeds}; }

}  // namespace lightnet::fuzz
