// Names for contents: equal hashes mean equal bytes.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lightnet {

/// A SHA-256 digest. A value; the default one (all zero) names nothing.
struct Hash {
    std::array<unsigned char, 32> bytes{};
    friend bool operator==(const Hash&, const Hash&) = default;
    friend auto operator<=>(const Hash&, const Hash&) = default;
};

Hash content_hash(std::span<const std::byte> content);
Hash content_hash(std::string_view text);

/// HMAC-SHA-256 (RFC 2104): only who knows `secret` can say it of `text`.
Hash keyed_hash(std::string_view secret, std::string_view text);

/// Hashes content that comes in pieces.
class Hasher {
public:
    Hasher();
    ~Hasher();
    Hasher(Hasher&&) noexcept;
    void add(std::span<const std::byte> piece);
    /// The hash of all pieces, as content_hash() gives it. Once.
    Hash finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// 64 lower-case hexadecimal digits.
std::string to_hex(const Hash& hash);
/// The reverse; nothing if `text` is not exactly 64 hexadecimal digits.
std::optional<Hash> hash_from_hex(std::string_view text);

}  // namespace lightnet

template <>
struct std::hash<lightnet::Hash> {
    std::size_t operator()(const lightnet::Hash& name) const noexcept;
};
