#include "transport/address/listening.hpp"

#include <fcntl.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr auto name_patience = std::chrono::seconds(5);
constexpr int most_waiting = 1024;  // to be let in

[[noreturn]] void fail() { throw std::system_error(errno, std::generic_category()); }

std::uint32_t number_of_card(const std::string& card) {
    std::uint32_t number = 0;
    const auto [end, fault] = std::from_chars(card.data(), card.data() + card.size(), number);
    if (card.empty() || (fault == std::errc{} && end == card.data() + card.size())) return number;
    number = if_nametoindex(card.c_str());
    if (number == 0) throw std::system_error(ENODEV, std::generic_category(), "network card '" + card + "'");
    return number;
}

struct SystemAddress {
    sockaddr_storage bytes{};
    socklen_t size = 0;
    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&bytes); }
};

SystemAddress system_address(const IpAddress& address, std::uint16_t port) {
    SystemAddress made;
    if (address.six) {
        sockaddr_in6 six{};
        six.sin6_family = AF_INET6;
        six.sin6_port = htons(port);
        std::memcpy(&six.sin6_addr, address.bytes.data(), address.bytes.size());
        six.sin6_scope_id = number_of_card(address.card);
        std::memcpy(&made.bytes, &six, made.size = sizeof six);
    } else {
        sockaddr_in four{};
        four.sin_family = AF_INET;
        four.sin_port = htons(port);
        std::memcpy(&four.sin_addr, address.bytes.data(), sizeof four.sin_addr);
        std::memcpy(&made.bytes, &four, made.size = sizeof four);
    }
    return made;
}

// Links are for who has nothing else.
std::vector<IpAddress> without_links(const std::vector<IpAddress>& addresses) {
    std::vector<IpAddress> others;
    std::copy_if(addresses.begin(), addresses.end(), std::back_inserter(others),
                 [](const auto& one) { return !one.is_link_local(); });
    return others.empty() ? addresses : others;
}

}  // namespace

ListeningPort::ListeningPort(const IpAddress& address, std::uint16_t port) {
    const auto at = system_address(address, port);
    descriptor_ = ::socket(at.bytes.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, IPPROTO_TCP);
    if (descriptor_ < 0) fail();
    const int on = 1, off = 0;
    ::setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    // As the system is set up, "::" may mean one family or both.
    if (address.six) ::setsockopt(descriptor_, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
    if (::bind(descriptor_, at.get(), at.size) == 0 && ::listen(descriptor_, most_waiting) == 0) return;
    const int fault = errno;
    ::close(std::exchange(descriptor_, -1));
    errno = fault;
    fail();
}

ListeningPort::~ListeningPort() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

ListeningPort::ListeningPort(ListeningPort&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

int ListeningPort::give_away() { return std::exchange(descriptor_, -1); }

std::uint16_t ListeningPort::port() const {
    sockaddr_storage at{};
    socklen_t size = sizeof at;
    if (::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&at), &size) != 0) fail();
    sockaddr_in four{};
    sockaddr_in6 six{};
    if (at.ss_family == AF_INET6) return ntohs((std::memcpy(&six, &at, sizeof six), six.sin6_port));
    return ntohs((std::memcpy(&four, &at, sizeof four), four.sin_port));
}

std::vector<IpAddress> listening_addresses(const std::string& host, Resolver& names) {
    if (const auto address = ip_address(host)) return {*address};
    if (host == "*") return {*ip_address("::"), *ip_address("0.0.0.0")};
    std::string no_cards;
    if (const auto of_card = addresses_of_card(host, no_cards); !of_card.empty()) return without_links(of_card);
    const auto found = names.wait_for(host, name_patience);
    if (found.state == Whereabout::State::found) return found.addresses;
    throw Error("can't listen at '" + host + "'",
                found.why + (no_cards.empty() ? ", and no network card" : "; " + no_cards));
}

}  // namespace lightnet
