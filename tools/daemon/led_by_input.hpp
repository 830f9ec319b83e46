// A daemon that somebody holds by its standard input: by ssh, say.
#pragma once

#include <optional>
#include <thread>

#include "transport/keys/key.hpp"

namespace lightnet {

/// Reads the secret key that stands in the first line of the standard input. None: there is none before its end. Throws
/// Error when that line is no key.
std::optional<KeyPair> key_from_input();

/// Asks this process to stop when its standard input ends.
class LedByInput {
public:
    LedByInput();

private:
    std::jthread thread_;
};

}  // namespace lightnet
