#include "transport/wire/relay_address.hpp"

#include <cstdint>
#include <cstring>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "transport/wire/loopback.hpp"

namespace lightnet {
namespace {

std::string checksum(std::string_view text) {
    const std::uint64_t sum = XXH3_64bits(text.data(), text.size());
    return {reinterpret_cast<const char*>(&sum), sizeof sum};
}

}  // namespace

std::string seal(const RelayAddress& address) {
    const auto size = static_cast<std::uint32_t>(address.host.size());
    std::string text(reinterpret_cast<const char*>(&size), sizeof size);
    text += address.host + address.place;
    return checksum(text) + text;
}

std::optional<RelayAddress> unseal(std::span<const std::byte> frame) {
    constexpr std::size_t sum = sizeof(std::uint64_t), before = sum + sizeof(std::uint32_t);
    if (frame.size() < before) return std::nullopt;
    const std::string_view all(reinterpret_cast<const char*>(frame.data()), frame.size());
    if (checksum(all.substr(sum)) != all.substr(0, sum)) return std::nullopt;
    std::uint32_t size = 0;
    std::memcpy(&size, all.data() + sum, sizeof size);
    if (size > all.size() - before) return std::nullopt;
    return RelayAddress{std::string(all.substr(before, size)), std::string(all.substr(before + size))};
}

// DECISIONS: who-calls-whom
bool calls_directly(std::string_view asker, std::string_view answerer) {
    if (!answerer.starts_with("tcp://")) return false;
    return asker.starts_with("tcp://") && (stays_on_this_machine(asker) || !stays_on_this_machine(answerer));
}

}  // namespace lightnet
