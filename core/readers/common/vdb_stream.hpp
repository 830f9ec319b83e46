// Bytes of an OpenVDB file, one after the other.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/readers/common/checked_bytes.hpp"

namespace lightnet::vdb {

/// A bit for each part of a node, of which there are a power of two.
class Mask {
public:
    Mask() = default;
    explicit Mask(std::span<const std::byte> bits) : bits_(bits) {}

    bool operator[](std::uint32_t n) const { return std::to_integer<unsigned>(bits_[n / 8]) >> (n % 8) & 1; }
    std::uint32_t count() const {
        std::uint32_t sum = 0;
        for (const std::byte eight : bits_)
            sum += static_cast<std::uint32_t>(std::popcount(std::to_integer<unsigned>(eight)));
        return sum;
    }
    std::span<const std::byte> bytes() const { return bits_; }
    bool empty() const { return bits_.empty(); }

private:
    std::span<const std::byte> bits_;
};

class Stream {
public:
    explicit Stream(std::span<const std::byte> bytes, std::uint64_t at = 0) : bytes_(bytes), at_(at) {}

    template <class Value>
    Value get() {
        const Value value = bytes_.get<Value>(at_);
        at_ += sizeof value;
        return value;
    }
    std::span<const std::byte> part(std::uint64_t size) {
        const auto found = bytes_.part(at_, size);
        at_ += size;
        return found;
    }
    std::string text();
    Mask mask(std::uint32_t parts) { return Mask(part(parts / 8)); }
    std::size_t file_size() const { return bytes_.size(); }
    std::uint64_t at() const { return at_; }

private:
    CheckedBytes bytes_;
    std::uint64_t at_;
};

/// How a grid's numbers are stored.
struct Storage {
    std::uint32_t packing = 0;                  // bits: see vdb_stream.cpp
    enum class Number { half, single, twice };  // IEEE 754: binary16, binary32, binary64
    Number of_leaves = Number::single;
    Number alone = Number::single;  // of the background and of parts of one value
    float background = 0;
};

/// One that stands alone.
float number(Stream& stream, const Storage& storage);

/// The numbers of a node's parts, of which `active` says something.
std::vector<float> numbers(Stream& stream, const Mask& active, std::uint32_t parts, const Storage& storage);

}  // namespace lightnet::vdb
