#include "tests/watch/visitor.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

namespace lightnet::test {

Visitor::Visitor(std::uint16_t port, int receive_buffer) {
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    if (receive_buffer) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return;
    ::close(socket_);
    socket_ = -1;
}

Visitor::~Visitor() {
    if (socket_ >= 0) ::close(socket_);
}

void Visitor::send(std::string_view bytes) const {
    while (!bytes.empty()) {
        const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent <= 0) return;
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
}

void Visitor::end() const { ::shutdown(socket_, SHUT_WR); }

bool Visitor::more(std::chrono::milliseconds patience) {
    pollfd item{socket_, POLLIN, 0};
    if (::poll(&item, 1, static_cast<int>(patience.count())) <= 0) return false;
    std::array<char, 65536> part{};
    const auto size = ::recv(socket_, part.data(), part.size(), 0);
    if (size <= 0) return false;
    come_.append(part.data(), static_cast<std::size_t>(size));
    return true;
}

bool Visitor::have(std::size_t bytes, std::chrono::milliseconds patience) {
    while (come_.size() < bytes)
        if (!more(patience)) return false;
    return true;
}

std::string Visitor::all(std::chrono::milliseconds patience) {
    while (more(patience)) {
    }
    return come_;
}

bool Visitor::watch(const std::string& host, const std::string& origin) {
    send("GET /live HTTP/1.1\r\nHost: " + host + "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
         (origin.empty() ? "" : "Origin: " + origin + "\r\n") +
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
    std::size_t end = 0;
    while ((end = come_.find("\r\n\r\n")) == std::string::npos)
        if (!more(slowdown * std::chrono::seconds(20))) return false;
    const bool may = status_of(come_) == 101;
    come_.erase(0, end + 4);
    return may;
}

std::optional<Visitor::Frame> Visitor::next(std::chrono::milliseconds patience) {
    while (true) {
        if (!have(2, patience)) return std::nullopt;
        const int kind = come_[0] & 15;
        std::size_t size = static_cast<unsigned char>(come_[1]) & 127u, head = 2;
        if (size > 125) {
            const std::size_t digits = size == 126 ? 2 : 8;
            if (!have(head + digits, patience)) return std::nullopt;
            size = 0;
            for (std::size_t i = 0; i < digits; ++i) size = size << 8 | static_cast<unsigned char>(come_[head + i]);
            head += digits;
        }
        if (!have(head + size, patience)) return std::nullopt;
        Frame frame{kind == 1, come_.substr(head, size)};
        come_.erase(0, head + size);
        if (kind == 8) return std::nullopt;
        if (kind < 8) return frame;  // else a ping
    }
}

std::optional<std::string> Visitor::next_with(const std::string& part) {
    while (auto frame = next())
        if (frame->text && frame->data.find(part) != std::string::npos) return frame->data;
    return std::nullopt;
}

void Visitor::say(std::string_view text) const {
    std::string frame{'\x81', static_cast<char>(text.size() < 126 ? 0x80 | text.size() : 0xfe)};
    if (text.size() >= 126) frame += {static_cast<char>(text.size() >> 8), static_cast<char>(text.size() & 255)};
    frame += std::string(4, '\0');  // the mask of all zeros
    send(frame + std::string(text));
}

std::string get(std::uint16_t port, const std::string& target, const std::string& more, const std::string& host) {
    Visitor visitor(port);
    visitor.send("GET " + target + " HTTP/1.1\r\nHost: " + (host.empty() ? "127.0.0.1:" + std::to_string(port) : host) +
                 "\r\n" + more + "\r\n");
    return visitor.all();
}

int status_of(std::string_view answer) {
    return answer.starts_with("HTTP/1.1 ") ? std::atoi(std::string(answer.substr(9, 3)).c_str()) : 0;
}

}  // namespace lightnet::test
