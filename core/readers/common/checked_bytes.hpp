// Bytes of a file that nobody trusts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/base/error.hpp"

namespace lightnet {

/// Bytes that are read at any offset, if they are there; else it throws Error.
class CheckedBytes {
public:
    explicit CheckedBytes(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::span<const std::byte> part(std::uint64_t at, std::uint64_t size) const {
        if (at > bytes_.size() || size > bytes_.size() - at)
            throw Error("it ends early, or an offset in it leads beyond it");
        return bytes_.subspan(at, size);
    }
    template <class Value>
    Value get(std::uint64_t at) const {
        Value value;
        std::memcpy(&value, part(at, sizeof value).data(), sizeof value);
        return value;
    }
    std::size_t size() const { return bytes_.size(); }

private:
    std::span<const std::byte> bytes_;
};

}  // namespace lightnet
