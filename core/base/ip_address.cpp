#include "core/base/ip_address.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cctype>

namespace lightnet {
namespace {

constexpr std::size_t four_bytes = 4;
constexpr std::array<unsigned char, 12> clothes{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};  // of the old family

IpAddress undressed(const IpAddress& address) {
    if (!address.six || !std::equal(clothes.begin(), clothes.end(), address.bytes.begin())) return address;
    IpAddress plain;
    std::copy(address.bytes.begin() + clothes.size(), address.bytes.end(), plain.bytes.begin());
    return plain;
}

std::string_view without_brackets(std::string_view text) {
    const bool has = text.size() > 2 && text.front() == '[' && text.back() == ']';
    return has ? text.substr(1, text.size() - 2) : text;
}

bool is_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

bool IpAddress::is_loopback() const {
    constexpr unsigned char loopback = 127;
    if (!six) return bytes[0] == loopback;
    return bytes.back() == 1 && std::all_of(bytes.begin(), bytes.end() - 1, [](auto byte) { return byte == 0; });
}

bool IpAddress::is_unspecified() const {
    return std::all_of(bytes.begin(), bytes.end(), [](auto byte) { return byte == 0; });
}

bool IpAddress::is_link_local() const {
    return six ? bytes[0] == 0xfe && (bytes[1] & 0xc0) == 0x80 : bytes[0] == 169 && bytes[1] == 254;
}

std::string IpAddress::text() const {
    std::array<char, INET6_ADDRSTRLEN> room{};
    inet_ntop(six ? AF_INET6 : AF_INET, bytes.data(), room.data(), room.size());
    return std::string(room.data()) + (card.empty() ? "" : "%" + card);
}

std::optional<IpAddress> ip_address(std::string_view text) {
    const std::string all(without_brackets(text));
    IpAddress address;
    if (all.size() == text.size() && inet_pton(AF_INET, all.c_str(), address.bytes.data()) == 1) return address;
    const auto percent = all.find('%');
    address.six = true;
    if (percent != std::string::npos) address.card = all.substr(percent + 1);
    const bool card_is_one = percent == std::string::npos ||
                             (!address.card.empty() && address.card.find_first_of(" \t/%[]") == std::string::npos);
    if (!card_is_one || inet_pton(AF_INET6, all.substr(0, percent).c_str(), address.bytes.data()) != 1)
        return std::nullopt;
    return undressed(address);
}

bool is_mistaken_number(std::string_view host) {
    if (ip_address(host)) return false;
    if (host.find(':') != std::string_view::npos) return true;
    return std::count(host.begin(), host.end(), '.') == four_bytes - 1 &&
           host.find_first_not_of("0123456789.") == std::string_view::npos;
}

std::string before_port(const std::string& host) {
    return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

std::string TcpEndpoint::text() const { return "tcp://" + before_port(host) + ":" + port; }

std::optional<TcpEndpoint> tcp_endpoint(std::string_view text) {
    constexpr std::string_view scheme = "tcp://";
    if (!text.starts_with(scheme)) return std::nullopt;
    text.remove_prefix(scheme.size());
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos || colon == 0) return std::nullopt;
    const auto written = text.substr(0, colon), port = text.substr(colon + 1);
    const auto host = without_brackets(written);
    const bool bracketed = host.size() != written.size();
    if (bracketed != (host.find(':') != std::string_view::npos)) return std::nullopt;
    if (host.find_first_of(" \t/[];") != std::string_view::npos || (port != "*" && !is_digits(port)))
        return std::nullopt;
    return TcpEndpoint{std::string(host), std::string(port)};
}

std::string usual_text(const std::string& endpoint) {
    auto parts = tcp_endpoint(endpoint);
    if (!parts) return endpoint;
    if (const auto address = ip_address(parts->host))
        parts->host = address->text();
    else
        std::transform(parts->host.begin(), parts->host.end(), parts->host.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return parts->text();
}

}  // namespace lightnet
