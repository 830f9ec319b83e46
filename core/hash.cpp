#include "core/hash.hpp"

#include <sodium.h>

#include <cstring>

namespace lightnet {
namespace {

int digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

// libsodium's generic hash needs no sodium_init(): that only chooses faster code and seeds the random numbers.
Hash content_hash(std::span<const std::byte> content) {
    Hash hash;
    crypto_generichash(hash.bytes.data(), hash.bytes.size(), reinterpret_cast<const unsigned char*>(content.data()),
                       content.size(), nullptr, 0);
    return hash;
}

Hash content_hash(std::string_view text) { return content_hash(std::as_bytes(std::span{text})); }

struct Hasher::State {
    crypto_generichash_state sodium;
};

Hasher::Hasher() : state_(std::make_unique<State>()) {
    crypto_generichash_init(&state_->sodium, nullptr, 0, sizeof(Hash::bytes));
}

Hasher::~Hasher() = default;
Hasher::Hasher(Hasher&&) noexcept = default;

void Hasher::add(std::span<const std::byte> piece) {
    crypto_generichash_update(&state_->sodium, reinterpret_cast<const unsigned char*>(piece.data()), piece.size());
}

Hash Hasher::finish() {
    Hash hash;
    crypto_generichash_final(&state_->sodium, hash.bytes.data(), hash.bytes.size());
    return hash;
}

std::string to_hex(const Hash& hash) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : hash.bytes) {
        text += digits[byte >> 4];
        text += digits[byte & 15];
    }
    return text;
}

std::optional<Hash> hash_from_hex(std::string_view text) {
    Hash hash;
    if (text.size() != 2 * hash.bytes.size()) return std::nullopt;
    for (std::size_t i = 0; i < hash.bytes.size(); ++i) {
        const int high = digit(text[2 * i]), low = digit(text[2 * i + 1]);
        if (high < 0 || low < 0) return std::nullopt;
        hash.bytes[i] = static_cast<unsigned char>(high * 16 + low);
    }
    return hash;
}

}  // namespace lightnet

std::size_t std::hash<lightnet::Hash>::operator()(const lightnet::Hash& name) const noexcept {
    std::size_t start = 0;
    std::memcpy(&start, name.bytes.data(), sizeof start);
    return start;
}
