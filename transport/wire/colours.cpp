#include "transport/wire/colours.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "transport/wire/body.hpp"
#include "transport/wire/packet.hpp"

namespace lightnet::packet {
namespace {

// DECISIONS: black-left-out
using Lit = std::vector<std::uint8_t>;  // a bit per colour, the lowest first

constexpr std::size_t bits = 8;  // of an entry

// By its bits: a zero with a sign is a colour that must arrive with it.
bool is_lit(const Rgb& colour) {
    const auto parts = std::bit_cast<std::array<std::uint32_t, 3>>(colour);
    return (parts[0] | parts[1] | parts[2]) != 0;
}

Lit lit_of(std::span<const Rgb> colours) {
    Lit lit((colours.size() + bits - 1) / bits);
    for (std::size_t i = 0; i < colours.size(); ++i)
        lit[i / bits] = static_cast<std::uint8_t>(lit[i / bits] | is_lit(colours[i]) << i % bits);
    return lit;
}

std::size_t count_of(std::span<const std::uint8_t> lit) {
    std::size_t count = 0;
    for (const auto entry : lit) count += static_cast<std::size_t>(std::popcount(entry));
    return count;
}

void pack_lit(std::span<const Rgb> colours, const Lit& lit, std::size_t count, std::vector<std::byte>& body) {
    BodyWriter writer(body, 2);
    writer.bytes("lit", std::as_bytes(std::span(lit)));
    auto* to = writer.room("rgb", count * sizeof(Rgb)).data();
    for (std::size_t i = 0; i < colours.size(); ++i) {
        if (!(lit[i / bits] >> i % bits & 1)) continue;
        std::memcpy(to, &colours[i], sizeof(Rgb));
        to += sizeof(Rgb);
    }
}

std::optional<std::vector<Rgb>> unpack_lit(std::size_t count, std::span<const std::byte> rgb,
                                           std::span<const std::byte> lit_bytes) {
    if (count > most_bytes / sizeof(Rgb) || lit_bytes.size() != (count + bits - 1) / bits) return std::nullopt;
    Lit lit(lit_bytes.size());
    if (!lit.empty()) std::memcpy(lit.data(), lit_bytes.data(), lit.size());
    if (count % bits && lit.back() >> count % bits) return std::nullopt;
    if (rgb.size() != count_of(lit) * sizeof(Rgb)) return std::nullopt;
    std::vector<Rgb> colours(count);
    const auto* from = rgb.data();
    for (std::size_t i = 0; i < count; ++i) {
        if (!(lit[i / bits] >> i % bits & 1)) continue;
        std::memcpy(&colours[i], from, sizeof(Rgb));
        from += sizeof(Rgb);
    }
    return colours;
}

}  // namespace

void pack_colours(std::span<const Rgb> colours, std::vector<std::byte>& body) {
    constexpr std::size_t names = 32;
    const Lit lit = lit_of(colours);
    const std::size_t count = count_of(lit), without_black = lit.size() + count * sizeof(Rgb);
    if (without_black < colours.size_bytes() * 7 / 8) {
        body.reserve(without_black + names);
        return pack_lit(colours, lit, count, body);
    }
    body.reserve(colours.size_bytes() + names);
    BodyWriter(body, 1).bytes("rgb", std::as_bytes(colours));
}

std::optional<std::vector<Rgb>> unpack_colours(std::size_t count, std::span<const std::byte> body) {
    const BodyReader map(body);
    const auto rgb = map.good() ? map.bytes("rgb") : std::nullopt;
    if (!rgb) return std::nullopt;
    if (const auto lit = map.bytes("lit")) return unpack_lit(count, *rgb, *lit);
    if (rgb->size() != count * sizeof(Rgb)) return std::nullopt;
    std::vector<Rgb> colours(count);
    if (count) std::memcpy(colours.data(), rgb->data(), rgb->size());
    return colours;
}

}  // namespace lightnet::packet
