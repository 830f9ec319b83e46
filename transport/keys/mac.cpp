#include "transport/keys/mac.hpp"

#include <sodium.h>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

static_assert(crypto_auth_KEYBYTES == 32);

const unsigned char* bytes_in(std::string_view text) { return reinterpret_cast<const unsigned char*>(text.data()); }

}  // namespace

Mac::Mac() {
    if (sodium_init() < 0) throw Error("no random numbers are to be had for keys");
    crypto_auth_keygen(key_.data());
}

std::string Mac::tag(std::string_view text) const {
    std::string tag(crypto_auth_BYTES, '\0');
    crypto_auth(reinterpret_cast<unsigned char*>(tag.data()), bytes_in(text), text.size(), key_.data());
    return tag;
}

bool Mac::fits(std::string_view text, std::string_view tag) const {
    return tag.size() == crypto_auth_BYTES &&
           crypto_auth_verify(bytes_in(tag), bytes_in(text), text.size(), key_.data()) == 0;
}

}  // namespace lightnet
