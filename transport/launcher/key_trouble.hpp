// Trouble with keys, in words for who can mend it.
#pragma once

#include <optional>
#include <string>

#include "transport/keys/key.hpp"
#include "transport/lines/host_transport.hpp"

namespace lightnet {

/// Why a host and we don't come together, by how a handshake ended, and what would be right. `keys`: by which it was
/// called. It closes many a connection without a word, so some of it is a guess, and is said to be one.
struct KeyTrouble {
    std::string what;    // "wants a key", behind its name
    std::string advice;  // what is to be done
};
KeyTrouble key_trouble(const std::string& endpoint, const std::optional<LineKeys>& keys, Handshake seen);

/// A handshake that was abandoned so often in a row tells of keys: a line may be cut in the middle of one.
inline constexpr int abandoned_tells_of_keys = 3;

}  // namespace lightnet
