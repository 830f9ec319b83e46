// The address of an ask that leaves a process, by which the reply finds back, and whether it needs a relay.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lightnet {

/// Whose ask is on its way to another host, as it stands in a frame before the packet. On the way to the launcher,
/// which passes on what hosts can't send to each other, `host` names the answerer; else the asker.
struct RelayAddress {
    std::string host;   // as in PlaceAt
    std::string place;  // how the gateway of the asker calls the place that asked
    std::string tag{};  // of the launcher, to whoever answers through it, and back: see Relays
    friend bool operator==(const RelayAddress&, const RelayAddress&) = default;
};

/// With a checksum: a reply that reached another asker by accident could be taken for its own.
std::string seal(const RelayAddress& address);
/// None: damaged.
std::optional<RelayAddress> unseal(std::span<const std::byte> frame);

/// Can `asker` connect to the door of `answerer`? Hosts that dialled in let nobody in and may reach nobody
/// but the launcher; loopback addresses mean another machine elsewhere.
bool calls_directly(std::string_view asker, std::string_view answerer);

}  // namespace lightnet
