// Whom the watch server answers, and how: pure functions of what was asked.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lightnet {

/// What `--watch` was given: "", "8080", "127.0.0.1", "127.0.0.1:8080", "[::1]:8080".
struct WatchAddress {
    std::string host = "127.0.0.1";
    std::uint16_t port = 0;  // 0: one that is free
    /// Only this machine can reach it.
    bool stays_here() const;
    friend bool operator==(const WatchAddress&, const WatchAddress&) = default;
};
/// None: it is no address of numbers, which is all that can be listened at.
std::optional<WatchAddress> watch_address(std::string_view text);
/// Of a viewer to be called, which may have a name: "", "10.0.0.7", "desk:14158". Without a port: that one.
std::optional<WatchAddress> viewer_address(std::string_view text, std::uint16_t usual_port);
/// What a run says that is watched: "http://127.0.0.1:40123/#3c1f".
struct WatchUrl {
    WatchAddress at;
    std::string token;  // "": none
    friend bool operator==(const WatchUrl&, const WatchUrl&) = default;
};
std::optional<WatchUrl> watch_url(std::string_view text);
/// For URLs and headers: "[::1]" for "::1".
std::string in_url(const std::string& host);

/// The names by which a browser may call this server: a page of somebody else's whose name was made to point here (DNS
/// rebinding) says another.
bool is_own_host(std::string_view host_header, const WatchAddress& bound, std::string_view machine);
/// A page that was loaded from here, through whatever stands in front: the origin names the host that was called. No
/// origin: no browser.
bool is_own_origin(std::string_view origin, std::string_view host_header);

/// 32 hexadecimal digits that nobody can guess.
std::string new_token();
/// Takes as long for any text.
bool same_token(std::string_view given, std::string_view token);

}  // namespace lightnet
