#include "core/base/hash.hpp"

#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <cstring>
#include <memory>
#include <new>

namespace lightnet {
namespace {

int digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

Hash content_hash(std::span<const std::byte> content) {
    Hasher hasher;
    hasher.add(content);
    return hasher.finish();
}

Hash content_hash(std::string_view text) { return content_hash(std::as_bytes(std::span{text})); }

Hash keyed_hash(std::string_view secret, std::string_view text) {
    Hash hash;
    unsigned size = 0;
    if (!HMAC(EVP_sha256(), secret.data(), static_cast<int>(secret.size()),
              reinterpret_cast<const unsigned char*>(text.data()), text.size(), hash.bytes.data(), &size))
        throw std::bad_alloc();
    return hash;
}

struct Hasher::State {
    // DECISIONS: content-hash
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

// The library fails only for want of memory.
Hasher::Hasher() : state_(std::make_unique<State>()) {
    if (EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr) != 1) throw std::bad_alloc();
}

Hasher::~Hasher() = default;
Hasher::Hasher(Hasher&&) noexcept = default;

void Hasher::add(std::span<const std::byte> piece) {
    if (EVP_DigestUpdate(state_->context.get(), piece.data(), piece.size()) != 1) throw std::bad_alloc();
}

Hash Hasher::finish() {
    Hash hash;
    if (EVP_DigestFinal_ex(state_->context.get(), hash.bytes.data(), nullptr) != 1) throw std::bad_alloc();
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
