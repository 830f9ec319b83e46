// Addresses of numbers, of both families, as people write them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace lightnet {

/// A value. One of the old family that wears the new one's clothes ("::ffff:10.0.0.1") is taken for what it is.
struct IpAddress {
    bool six = false;
    std::array<unsigned char, 16> bytes{};  // the first four, where it isn't `six`
    std::string card{};                     // by which it is reached ("fe80::1%eth0"), name or number; "": by any
    /// Nobody but this machine reaches it.
    bool is_loopback() const;
    /// "0.0.0.0", "::": whatever addresses a machine has.
    bool is_unspecified() const;
    /// Means something only beside the name of a card.
    bool is_link_local() const;
    std::string text() const;
    friend bool operator==(const IpAddress&, const IpAddress&) = default;
};

/// In brackets or not; none: it's a name, or nothing.
std::optional<IpAddress> ip_address(std::string_view text);

/// Looks like the number of a machine, and isn't: "999.1.1.1", "fe80:::1". Nobody can be called so.
bool is_mistaken_number(std::string_view host);

/// Means this machine wherever it is said, and needs no name server (RFC 6761).
inline constexpr std::string_view own_machine = "localhost";

/// "tcp://host:port" in its parts. A value.
struct TcpEndpoint {
    std::string host;  // without brackets
    std::string port;  // digits, or "*"
    std::string text() const;
    friend bool operator==(const TcpEndpoint&, const TcpEndpoint&) = default;
};

/// None: it isn't one. A host with colons stands in brackets.
std::optional<TcpEndpoint> tcp_endpoint(std::string_view text);

/// "[::1]" for "::1": where a port may stand behind it.
std::string before_port(const std::string& host);

/// One text for each endpoint: addresses as machines write them, names in small letters. What is no endpoint stays as
/// it is.
std::string usual_text(const std::string& endpoint);

}  // namespace lightnet
