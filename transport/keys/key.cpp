#include "transport/keys/key.hpp"

#include <sodium.h>

#include <cstring>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr std::size_t checksum_size = 4, written_size = PublicKey::size + checksum_size;
constexpr std::size_t letters = written_size / 3 * 4;
constexpr auto alphabet = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
constexpr std::string_view before_secret = "secret-";

using Bytes32 = std::array<unsigned char, PublicKey::size>;
using Written = std::array<unsigned char, written_size>;

void start_library() {
    if (sodium_init() < 0) throw Error("no random numbers are to be had for keys");
}

// `kind`: what the bytes are, so that one kind is not taken for another.
std::array<unsigned char, checksum_size> checksum(const Bytes32& bytes, std::string_view kind) {
    std::array<unsigned char, crypto_generichash_BYTES> hash{};
    crypto_generichash(hash.data(), hash.size(), bytes.data(), bytes.size(),
                       reinterpret_cast<const unsigned char*>(kind.data()), kind.size());
    std::array<unsigned char, checksum_size> first{};
    std::memcpy(first.data(), hash.data(), first.size());
    return first;
}

// The library wants keys of 16 bytes at least.
constexpr std::string_view open_kind = "a public key of lightnet", secret_kind = "a secret key of lightnet";

std::string text_of_key(const Bytes32& bytes, std::string_view kind) {
    Written all{};
    const auto sum = checksum(bytes, kind);
    std::memcpy(all.data(), bytes.data(), bytes.size());
    std::memcpy(all.data() + bytes.size(), sum.data(), sum.size());
    std::array<char, letters + 1> text{};
    sodium_bin2base64(text.data(), text.size(), all.data(), all.size(), alphabet);
    return text.data();
}

std::optional<Bytes32> key_in(std::string_view text, std::string_view kind) {
    Written all{};
    std::size_t size = 0;
    if (text.size() != letters ||
        sodium_base642bin(all.data(), all.size(), text.data(), text.size(), nullptr, &size, nullptr, alphabet) != 0 ||
        size != all.size())
        return std::nullopt;
    Bytes32 bytes{};
    std::memcpy(bytes.data(), all.data(), bytes.size());
    if (std::memcmp(checksum(bytes, kind).data(), all.data() + bytes.size(), checksum_size) != 0) return std::nullopt;
    return bytes;
}

PublicKey open_half(const Bytes32& secret) {
    PublicKey open;
    if (crypto_scalarmult_base(open.bytes.data(), secret.data()) != 0) throw Error("a secret key that is none");
    return open;
}

}  // namespace

std::string PublicKey::text() const { return text_of_key(bytes, open_kind); }

std::string PublicKey::fingerprint() const {
    constexpr char digits[] = "0123456789abcdef";
    constexpr std::size_t shown = 8;
    std::array<unsigned char, crypto_generichash_BYTES> hash{};
    crypto_generichash(hash.data(), hash.size(), bytes.data(), bytes.size(), nullptr, 0);
    std::string text;
    for (std::size_t i = 0; i < shown; ++i) {
        if (i > 0 && i % 2 == 0) text += '-';
        text += digits[hash[i] >> 4];
        text += digits[hash[i] & 15];
    }
    return text;
}

std::optional<PublicKey> PublicKey::from(std::string_view text) {
    const auto bytes = key_in(text, open_kind);
    return bytes ? std::optional(PublicKey{*bytes}) : std::nullopt;
}

std::string mistake_in_key(std::string_view text) {
    if (PublicKey::from(text)) return {};
    if (text.starts_with(before_secret))
        return "this is a secret key, which nobody else may see; the public one is wanted";
    if (text.size() != letters)
        return "a key has " + std::to_string(letters) + " letters, not " + std::to_string(text.size()) +
               " (lightnet key and lightnetd --print-key show it)";
    return "this key is mistyped: its last letters don't fit to the others";
}

KeyPair KeyPair::random() {
    start_library();
    KeyPair pair;
    crypto_box_keypair(pair.open.bytes.data(), pair.secret.data());
    return pair;
}

std::string KeyPair::secret_text() const { return std::string(before_secret) + text_of_key(secret, secret_kind); }

std::optional<KeyPair> KeyPair::from_secret(std::string_view text) {
    if (!text.starts_with(before_secret)) return std::nullopt;
    const auto secret = key_in(text.substr(before_secret.size()), secret_kind);
    if (!secret) return std::nullopt;
    return KeyPair{open_half(*secret), *secret};
}

}  // namespace lightnet
