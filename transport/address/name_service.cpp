#include "transport/address/name_service.hpp"

#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

namespace lightnet {
namespace {

std::string name_of_card(unsigned number) {
    std::array<char, IF_NAMESIZE> room{};
    const char* name = number ? if_indextoname(number, room.data()) : "";
    return name ? name : std::to_string(number);
}

std::optional<IpAddress> address_in(const sockaddr* at) {
    if (!at) return std::nullopt;
    IpAddress address;
    if (at->sa_family == AF_INET) {
        sockaddr_in four{};
        std::memcpy(&four, at, sizeof four);
        std::memcpy(address.bytes.data(), &four.sin_addr, sizeof four.sin_addr);
        return address;
    }
    if (at->sa_family != AF_INET6) return std::nullopt;
    sockaddr_in6 six{};
    std::memcpy(&six, at, sizeof six);
    address.six = true;
    std::memcpy(address.bytes.data(), &six.sin6_addr, address.bytes.size());
    address.card = name_of_card(six.sin6_scope_id);
    return ip_address(address.text());
}

void add_once(std::vector<IpAddress>& all, const std::optional<IpAddress>& one) {
    if (one && std::find(all.begin(), all.end(), *one) == all.end()) all.push_back(*one);
}

Whereabout not_found(const std::string& name, int fault) {
    // EAI_NODATA, EAI_ADDRFAMILY: there is such a name, without an address.
    const bool gone = fault == EAI_NONAME || fault == EAI_NODATA || fault == EAI_ADDRFAMILY;
    if (gone) return {Whereabout::State::gone, {}, "no host is called '" + name + "'"};
    const std::string why = fault == EAI_SYSTEM ? std::strerror(errno) : gai_strerror(fault);
    return {Whereabout::State::unknown, {}, "nobody says where '" + name + "' is: " + why};
}

class SystemNames final : public NameService {
public:
    Whereabout look_up(const std::string& name) const override {
        addrinfo wanted{};
        wanted.ai_family = AF_UNSPEC;
        wanted.ai_socktype = SOCK_STREAM;
        addrinfo* list = nullptr;
        if (const int fault = getaddrinfo(name.c_str(), nullptr, &wanted, &list)) return not_found(name, fault);
        Whereabout found{Whereabout::State::found, {}, {}};
        for (const auto* one = list; one; one = one->ai_next) add_once(found.addresses, address_in(one->ai_addr));
        freeaddrinfo(list);
        found.addresses = in_turns(found.addresses);
        return found.addresses.empty() ? not_found(name, EAI_NODATA) : found;
    }
};

}  // namespace

std::shared_ptr<const NameService> system_names() { return std::make_shared<SystemNames>(); }

std::vector<IpAddress> in_turns(const std::vector<IpAddress>& addresses) {
    std::vector<IpAddress> first, second, all;
    for (const auto& one : addresses) (one.six == addresses.front().six ? first : second).push_back(one);
    for (std::size_t i = 0; i < std::max(first.size(), second.size()); ++i) {
        if (i < first.size()) all.push_back(first[i]);
        if (i < second.size()) all.push_back(second[i]);
    }
    return all;
}

std::string missing_card(const IpAddress& address) {
    const bool named = address.card.find_first_not_of("0123456789") != std::string::npos;
    return named && if_nametoindex(address.card.c_str()) == 0 ? "there is no network card '" + address.card + "' here"
                                                              : std::string();
}

std::vector<IpAddress> addresses_of_card(const std::string& card, std::string& why) {
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) {
        why = std::string("network cards can't be looked at (") + std::strerror(errno) +
              "; a service takes AF_NETLINK for that, in RestrictAddressFamilies)";
        return {};
    }
    std::vector<IpAddress> found;
    for (const auto* one = list; one; one = one->ifa_next)
        if (card == one->ifa_name) add_once(found, address_in(one->ifa_addr));
    freeifaddrs(list);
    return found;
}

}  // namespace lightnet
