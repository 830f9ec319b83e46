#include "core/base/name_id.hpp"

#include <bit>
#include <cstddef>

namespace lightnet {
namespace {

std::uint32_t byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

std::uint32_t mixed(std::uint32_t part) { return std::rotl(part * 0xcc9e2d51u, 15) * 0x1b873593u; }

}  // namespace

std::uint32_t murmur3(std::string_view text, std::uint32_t seed) {
    std::uint32_t hash = seed;
    const std::size_t whole = text.size() / 4 * 4;
    for (std::size_t i = 0; i < whole; i += 4) {
        hash ^= mixed(byte_at(text, i) | byte_at(text, i + 1) << 8 | byte_at(text, i + 2) << 16 |
                      byte_at(text, i + 3) << 24);
        hash = std::rotl(hash, 13) * 5 + 0xe6546b64u;
    }
    std::uint32_t rest = 0;
    for (std::size_t i = text.size(); i-- > whole;) rest = rest << 8 | byte_at(text, i);
    hash ^= mixed(rest) ^ static_cast<std::uint32_t>(text.size());
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

float name_id(std::string_view name) {
    std::uint32_t bits = murmur3(name);
    const std::uint32_t exponent = bits >> 23 & 0xff;
    if (exponent == 0 || exponent == 0xff) bits ^= 1u << 23;
    return std::bit_cast<float>(bits);
}

}  // namespace lightnet
