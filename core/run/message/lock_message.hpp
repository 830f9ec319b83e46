// Messages about named locks.
#pragma once

#include <cstdint>

#include "core/base/hash.hpp"

namespace lightnet {

/// What a place has to say about a lock, which is named by the hash of its name. Travels as bytes.
struct LockMessage {
    enum class Kind : std::uint32_t {
        want,
        release,
        hold,  // said to a launcher that had lost sight of the place
        last = hold
    };
    Kind kind = Kind::want;
    Hash lock{};
    friend bool operator==(const LockMessage&, const LockMessage&) = default;
};

}  // namespace lightnet
