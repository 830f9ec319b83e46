#include "tools/outside/outside_line.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/base/error.hpp"
#include "core/base/unwanted.hpp"

namespace lightnet {
namespace {

constexpr int look_every = 100;  // milliseconds: is this still wanted?

[[noreturn]] void gone() { throw Error("the process that answers functions from outside is gone"); }

}  // namespace

OutsideLine::OutsideLine(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) throw Error(path, "too long for the name of a socket");
    std::memcpy(address.sun_path, path.data(), path.size());
    socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0 || ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        const auto why = std::generic_category().message(errno);
        if (socket_ >= 0) ::close(socket_);
        throw Error(path, why);
    }
}

OutsideLine::~OutsideLine() { ::close(socket_); }

void OutsideLine::send(char kind, std::span<const std::byte> data) {
    std::vector<std::byte> message(5 + data.size());
    message[0] = static_cast<std::byte>(kind);
    for (std::size_t i = 0; i < 4; ++i) message[1 + i] = static_cast<std::byte>(data.size() >> (8 * i));
    if (!data.empty()) std::memcpy(message.data() + 5, data.data(), data.size());
    for (std::size_t sent = 0; sent < message.size();) {
        const auto n = ::send(socket_, message.data() + sent, message.size() - sent, MSG_NOSIGNAL);
        if (n < 0 && errno != EINTR) gone();
        if (n > 0) sent += static_cast<std::size_t>(n);
    }
}

void OutsideLine::read(std::span<std::byte> to) {
    while (!to.empty()) {
        pollfd waiting{socket_, POLLIN, 0};
        const int told = ::poll(&waiting, 1, look_every);
        end_if_unwanted();
        if (told <= 0) continue;
        const auto n = ::read(socket_, to.data(), to.size());
        if (n == 0 || (n < 0 && errno != EINTR)) gone();
        if (n > 0) to = to.subspan(static_cast<std::size_t>(n));
    }
}

OutsideLine::Message OutsideLine::hear(std::size_t most) {
    std::array<std::byte, 5> head{};
    read(head);
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length |= static_cast<std::size_t>(head[1 + i]) << (8 * i);
    if (length > most) throw Error("a function from outside sent a message that is too long");
    Message message{static_cast<char>(head[0]), std::vector<std::byte>(length)};
    read(message.data);
    return message;
}

}  // namespace lightnet
