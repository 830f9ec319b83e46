// Addresses at which doors listen.
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/ip_address.hpp"
#include "transport/address/listening.hpp"
#include "transport/zmq/socket.hpp"

namespace lightnet {
namespace {

constexpr int most_tries = 16;  // to find a port that is free at all addresses of a name

struct OpenPort {
    IpAddress address;
    ListeningPort port;
};

std::string why_not(const std::error_code& fault) {
    const auto hint = [&]() -> std::string {
        switch (fault.value()) {
            case EADDRNOTAVAIL:
                return "no network card of this machine has that address";
            case EADDRINUSE:
                return "choose another port, or end who has it";
            case EACCES:
                return "ports below 1024 take rights";
            case EAFNOSUPPORT:
                return "this machine, or the service, has no addresses of that family";
            case ENODEV:
                return "there is no such network card";
            case EINVAL:
                return "an address of fe80::/10 takes its network card, as in [fe80::1%eth0]";
            default:
                return {};
        }
    }();
    return fault.message() + (hint.empty() ? "" : " (" + hint + ")");
}

bool may_be_left_out(const std::error_code& fault) {
    return fault.value() == EADDRNOTAVAIL || fault.value() == EAFNOSUPPORT;
}

// At all addresses that this machine has; "*" means one that is for all. None: the port that the system chose for the
// first is taken at another. Throws std::system_error of the first that can't be had when there is none.
std::optional<std::vector<OpenPort>> open_all(const std::vector<IpAddress>& addresses, std::uint16_t port, bool one) {
    std::vector<OpenPort> opened;
    std::optional<std::system_error> fault;
    for (const auto& address : addresses) try {
            if (one && !opened.empty()) break;
            const auto number = opened.empty() ? port : opened.front().port.port();
            opened.push_back({address, ListeningPort(address, number)});
        } catch (const std::system_error& error) {
            if (!fault) fault = error;
            if (port == 0 && !opened.empty() && error.code().value() == EADDRINUSE) return std::nullopt;
            if (!may_be_left_out(error.code())) throw;
        }
    if (opened.empty() && fault) throw *fault;
    return opened;
}

std::vector<OpenPort> open_somewhere(const std::vector<IpAddress>& addresses, std::uint16_t port, bool one) {
    for (int i = 0; i < most_tries; ++i)
        if (auto opened = open_all(addresses, port, one)) return std::move(*opened);
    throw std::system_error(EADDRINUSE, std::generic_category());
}

std::uint16_t wanted_port(const std::string& text) {
    std::uint16_t port = 0;
    if (text != "*") std::from_chars(text.data(), text.data() + text.size(), port);
    return port;
}

}  // namespace

void listen(Socket& door, const SocketContext& context, const std::string& endpoint) try {
    const auto parts = tcp_endpoint(endpoint);
    if (!parts) return door.bind(endpoint);
    const auto addresses = listening_addresses(parts->host, context.names());
    auto opened = open_somewhere(addresses, wanted_port(parts->port), parts->host == "*");
    // The first one last: a socket is known by where it was bound last.
    for (auto at = opened.rbegin(); at != opened.rend(); ++at) {
        const TcpEndpoint here{at->address.text(), std::to_string(at->port.port())};
        door.bind(std::move(at->port), here.text());
    }
} catch (const SocketError& error) {
    throw Error(endpoint, std::string("can't listen there: ") + error.what());
} catch (const std::system_error& error) {
    throw Error(endpoint, "can't listen there: " + why_not(error.code()));
}

}  // namespace lightnet
