#include "tools/http/watch_rules.hpp"

#include <charconv>
#include <random>

#include "core/base/ip_address.hpp"
#include "transport/wire/loopback.hpp"

namespace lightnet {
namespace {

bool is_number(const std::string& host) { return ip_address(host).has_value(); }

std::optional<std::uint16_t> port_of(std::string_view text) {
    std::uint16_t port = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), port);
    if (fault != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return port;
}

std::string without_brackets(std::string_view host) {
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
    return std::string(host);
}

// "host:port"; the port may be missing.
struct HostAndPort {
    std::string_view host;
    std::optional<std::string_view> port;
};
HostAndPort cut(std::string_view text) {
    const auto colon = text.rfind(':');
    const bool within_brackets = text.find(']', colon == text.npos ? 0 : colon) != text.npos;
    if (colon == text.npos || within_brackets) return {text, std::nullopt};
    return {text.substr(0, colon), text.substr(colon + 1)};
}

}  // namespace

bool WatchAddress::stays_here() const { return stays_on_this_machine("tcp://" + in_url(host) + ":0"); }

std::optional<WatchAddress> watch_address(std::string_view text) {
    WatchAddress address;
    if (text.empty()) return address;
    if (const auto port = port_of(text)) {
        address.port = *port;
        return address;
    }
    const bool bare = ip_address(text).has_value() && text.front() != '[';
    const auto [host, port] = bare ? HostAndPort{text, std::nullopt} : cut(text);
    const auto number = host == own_machine ? ip_address(address.host) : ip_address(host);
    if (!number) return std::nullopt;
    address.host = number->text();
    if (!port) return address;
    const auto number_of_port = port_of(*port);
    if (!number_of_port) return std::nullopt;
    address.port = *number_of_port;
    return address;
}

std::optional<WatchAddress> viewer_address(std::string_view text, std::uint16_t usual_port) {
    auto address = watch_address(text);
    if (!address) {
        const auto [host, port] = cut(text);
        const auto number = port ? port_of(*port) : std::optional<std::uint16_t>(0);
        constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._";
        // A name that a machine may have, and no address of numbers that was mistyped.
        if (!number || host.empty() || host.find_first_not_of(letters) != host.npos ||
            host.find_first_not_of("0123456789.") == host.npos)
            return std::nullopt;
        address = WatchAddress{std::string(host), *number};
    }
    if (address->port == 0) address->port = usual_port;
    return address;
}

std::optional<WatchUrl> watch_url(std::string_view text) {
    constexpr std::string_view scheme = "http://";
    if (!text.starts_with(scheme)) return std::nullopt;
    text.remove_prefix(scheme.size());
    const auto place = text.substr(0, text.find_first_of("/#?"));
    const auto mark = text.find('#');
    const auto at = viewer_address(place, 0);
    if (!at || at->port == 0 || place.find(':') == place.npos) return std::nullopt;
    return WatchUrl{*at, mark == text.npos ? std::string() : std::string(text.substr(mark + 1))};
}

std::string in_url(const std::string& host) { return before_port(host); }

bool is_own_host(std::string_view host_header, const WatchAddress& bound, std::string_view machine) {
    const auto [name, port] = cut(host_header);
    if (!port || port_of(*port) != bound.port) return false;
    const auto host = without_brackets(name);
    if (host == bound.host) return true;
    if (bound.stays_here()) return host == "localhost" || host == "127.0.0.1" || host == "::1";
    return is_number(host) || host == "localhost" || host == machine;  // an address can't be made to point
}

bool is_own_origin(std::string_view origin, std::string_view host_header) {
    if (origin.empty()) return true;
    for (const std::string_view scheme : {"http://", "https://"})
        if (origin.starts_with(scheme)) return origin.substr(scheme.size()) == host_header;
    return false;
}

std::string new_token() {
    std::random_device device;
    constexpr std::string_view digits = "0123456789abcdef";
    std::string token;
    for (int i = 0; i < 32; ++i) token += digits[device() % digits.size()];
    return token;
}

bool same_token(std::string_view given, std::string_view token) {
    unsigned differs = given.size() != token.size();
    for (std::size_t i = 0; i < token.size(); ++i)
        differs |= static_cast<unsigned char>(token[i]) ^ static_cast<unsigned char>(i < given.size() ? given[i] : 0);
    return differs == 0 && !token.empty();
}

}  // namespace lightnet
