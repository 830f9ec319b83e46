#include "transport/wire/relay_address.hpp"

#include <array>
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
    std::string text;
    for (const auto* part : {&address.host, &address.place}) {
        const auto size = static_cast<std::uint32_t>(part->size());
        text.append(reinterpret_cast<const char*>(&size), sizeof size);
    }
    text += address.host + address.place + address.tag;
    return checksum(text) + text;
}

std::optional<RelayAddress> unseal(std::span<const std::byte> frame) {
    constexpr std::size_t sum = sizeof(std::uint64_t);
    std::array<std::uint32_t, 2> sizes{};
    constexpr std::size_t before = sum + sizeof sizes;
    if (frame.size() < before) return std::nullopt;
    std::string_view all(reinterpret_cast<const char*>(frame.data()), frame.size());
    if (checksum(all.substr(sum)) != all.substr(0, sum)) return std::nullopt;
    std::memcpy(sizes.data(), all.data() + sum, sizeof sizes);
    all.remove_prefix(before);
    if (std::size_t{sizes[0]} + sizes[1] > all.size()) return std::nullopt;
    return RelayAddress{std::string(all.substr(0, sizes[0])), std::string(all.substr(sizes[0], sizes[1])),
                        std::string(all.substr(sizes[0] + sizes[1]))};
}

// DECISIONS: who-calls-whom
bool calls_directly(std::string_view asker, std::string_view answerer) {
    if (!answerer.starts_with("tcp://")) return false;
    return asker.starts_with("tcp://") && (stays_on_this_machine(asker) || !stays_on_this_machine(answerer));
}

}  // namespace lightnet
