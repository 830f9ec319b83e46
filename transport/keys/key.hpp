// Keys: by which launchers and hosts know each other.
#pragma once

#include <array>
#include <chrono>
#include <compare>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lightnet {

/// What one tells others: everybody may know it. A value.
struct PublicKey {
    static constexpr std::size_t size = 32;

    std::array<unsigned char, size> bytes{};

    /// 48 letters, digits, '-' and '_', the last of which tell whether one of them was mistyped.
    std::string text() const;
    /// "3f2a-91bc-77de-0012": short enough to be compared by people, read aloud for instance.
    std::string fingerprint() const;
    /// None: it is no such text, see mistake_in_key().
    static std::optional<PublicKey> from(std::string_view text);
    friend auto operator<=>(const PublicKey&, const PublicKey&) = default;
};

/// What is wrong with a text that should be a public key, for who wrote it; "": nothing.
std::string mistake_in_key(std::string_view text);

/// Both halves (Curve25519). Who knows the secret one can be taken for its owner. A value.
struct KeyPair {
    PublicKey open;
    std::array<unsigned char, PublicKey::size> secret{};

    /// That nobody else has.
    static KeyPair random();
    /// A text that is no public key, and can't be taken for one.
    std::string secret_text() const;
    static std::optional<KeyPair> from_secret(std::string_view text);
};

/// ZeroMQ never changes the keys of a connection, so whoever learns them reads all of it; no connection lasts longer.
inline constexpr std::chrono::hours usual_line_life{4};

/// The keys of a connection: ours, and whom we expect at the other end.
struct LineKeys {
    KeyPair own;
    PublicKey theirs;
};

}  // namespace lightnet
