// Asks between hosts that can't call each other: they go through the launcher.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lightnet {

/// Whose ask is on its way through the launcher, as it stands in a frame before the packet. On the way to the launcher
/// `host` names the answerer, from there on the asker.
struct RelayAddress {
    std::string host;   // as in PlaceAt
    std::string place;  // how the door of the asker calls the place that asked
    friend bool operator==(const RelayAddress&, const RelayAddress&) = default;
};

/// With a checksum: a reply that reached another asker by accident could be taken for its own.
std::string seal(const RelayAddress& address);
/// None: damaged.
std::optional<RelayAddress> unseal(std::span<const std::byte> frame);

/// Can places of `asker` connect to the door of `answerer`? Hosts that dialled in let nobody in and may reach nobody
/// but the launcher; loopback addresses mean another machine elsewhere.
bool calls_directly(std::string_view asker, std::string_view answerer);

/// Where the places of a run find the door of their own process.
std::string relay_endpoint(std::uint64_t run);

}  // namespace lightnet
